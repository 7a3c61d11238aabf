#!/usr/bin/env bash
# Tests generated code on microcontrollers: builds the controller for a Cortex-M4F and a Cortex-M7, checks that the
# programs lack certain symbols, runs them in QEMU, and compares instructions, stack and costs with bounds.
#
# Uses the installed compiler if it has the target (`rustup target add thumbv7em-none-eabihf`). Otherwise, and for QEMU,
# Debian's packages are unpacked below `target`, without any change to the machine: Debian's compiler has the sources of
# its `core`, which is then built for the board, too. If neither is available, the script prints a message and succeeds;
# other problems are errors.
set -euo pipefail
cd "$(dirname "$0")"
# These would override those in `.cargo/config.toml`.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
# The programs are one unit, without code that unwinds.
export CARGO_PROFILE_RELEASE_LTO=fat CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1 CARGO_PROFILE_RELEASE_PANIC=abort

target=thumbv7em-none-eabihf
source ../../xtask/debian.sh

cannot() {
    echo "not run on a board: $1"
    exit 0
}

if command -v qemu-system-arm >/dev/null; then
    qemu=(qemu-system-arm)
else
    [ -x "$debian/usr/bin/qemu-system-arm" ] || unpack qemu-system-arm ||
        cannot "no qemu-system-arm, and no packages of Debian to take it from"
    qemu=(env "LD_LIBRARY_PATH=$debian_libraries" "$debian/usr/bin/qemu-system-arm")
fi
command -v nm >/dev/null || cannot "no nm, which lists what a program consists of"

# The library of the target is installed, or Debian's compiler builds it.
build=(cargo build)
library=$(rustc --print target-libdir --target "$target" 2>/dev/null || true)
if [ -z "$library" ] || ! compgen -G "$library/libcore-*.rlib" >/dev/null; then
    unpack_rust || cannot "no library for $target, and no packages of Debian to build one with"
    build=(env -u RUSTUP_TOOLCHAIN "LD_LIBRARY_PATH=$debian_libraries" "RUSTC=$debian/usr/bin/rustc"
        RUSTC_BOOTSTRAP=1 "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER=$debian/usr/bin/ld.lld-19"
        "$debian/usr/bin/cargo" build -Z build-std=core)
fi

# The model, by the generator of this repository. A generator built with the tests is reused: built alone, its
# dependencies have other features and are compiled again.
mkdir -p target
hamel="$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/debug/hamel"
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$hamel" ]; then
    cargo build --quiet --locked --manifest-path ../../Cargo.toml --package hamel-cli
fi
"$hamel" emit drone.eom -o target/drone.rs
cargo build --quiet --locked --release --bin report --target-dir target

# Anything that could panic appears as a symbol; `main` must be among the symbols, or the check would be void.
symbols() {
    local all
    all=$(nm "$1")
    grep -q ' main$' <<<"$all" || { echo "$1 has no symbols"; exit 1; }
    if grep -E 'panic|rust_begin_unwind|unwrap_failed|expect_failed|bounds|__rust_(re)?alloc|__rg_|malloc' <<<"$all"; then
        echo "$1 can panic or allocates"
        exit 1
    fi
}

# Runs a program on a board to its end, one nanosecond per instruction, for one number type: NAME BOARD PROGRAM
# INSTRUCTIONS BYTES, where the last two are limits.
run() {
    local said=target/$1.txt
    timeout 60 "${qemu[@]}" -machine "$2" -icount shift=0,sleep=off -nographic -monitor none -serial none \
        -semihosting-config enable=on,target=native -kernel "$programs/$3" >"$said" ||
        { cat "$said"; echo "$1: the board did not come to an end"; exit 1; }
    target/release/report "$1" "$3" "$4" "$5" <"$said"
}

# Builds both programs, with further arguments for cargo.
programs=target/board/$target/release
programs() {
    "${build[@]}" --quiet --locked --release --features board --target "$target" --bin single --bin double \
        --target-dir target/board "$@" 2>target/messages || { cat target/messages; exit 1; }
    symbols "$programs/single"
    symbols "$programs/double"
}

programs
run cortex-m4f-f32 mps2-an386 single 1700000 32768
run cortex-m4f-f64-in-software mps2-an386 double 34000000 65536
programs --config "target.$target.rustflags=['-Ctarget-cpu=cortex-m7', '-Ctarget-feature=+fp64']"
run cortex-m7-f32 mps2-an500 single 1700000 32768
run cortex-m7-f64 mps2-an500 double 1700000 65536
echo "no allocator and no panic in any of these programs"
