#!/usr/bin/env bash
# Compares the equations of random mechanisms, which Python computes from the definitions by d'Alembert's principle and
# differences of 80 digits, with the equations that hamel derives from their texts. Needs cargo, gcc and Python with
# mpmath from PyPI, which is installed in a virtual environment below the target, and gmpy2 for speed. Arguments after
# the folder are passed to `dalembert/attack.py`.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels dalembert-environment mpmath==1.3.0 gmpy2==2.3.2
# Reuses the program built with the tests.
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -f "$target/debug/hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
export PYTHONPATH=lab/dalembert PYTHONDONTWRITEBYTECODE=1
if [ $# -eq 0 ]; then
    set -- --seeds 21 3 --largest 3 --rust 1 1
fi
"$environment/bin/python" -m dalembert.attack "$target/debug/hamel" "$target/dalembert" "$@"
