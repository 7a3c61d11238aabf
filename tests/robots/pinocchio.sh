#!/usr/bin/env bash
# All robots of the wheel `example-robot-data`, fixed and floating, against Pinocchio at random states:
# M and bias within 1e-11 of their scale, accelerations within 1e-11 times the condition of M.
set -euo pipefail
cd "$(dirname "$0")/../.."

version=4.1.0
folder="${CARGO_TARGET_DIR:-target}/pinocchio"
tests/robots/install.sh
if [ ! -f "$folder/$version" ]; then
    python3 -m venv --clear "$folder"
    "$folder/bin/pip" --quiet --disable-pip-version-check install "pin==$version"
    touch "$folder/$version"
fi
cargo build --release --quiet -p hamel-cli --locked
"$folder/bin/python" tests/robots/against_pinocchio.py "${CARGO_TARGET_DIR:-target}"
