#!/usr/bin/env bash
# Installs mdBook below target/tools, unless it is there already. It is a tool that builds pages, and not shipped.
set -euo pipefail
cd "$(dirname "$0")/../.."

version=0.4.52
tool=target/tools/bin/mdbook
if [ "$("$tool" --version 2>/dev/null || true)" != "mdbook v$version" ]; then
    cargo install mdbook --locked --version "$version" --no-default-features --root target/tools
fi
