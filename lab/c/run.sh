#!/usr/bin/env bash
# Compares generated C by clang and by gcc with generated Rust: forward dynamics and their slopes. Needs both compilers,
# cargo, and the robots of tests/robots/install.sh. The exit status is 1 if the C of one compiler takes more than 1.05
# times as long as the Rust.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
out="$PWD/target/bench-c"
mkdir -p "$out/c"

export HAMEL_C="$out/c" HAMEL_ROBOTS="$robots"
export RUSTFLAGS="-C target-cpu=native"
# Build scripts derive robots.
export CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=1
cargo build --release --manifest-path lab/c/Cargo.toml --target-dir "$out/rust"
# Pins the process to one core, if the system can.
pin=$(command -v taskset || true)
# gcc is fastest when it schedules before register allocation and not after it, and does not vectorise adjacent
# operations, which takes more moves than it saves.
gcc="gcc -fno-tree-slp-vectorize -fschedule-insns -fno-schedule-insns2 -fsched-pressure -frename-registers"
ended=0
for compiler in clang "$gcc"; do
    library="$out/lib${compiler%% *}.so"
    (cd "$out/c" && $compiler -std=c99 -O3 -march=native -fPIC -shared ./*.c -lm -o "$library")
    echo "$compiler -O3 -march=native"
    ${pin:+$pin -c 0} "$out/rust/release/hamel-bench-c" "$library" || ended=1
done
exit $ended
