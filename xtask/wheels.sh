# To be sourced by scripts in the root of the repository: packages from PyPI in virtual environments below the target
# folder.
#
#   $target                  the target folder
#   wheels NAME PACKAGE ...  makes the environment of this name with these packages, unless it exists; its folder
#                            is $environment
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"

wheels() {
    environment="$target/$1"
    shift
    if [ ! -f "$environment/installed" ] || [ "$(cat "$environment/installed")" != "$*" ]; then
        python3 -m venv --clear "$environment"
        "$environment/bin/pip" --quiet --disable-pip-version-check install "$@"
        echo "$*" > "$environment/installed"
    fi
}
