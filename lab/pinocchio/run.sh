#!/usr/bin/env bash
# Compares generated Rust with Pinocchio's C++. Needs python3 with venv, g++ and cargo, and the robots of
# tests/robots/install.sh; also uses clang++ if it is installed. Prints a table, and writes it to
# `bench-pinocchio/report.md` below the target folder; takes about ten minutes, and 5 GB of memory for g++.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target=$(cd "${CARGO_TARGET_DIR:-target}" && pwd)
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
out="$target/bench-pinocchio"
mkdir -p "$out"

# Headers and libraries of Pinocchio and its dependencies, from PyPI.
here=lab/pinocchio
if ! cmp -s "$here/requirements.txt" "$out/venv/requirements.txt"; then
    python3 -m venv --clear "$out/venv"
    "$out/venv/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
    cp "$here/requirements.txt" "$out/venv/requirements.txt"
fi
prefix=$(find "$out/venv" -type d -name cmeel.prefix | head -n 1)

# The definitions in the wheel's CMake files.
defined=(
    -DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_LIMIT_VECTOR_SIZE=30 -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS
    -DBOOST_FUSION_INVOKE_MAX_ARITY=12 -DPINOCCHIO_URDFDOM_HEADERS_MAJOR_VERSION=3
    -DPINOCCHIO_URDFDOM_HEADERS_MINOR_VERSION=0 -DPINOCCHIO_URDFDOM_HEADERS_PATCH_VERSION=0
)
# Compiles a source by a compiler with further options to a library of this name, unless it is newer than the source.
# Warnings come from templates in the headers.
library() {
    local library="$out/$1" source="$here/$2" compiler="$3"
    shift 3
    if [ "$library" -nt "$source" ] && [ "$library" -nt "$here/robot.h" ] && [ "$library" -nt "$out/venv/requirements.txt" ]
    then
        return
    fi
    "$compiler" -std=c++17 -w -O3 -DNDEBUG -fPIC -shared -Wl,-z,defs "${defined[@]}" -isystem "$prefix/include" \
        -isystem "$prefix/include/eigen3" -isystem "$prefix/include/urdfdom_headers" "$source" \
        -L"$prefix/lib" -Wl,-rpath,"$prefix/lib" -o "$library.new" "$@"
    mv "$library.new" "$library"
}
# The algorithms in several ways: as compiled in the wheel, and their templates compiled for this machine. The latter do
# not use the wheel's libraries, in which Eigen aligns matrices to 16 bytes on any machine.
library reader.so reader.cpp g++ -DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION -lpinocchio_parsers -lpinocchio_default
library wheel.so driver.cpp g++ -DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION -lpinocchio_default
library g++.so driver.cpp g++ -march=native -fno-gnu-unique
ways=("$out/wheel.so" "$out/g++.so")
if command -v clang++ >/dev/null; then
    library clang++.so driver.cpp clang++ -march=native
    ways+=("$out/clang++.so")
fi

export HAMEL_ROBOTS="$robots"
export RUSTFLAGS="-C target-cpu=native"
# Build scripts derive robots.
export CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=1
cargo build --release --locked --manifest-path "$here/Cargo.toml" --target-dir "$out/rust"
# Pins the process to one core, if the system can.
pin=$(command -v taskset || true)
${pin:+$pin -c 0} "$out/rust/release/hamel-bench-pinocchio" "$robots" "$out/reader.so" "${ways[@]}" |
    tee "$out/report.md"
