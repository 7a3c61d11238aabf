#!/usr/bin/env bash
# Runs a million free bodies of a thousand steps each: killed in the middle, the same command repeated, every member
# present once; measures time and memory. Needs cargo and the environment of tests/sweep/run.sh; takes several minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."

target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
if [ ! -f "$target/sweep-readers/installed" ]; then
    bash tests/sweep/run.sh
fi
hamel="${HAMEL:-$target/release/hamel}"
if [ -z "${HAMEL:-}" ]; then
    cargo build --quiet --release --locked -p hamel-cli --all-features
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$target/sweep-readers/bin/python" tests/sweep/million.py "$hamel" "$folder"
