#!/usr/bin/env bash
# Compares generated C with generated Rust; needs gcc and cargo, and the robots of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
robots=$(find "$PWD/${CARGO_TARGET_DIR:-target}/robots" -type d -path '*example-robot-data/robots' | head -n 1)
out="$PWD/target/bench-c"
mkdir -p "$out/c"

export HAMEL_C="$out/c" HAMEL_ROBOTS="$robots"
export RUSTFLAGS="-C target-cpu=native"
cargo build --release --manifest-path bench/c/Cargo.toml --target-dir "$out/rust"
(cd "$out/c" && gcc -std=c99 -O3 -march=native -fPIC -shared ./*.c -lm -o ../libours.so)
# One core, where the system can say so.
pin=$(command -v taskset || true)
${pin:+$pin -c 0} "$out/rust/release/hamel-bench-c" "$out/libours.so" | tee "$out/report.md"
