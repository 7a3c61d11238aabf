#!/usr/bin/env bash
# A sweep's shards, read by Polars, DuckDB and pandas as the README says, and compared with one another and with what
# `hamel simulate` gives; needs cargo and Python with wheels of PyPI, which go to a virtual environment below the target.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels sweep-readers polars==2.1.0 duckdb==2.0.0 pandas==3.1.1 pyarrow==26.0.1
# One that was built with the tests will do: alone, its dependencies have other features, and are built anew.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$environment/bin/python" tests/sweep/readers.py "$hamel" "$folder"
