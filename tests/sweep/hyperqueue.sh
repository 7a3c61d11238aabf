#!/usr/bin/env bash
# Runs a sweep on HyperQueue, on one node: 16 tasks and two workers, one of which is killed with its task in the middle,
# which the other one then gets; then all are killed in the middle and the same command is repeated. The union is
# compared with a run on this machine, byte by byte. Needs cargo and Python; the wheel `hyperqueue` from PyPI is
# installed in a virtual environment below the target.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels hyperqueue hyperqueue==0.27.0
# Reuses the program built with the tests: built alone, its dependencies have other features and are compiled again.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli --all-features
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$environment/bin/python" tests/sweep/on_hyperqueue.py test "$hamel" "$folder"
