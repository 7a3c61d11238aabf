#!/usr/bin/env bash
# Compares machine code made at run time with rustc's; needs cargo and the robots of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
export HAMEL_ROBOTS="$robots"
export RUSTFLAGS="-C target-cpu=native"
# Build scripts derive robots.
export CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=1
cargo build --release --manifest-path lab/native/Cargo.toml --target-dir target/bench-native --bin hamel-bench-native
# Pins the process to one core, if the system can.
pin=$(command -v taskset || true)
${pin:+$pin -c 0} target/bench-native/release/hamel-bench-native
