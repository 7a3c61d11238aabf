#!/usr/bin/env bash
# Builds the page from a clone: page/dist/index.html, one file that a browser opens as it is.
set -euo pipefail
cd "$(dirname "$0")/.."

bash page/module.sh
npm --prefix page ci --silent
npm --prefix page run --silent types
node page/build.mjs
