#!/usr/bin/env bash
# Builds the generator for browsers: target/page/hamel_page.wasm. If rustup cannot install the WebAssembly target,
# Debian's sources of the standard library are built with Debian's compiler, unpacked below `target`.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=wasm32-unknown-unknown
folder="${CARGO_TARGET_DIR:-target}"
# Stack size in bytes: derivations of large robots recurse deeply.
flags="-C link-arg=-zstack-size=8388608"
arguments=(build --quiet --locked --package hamel-page --profile page --target "$target")

has_target() {
    [ -d "$(rustc --print sysroot)/lib/rustlib/$target/lib" ]
}

if has_target || { rustup target add "$target" && has_target; }; then
    RUSTFLAGS="$flags" cargo "${arguments[@]}"
else
    echo "rustup has no $target: taking Debian's sources of the standard library"
    source xtask/debian.sh
    unpack_rust ||
        { echo "no library for $target, and no packages of Debian to build one with" >&2; exit 1; }
    LD_LIBRARY_PATH="$debian_libraries" RUSTC="$debian/usr/bin/rustc" RUSTC_BOOTSTRAP=1 \
        RUSTFLAGS="$flags -C linker=$debian/usr/bin/wasm-ld-19 -C linker-flavor=wasm-ld" \
        cargo "${arguments[@]}" -Z build-std=std,panic_abort
fi
mkdir -p "$folder/page"
cp "$folder/$target/page/hamel_page.wasm" "$folder/page/hamel_page.wasm"
