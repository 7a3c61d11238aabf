#!/usr/bin/env bash
# Compares the Python package with Pinocchio's, and with a loop in C++ over Pinocchio: forward dynamics of a UR5 at
# 100,000 states. Needs cargo, g++ and Python with wheels from PyPI, and the robots of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
robots=$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)
out="$target/bench-python"
mkdir -p "$out"
if [ ! -f "$out/installed" ]; then
    python3 -m venv --clear "$out/venv"
    "$out/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 --requirement lab/pinocchio/requirements.txt
    touch "$out/installed"
fi
CARGO_TARGET_DIR="$target/wheel" "$out/venv/bin/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps ./bindings/python
prefix=$(find "$out/venv" -type d -name cmeel.prefix | head -n 1)
defined=(
    -DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_LIMIT_VECTOR_SIZE=30 -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS
    -DBOOST_FUSION_INVOKE_MAX_ARITY=12 -DPINOCCHIO_URDFDOM_HEADERS_MAJOR_VERSION=3
    -DPINOCCHIO_URDFDOM_HEADERS_MINOR_VERSION=0 -DPINOCCHIO_URDFDOM_HEADERS_PATCH_VERSION=0
)
library() {
    local library="$out/$1"
    shift
    g++ -std=c++17 -w -O3 -DNDEBUG -fPIC -shared -Wl,-z,defs "${defined[@]}" -isystem "$prefix/include" \
        -isystem "$prefix/include/eigen3" -isystem "$prefix/include/urdfdom_headers" lab/python/loop.cpp \
        -L"$prefix/lib" -Wl,-rpath,"$prefix/lib" -o "$library" "$@"
}
# The code compiled in the wheel, and its templates for this machine.
library wheel.so -DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION -lpinocchio_default
library native.so -march=native -fno-gnu-unique
# Pins the process to one core, if the system can.
pin=$(command -v taskset || true)
${pin:+$pin -c 0} "$out/venv/bin/python" lab/python/compare.py "$robots/ur_description/urdf/ur5_robot.urdf" \
    "$out/wheel.so" "$out/native.so"
