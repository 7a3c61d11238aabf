#!/usr/bin/env bash
# Builds the page from a clone: bindings/page/dist/index.html, one file that a browser opens as it is.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash bindings/page/module.sh
npm --prefix bindings/page ci --silent
npm --prefix bindings/page run --silent types
# Instances of generic functions that came out alike are kept once. What else Binaryen could do makes the module shorter,
# and what is downloaded longer, since then less of it repeats.
folder="${CARGO_TARGET_DIR:-target}/page"
bindings/page/node_modules/.bin/wasm-opt "$folder/hamel_page.wasm" -o "$folder/hamel_page.small.wasm" --enable-bulk-memory \
    --enable-sign-ext --enable-mutable-globals --enable-nontrapping-float-to-int --enable-multivalue \
    --enable-reference-types --duplicate-function-elimination --optimize-instructions --code-folding --reorder-locals \
    --merge-blocks --code-folding --vacuum --duplicate-function-elimination --code-folding --duplicate-function-elimination
node bindings/page/build.mjs
