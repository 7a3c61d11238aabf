#!/usr/bin/env bash
# A sweep on HyperQueue, on one node: 16 tasks and two workers, one of them killed with its task in the middle, which the other
# one then gets; and all killed in the middle and the same command again. The union is compared with a run on this machine, byte
# for byte. Needs cargo and Python; the wheel `hyperqueue` of PyPI goes to a virtual environment below the target.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels hyperqueue hyperqueue==0.27.0
# One that was built with the tests will do: alone, its dependencies have other features, and are built anew.
hamel="$target/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
"$environment/bin/python" tests/sweep/on_hyperqueue.py test "$hamel" "$folder"
