#!/usr/bin/env bash
# Installs the Python package as a user would, with one command from a clone into a fresh virtual environment; measures
# its size and the time of an import. Needs cargo, Python and wheels from PyPI.
set -euo pipefail
cd "$(dirname "$0")/../.."

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
python3 -m venv "$scratch/environment"
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}/wheel"
"$scratch/environment/bin/pip" --quiet --disable-pip-version-check install ./bindings/python
"$scratch/environment/bin/pip" --quiet --disable-pip-version-check wheel --no-deps --wheel-dir "$scratch" ./bindings/python
cd "$scratch"
"$scratch/environment/bin/hamel" --version
"$scratch/environment/bin/python" - "$scratch" <<'PYTHON'
import glob, os, subprocess, sys, time

# The smallest of several times: others include waits for the disk.
def seconds(words):
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", words], check=True)
    return time.perf_counter() - begin

empty, numpy, hamel = (min(seconds(words) for _ in range(10)) for words in ("pass", "import numpy", "import hamel"))
(wheel,) = glob.glob(os.path.join(sys.argv[1], "*.whl"))
size = os.path.getsize(wheel) / 1e6
print(f"{os.path.basename(wheel)}: {size:.1f} MB; import {1e3 * (hamel - empty):.0f} ms, {1e3 * (hamel - numpy):.0f} ms of them beside NumPy")
assert size < 15.0 and hamel - empty < 0.1
PYTHON
