#!/usr/bin/env bash
# Tests the Python package: types, comparisons with Pinocchio, SciPy and python-control, examples and the notebook;
# needs cargo and Python with wheels from PyPI, which are installed in a virtual environment below the target.
#
#   run.sh        all of that
#   run.sh jax    emitted modules in JAX alone, which is a large package
set -euo pipefail
cd "$(dirname "$0")/../.."

bash tests/robots/install.sh
source xtask/wheels.sh
wheels python-environment numpy==2.4.6 scipy==1.17.1 control==0.10.2 scipy-stubs==1.17.1.5 pin==4.1.0 pytest==9.2.0 mpmath==1.3.0 gmpy2==2.3.2 mypy==2.4.1 matplotlib==3.11.2 nbclient==0.11.0 ipykernel==7.4.0 polars==2.1.0 distributed==2026.8.0
# Reuses the module built with the tests: built alone, its dependencies have other features and are compiled again.
module="$target/debug/deps/lib_hamel.so"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -f "$module" ]; then
    cargo build --quiet --locked -p hamel-python
    module="$target/debug/lib_hamel.so"
fi
package="$target/python-package"
rm -rf "$package"
mkdir -p "$package"
cp -r bindings/python/package/hamel "$package/hamel"
cp "$module" "$package/hamel/_hamel.abi3.so"
export PYTHONPATH="$package" MYPYPATH="$package" MPLBACKEND=agg

if [ "${1:-}" = jax ]; then
    wheels jax-environment numpy==2.4.6 pytest==9.2.0 jax==0.9.0
    PYTHONPATH="$package:bindings/python/tests" "$environment/bin/python" -m pytest --quiet -p no:cacheprovider bindings/python/peers
    exit
fi

"$environment/bin/mypy" --strict --cache-dir "$package/.mypy" "$package/hamel" examples/python
"$environment/bin/python" -m pytest --quiet -p no:cacheprovider bindings/python/tests
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
"$environment/bin/python" examples/python/balance.py "$scratch"
# With fewer runs than in the pictures.
"$environment/bin/python" examples/python/kapitza.py "$scratch" --points 16
"$environment/bin/python" examples/python/basins.py "$scratch" --points 40
"$environment/bin/python" tests/python/notebooks.py examples/python/*.ipynb
