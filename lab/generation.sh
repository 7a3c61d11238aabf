#!/usr/bin/env bash
# Compares the time from text to code, with all checks, with an earlier revision of this repository:
#
#     lab/generation.sh REVISION [ROUNDS]
#
# Both are built in release and run alternately. Prints the least CPU time of each, their ratio, and the median of the
# ratios of consecutive runs. The robots are those of tests/robots/install.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

revision=${1:?the revision to compare with}
rounds=${2:-9}
base=$PWD/target/generation/$revision

tests/robots/install.sh
[ -d "$base" ] || git clone -q . "$base"
git -C "$base" checkout -q "$revision"
cargo build --release -q -p hamel-cli --locked
cargo build --release -q -p hamel-cli --locked --manifest-path "$base/Cargo.toml" --target-dir "$base/target"

python3 - "$base/target/release/hamel" target/release/hamel "$rounds" <<'PYTHON'
import os, pathlib, resource, statistics, subprocess, sys

old, new, rounds = sys.argv[1], sys.argv[2], int(sys.argv[3])
robots = next(pathlib.Path("target/robots").rglob("example-robot-data/robots"))
cases = {
    "free body": ["tests/models/free_body.eom"],
    "UR5": [str(robots / "ur_description/urdf/ur5_robot.urdf")],
    "Solo12": [str(robots / "solo_description/robots/solo12.urdf"), "--floating"],
    "Talos": [str(robots / "talos_data/robots/talos_reduced.urdf"), "--floating"],
}

def seconds(program, arguments):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "emit", *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

for name, arguments in cases.items():
    # Runs of a few milliseconds are repeated, since the process clock has such a resolution.
    repeat = 1 + int(0.2 / max(seconds(new, arguments), 0.002))
    times = {old: [], new: []}
    for _ in range(rounds):
        for program in (old, new):
            times[program].append(sum(seconds(program, arguments) for _ in range(repeat)) / repeat)
    before, after = (min(times[p]) for p in (old, new))
    ratio = statistics.median(a / b for b, a in zip(times[old], times[new]))
    print(f"{name:10} {before * 1e3:9.2f} ms -> {after * 1e3:9.2f} ms   {after / before:5.2f}   {ratio:5.2f}")
PYTHON
