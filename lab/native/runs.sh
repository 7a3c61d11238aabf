#!/usr/bin/env bash
# Compares a million steps, and sweeps, by machine code made at run time with programs in Rust with generated code;
# needs cargo and the robots of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
export HAMEL_ROBOTS="$robots"
# Build scripts derive robots.
export CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=1
cargo build --release --manifest-path lab/native/Cargo.toml --target-dir target/bench-runs --bin runs
target/bench-runs/release/runs
