"""A million members, killed in the middle and resumed."""

import pathlib
import resource
import signal
import subprocess
import sys
import time

import polars as pl

MEMBERS, STEPS = 1_000_000, 1_000
SWEEP = ["sweep", "examples/dzhanibekov.eom", "--vary", "start w = uniform([-1, -1, -1], [1, 1, 1])"]
SWEEP += ["--members", str(MEMBERS), "--until", "1", "--step", str(1 / STEPS), "--method", "rkmk4", "--keep", "end"]


def main(hamel, folder):
    command = [hamel, *SWEEP, "--out", folder]
    begin = time.monotonic()
    first = subprocess.Popen(command)
    while len(list(pathlib.Path(folder).glob("*.parquet"))) < 50:
        time.sleep(0.1)
        assert first.poll() is None, "it was over before it was killed"
    first.send_signal(signal.SIGKILL)
    first.wait()
    there = len(list(pathlib.Path(folder).glob("*.parquet")))
    subprocess.run(command, check=True)
    taken = time.monotonic() - begin
    index = pl.read_parquet(folder + "/*.parquet", columns=["index"])["index"]
    assert len(index) == MEMBERS and index.n_unique() == MEMBERS and index.max() == MEMBERS - 1
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e3
    print(f"killed with {there} files; {MEMBERS} members, each once, in {taken:.0f} s: {taken / MEMBERS / STEPS * 1e9:.0f} ns a step, {memory:.0f} MB")
    assert memory < 200


main(*sys.argv[1:])
