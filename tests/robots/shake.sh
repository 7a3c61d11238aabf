#!/usr/bin/env bash
# All robots of the wheel `example-robot-data`, fixed and floating, with and without roundings of angles,
# as they are and shaken by 1e-3 … 1e-15 rad, against a derivation in numbers of twice the length; and
# 1,000 arms with awkward axes. Some minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."

tests/robots/install.sh
HAMEL_ATTACK=full cargo test -p hamel-codegen --test suite rounding::
HAMEL_ATTACK=full cargo test -p hamel-cli --test suite shaken:: -- --nocapture
