#!/usr/bin/env bash
# Runs the first chapter as a reader would: its blocks unchanged, in a fresh clone, with the command line installed into
# a separate folder. Time limit: ten minutes. Needs cargo and git; only committed files count.
set -euo pipefail
cd "$(dirname "$0")/../.."

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
git clone --quiet . "$scratch/hamel"
export CARGO_INSTALL_ROOT="$scratch/installed" PATH="$scratch/installed/bin:$PATH"
unset CARGO_TARGET_DIR
# Shell blocks run in the clone, and those that make crates in its parent folder.
awk '/^```sh$/ { print "cd \"$clone\""; inside = 1; next }
     /^```sh,crates$/ { print "cd \"$clone/..\""; inside = 1; next }
     /^```/ { inside = 0 }
     inside' docs/book/src/ten-minutes.md > "$scratch/chapter.sh"
begin=$SECONDS
clone="$scratch/hamel" timeout 600 bash -euo pipefail "$scratch/chapter.sh" ||
    { echo "the first chapter fails, or takes more than ten minutes: $((SECONDS - begin)) s" >&2; exit 1; }
for made in hamel/swing.svg hamel/pendulum.csv hamel/held.svg hamel/flip.svg swing/swing.svg; do
    [ -s "$scratch/$made" ] || { echo "the chapter has not made $made" >&2; exit 1; }
done
echo "the first chapter takes $((SECONDS - begin)) s"
