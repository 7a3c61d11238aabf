#!/usr/bin/env bash
# Reads a sweep's shards by Polars, DuckDB and pandas as in the README, and compares them with one another and with
# `hamel simulate`; needs cargo and Python with wheels from PyPI, which are installed in a virtual environment below the
# target.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels sweep-readers polars==2.1.0 duckdb==2.0.0 pandas==3.1.1 pyarrow==26.0.1
# Reuses the program built with the tests: built alone, its dependencies have other features and are compiled again.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli --all-features
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$environment/bin/python" tests/sweep/readers.py "$hamel" "$folder"
