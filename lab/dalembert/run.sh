#!/usr/bin/env bash
# Random mechanisms whose equations Python has from the definitions alone, by d'Alembert's principle and differences of 80
# digits, against what hamel says of their texts; needs cargo, gcc and Python with mpmath of PyPI, which goes to a virtual
# environment below the target, and gmpy2, which makes it quicker. Arguments are those of `dalembert/attack.py` behind the folder.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels dalembert-environment mpmath==1.3.0 gmpy2==2.3.2
# The program that was built with the tests will do.
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -f "$target/debug/hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
export PYTHONPATH=lab/dalembert PYTHONDONTWRITEBYTECODE=1
if [ $# -eq 0 ]; then
    set -- --seeds 21 3 --largest 3 --rust 1 1
fi
"$environment/bin/python" -m dalembert.attack "$target/debug/hamel" "$target/dalembert" "$@"
