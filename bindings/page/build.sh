#!/usr/bin/env bash
# Builds the page: bindings/page/dist/index.html, a single file that a browser opens directly.
set -euo pipefail
cd "$(dirname "$0")/../.."

bash bindings/page/module.sh
npm --prefix bindings/page ci --silent
npm --prefix bindings/page run --silent types
# Merges identical instances of generic functions. Other passes of Binaryen shrink the module but enlarge the download,
# since they leave less repetition to compress.
folder="${CARGO_TARGET_DIR:-target}/page"
bindings/page/node_modules/.bin/wasm-opt "$folder/hamel_page.wasm" -o "$folder/hamel_page.small.wasm" --enable-bulk-memory \
    --enable-sign-ext --enable-mutable-globals --enable-nontrapping-float-to-int --enable-multivalue \
    --enable-reference-types --duplicate-function-elimination --optimize-instructions --code-folding --reorder-locals \
    --merge-blocks --code-folding --vacuum --duplicate-function-elimination --code-folding --duplicate-function-elimination
node bindings/page/build.mjs
