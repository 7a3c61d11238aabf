#!/usr/bin/env bash
# Installs the URDF files of the robots in tests/reference/robots: the wheel `example-robot-data` from PyPI, in a
# virtual environment below the target folder. Does nothing if it is there already.
set -euo pipefail
cd "$(dirname "$0")/../.."

version=6.0.0
folder="${CARGO_TARGET_DIR:-target}/robots"
if [ -f "$folder/$version" ]; then
    exit 0
fi
python3 -m venv --clear "$folder"
"$folder/bin/pip" --quiet --disable-pip-version-check install --no-deps "example-robot-data==$version"
touch "$folder/$version"
