#!/usr/bin/env bash
# Compares all robots of the wheel `example-robot-data`, fixed and floating, with Pinocchio at random states: M and bias
# within 1e-11 of their scale, accelerations within 1e-11 times the condition of M.
set -euo pipefail
cd "$(dirname "$0")/../.."

tests/robots/install.sh
source xtask/wheels.sh
wheels pinocchio pin==4.1.0
cargo build --release --quiet -p hamel-cli --locked
"$environment/bin/python" tests/robots/against_pinocchio.py "$target"
