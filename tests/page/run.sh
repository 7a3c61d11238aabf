#!/usr/bin/env bash
# Tests the page in a real browser, without a server and from one: numbers, errors, motion, robots, links, size,
# latency. Needs cargo, Node with npm, and Chromium, which is installed from Debian if it is missing.
set -euo pipefail
cd "$(dirname "$0")/../.."

chromium="${CHROMIUM:-/usr/bin/chromium}"
if [ ! -x "$chromium" ]; then
    # Before the module is built, which may install packages, too: only one program at a time may do so.
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core > /dev/null
fi
bash tests/robots/install.sh
bash bindings/page/build.sh
target="$(realpath -m "${CARGO_TARGET_DIR:-target}")"
# The command line with whose numbers the page is compared; reused if it was built with the tests.
if [ -z "${HAMEL_BUILT:-}" ] || [ ! -x "$target/debug/hamel" ]; then
    cargo build --quiet --locked -p hamel-cli
fi
robots="$(find "$target/robots" -type d -path '*example-robot-data/robots' | head -n 1)"
CHROMIUM="$chromium" HAMEL="$target/debug/hamel" HAMEL_ROBOTS="$robots" node --test --test-concurrency=1 bindings/page/tests/*.test.mjs
