"""A sweep as a Slurm array of tasks, one of which is killed in the middle while others are cancelled."""

import os
import pathlib
import signal
import subprocess
import sys
import time

SWEEP = ["sweep", "tests/models/heavy_top.eom", "--vary", "start w = uniform(-1, 1); m = latin(1, 2)"]
SWEEP += ["--members", "96", "--until", "8", "--seed", "5", "--shard-size", "2", "--keep", "end; max(norm(w))"]
SWEEP += ["--method", "backward-euler", "--step", "1e-3"]
# Time limit in s; the machine may be busy.
PATIENCE = 300


def test(hamel, folder):
    folder = pathlib.Path(folder)
    whole, runs = folder / "whole", folder / "runs"
    subprocess.run([hamel, *SWEEP, "--out", whole], check=True)
    wanted = shards(whole)
    assert len(wanted) == 48

    until("the node", lambda: "idle" in said("sinfo", "--noheader", "--format=%t"))
    submission = [hamel, *SWEEP, "--out", runs, "--submit", "slurm", "--tasks", "16"]
    subprocess.run(submission, check=True)
    until("a shard", lambda: len(shards(runs)) > 2)
    # Kills a task's process immediately, then all that are left.
    until("a task to kill", lambda: killed(said("pgrep", "--full", f"{runs}.*--shard").split()))
    subprocess.run(["scancel", "--name=hamel-sweep"], check=True)
    until("the end of all tasks", lambda: not said("squeue", "--noheader"))
    there = shards(runs)
    assert 0 < len(there) < len(wanted), "it was over before it was killed"
    print(f"killed with {len(there)} of {len(wanted)} shards")

    again = lambda: subprocess.run([*submission, "--wait"]).returncode == 0
    until("the rest", again)
    assert shards(runs) == wanted
    print(f"{len(wanted)} shards by 16 tasks of Slurm, the same as those of one process")


def killed(processes):
    """Whether at least one of them still existed."""
    for process in map(int, processes):
        try:
            os.kill(process, signal.SIGKILL)
            return True
        except ProcessLookupError:
            pass
    return False


def said(*words):
    return subprocess.run(words, capture_output=True, text=True).stdout


def shards(folder):
    return {path.name: path.read_bytes() for path in folder.glob("*.parquet")}


def until(what, holds):
    begin = time.monotonic()
    while not holds():
        assert time.monotonic() - begin < PATIENCE, f"{what} does not happen"
        time.sleep(0.05)


if __name__ == "__main__":
    test(*sys.argv[1:])
