# To be sourced by scripts: programs from Debian's packages, unpacked below the target folder, without any change to the
# machine.
#
#   unpack PACKAGE ...   unpacks the packages and their dependencies that are not installed; fails if this is impossible
#   unpack_rust          unpacks a Rust compiler, the sources of its library, and LLVM's linkers
#   $debian              the folder of the unpacked files
#   $debian_libraries    the LD_LIBRARY_PATH for the programs
debian="$(realpath -m "${CARGO_TARGET_DIR:-"$(dirname "${BASH_SOURCE[0]}")/../target"}")/debian"
debian_libraries="$debian/usr/lib/x86_64-linux-gnu:$debian/lib/x86_64-linux-gnu"

unpack() {
    command -v apt-get > /dev/null && command -v dpkg-deb > /dev/null && [ "$(id -u)" = 0 ] || return 1
    local archives="$debian/archives"
    mkdir -p "$archives/partial"
    # An installed package is downloaded, too: a script looks for its program in one place.
    local download=(apt-get install -y -qq --no-install-recommends --download-only --reinstall
        -o "Dir::Cache::archives=$archives" -o DPkg::Lock::Timeout=300 "$@")
    "${download[@]}" > /dev/null 2>&1 ||
        { apt-get update -qq > /dev/null 2>&1 && "${download[@]}" > /dev/null 2>&1; } || return 1
    local archive
    for archive in "$archives"/*.deb; do
        dpkg-deb -x "$archive" "$debian" || return 1
        rm "$archive"
    done
}

unpack_rust() {
    [ -x "$debian/usr/bin/rustc" ] && [ -x "$debian/usr/bin/lld-19" ] && return
    # The compiler locates itself by the library that it is linked with, whose name contains its version: this one is
    # unpacked even if the machine has it.
    local linked
    linked=$(apt-cache depends libstd-rust-web-dev 2> /dev/null | sed -n 's/.*Depends: \(libstd-rust-web-[0-9.]*\)$/\1/p')
    unpack rustc-web cargo-web rust-web-src libstd-rust-web-dev $linked lld-19
}
