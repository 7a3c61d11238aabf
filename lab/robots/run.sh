#!/usr/bin/env bash
# Compares steps with slopes of the robots in tests/reference/control, or in the folder HAMEL_CONTROL_REFERENCE, with
# those of Pinocchio; needs cargo and the robots of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
export HAMEL_ROBOTS="$robots" HAMEL_CONTROL_REFERENCE="${HAMEL_CONTROL_REFERENCE:-$PWD/tests/reference/control}"
cargo test --manifest-path lab/robots/Cargo.toml --locked
