#!/usr/bin/env bash
# Compares operations and times of steps with slopes with those of the linearisation; needs cargo and the robots of
# tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
export HAMEL_ROBOTS="$robots"
export RUSTFLAGS="-C target-cpu=native"
# Build scripts derive robots.
export CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=1
cargo build --release --manifest-path lab/steps/Cargo.toml --target-dir target/bench-steps
# Pins the process to one core, if the system can.
pin=$(command -v taskset || true)
${pin:+$pin -c 0} target/bench-steps/release/hamel-bench-steps
