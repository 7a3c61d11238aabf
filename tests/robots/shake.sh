#!/usr/bin/env bash
# Compares all robots of the wheel `example-robot-data`, fixed and floating, with and without rounded angles, unchanged
# and perturbed by 1e-3 … 1e-15 rad, with a derivation in doubled precision; and 1,000 arms with ill-conditioned axes.
# Takes several minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."

tests/robots/install.sh
HAMEL_ATTACK=full cargo test -p hamel-codegen --test suite rounding::
HAMEL_ATTACK=full cargo test -p hamel-cli --test suite shaken:: -- --nocapture
