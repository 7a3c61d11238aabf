"""A sweep on a cluster of HyperQueue, which is killed in the middle.

The wheel of HyperQueue has its server, its worker and its client, and not the command `hq`: that is stood for by `submit`
here, which takes the arguments that `hamel sweep --submit hyperqueue` gives it.
"""

import os
import pathlib
import signal
import subprocess
import sys
import time

SWEEP = ["sweep", "tests/models/heavy_top.eom", "--vary", "start w = uniform(-1, 1); m = latin(1, 2)"]
SWEEP += ["--members", "96", "--until", "1", "--seed", "5", "--shard-size", "2", "--keep", "end; max(norm(w))"]
# Seconds; the machine may be busy.
PATIENCE = 300


def cluster(folder):
    """A server and a worker in this process, until it is killed."""
    from hyperqueue import LocalCluster
    from hyperqueue.cluster import WorkerConfig

    local = LocalCluster()
    local.start_worker(WorkerConfig(cores=2))
    place = pathlib.Path(folder, "server")
    place.with_suffix(".new").write_text(str(local.cluster.server_dir))
    place.with_suffix(".new").rename(place)
    while True:
        time.sleep(1)


def submit(arguments):
    """`hq submit --array=1-N --name=… --cpus=1 --cwd … --stdout … --stderr … --wait sh SCRIPT`"""
    from hyperqueue import Job
    from hyperqueue.client import Client

    command, array, _, cpus, *named = arguments
    assert (command, cpus, named[6:8]) == ("submit", "--cpus=1", ["--wait", "sh"]), arguments
    options = dict(zip(named[0:6:2], named[1:6:2]))
    count = int(array.removeprefix("--array=1-"))
    client = Client(pathlib.Path(os.environ["SERVER"], "server").read_text())
    job = Job()
    # Tasks are numbered from 0.
    job.program(["true"], stdout=os.devnull, stderr=os.devnull)
    for task in range(1, count + 1):
        place = lambda option: options[option].replace("%{TASK_ID}", str(task))
        job.program(["sh", named[8]], cwd=options["--cwd"], stdout=place("--stdout"), stderr=place("--stderr"))
    sys.exit(0 if client.wait_for_jobs([client.submit(job)], raise_on_error=False) else 1)


def test(hamel, folder):
    folder = pathlib.Path(folder)
    whole, runs, server = (folder / name for name in ("whole", "runs", "server"))
    subprocess.run([hamel, *SWEEP, "--out", whole], check=True)
    wanted = shards(whole)
    assert len(wanted) == 48

    hq = folder / "hq"
    hq.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{os.path.abspath(__file__)}" submit "$@"\n')
    hq.chmod(0o755)
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "SERVER": str(folder)}

    def start():
        server.unlink(missing_ok=True)
        arguments = [sys.executable, __file__, "cluster", str(folder)]
        process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, start_new_session=True)
        until("the cluster", server.exists)
        return process

    submission = [hamel, *SWEEP, "--out", runs, "--submit", "hyperqueue", "--tasks", "16", "--wait"]
    process = start()
    first = subprocess.Popen(submission, env=environment, start_new_session=True, stderr=subprocess.DEVNULL)
    until("a shard", lambda: len(shards(runs)) > 4)
    for killed in (process, first):
        os.killpg(killed.pid, signal.SIGKILL)
        killed.wait()
    there = shards(runs)
    assert len(there) < len(wanted), "it was over before it was killed"
    print(f"killed with {len(there)} of {len(wanted)} shards")

    process = start()
    try:
        # Tasks that have outlived their worker hold their parts until they end.
        again = lambda: subprocess.run(submission, env=environment).returncode == 0
        until("the rest", again)
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    assert shards(runs) == wanted
    print(f"{len(wanted)} shards by 16 tasks, the same as those of one process")


def shards(folder):
    return {path.name: path.read_bytes() for path in folder.glob("*.parquet")}


def until(what, holds):
    begin = time.monotonic()
    while not holds():
        assert time.monotonic() - begin < PATIENCE, f"{what} does not happen"
        time.sleep(0.05)


if __name__ == "__main__":
    role, *rest = sys.argv[1:]
    {"cluster": lambda: cluster(*rest), "submit": lambda: submit(rest), "test": lambda: test(*rest)}[role]()
