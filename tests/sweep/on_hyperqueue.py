"""A sweep on a cluster of HyperQueue: first a worker is killed in the middle, then everything.

The wheel of HyperQueue contains its server, its worker and its client, but not the command `hq`: `submit` replaces
it here, and takes the arguments that `hamel sweep --submit hyperqueue` passes.
"""

import os
import pathlib
import signal
import subprocess
import sys
import time

SWEEP = ["sweep", "tests/models/heavy_top.eom", "--vary", "start w = uniform(-1, 1); m = latin(1, 2)"]
SWEEP += ["--members", "96", "--until", "1", "--seed", "5", "--shard-size", "2", "--keep", "end; max(norm(w))"]
# Time limit in s; the machine may be busy.
PATIENCE = 300


def serve(folder):
    """Runs a server until it is killed."""
    from hyperqueue import LocalCluster

    started = LocalCluster(folder)
    forever(started, folder)


def work(folder, server):
    """Runs a worker for a server in another process until it is killed.

    The wheel starts workers only for a server of the same process, which they find by a link in its folder.
    """
    from hyperqueue import LocalCluster
    from hyperqueue.cluster import WorkerConfig

    started = LocalCluster(folder)
    link = pathlib.Path(folder, "hq-current")
    link.unlink()
    link.symlink_to(pathlib.Path(server, "hq-current"))
    started.start_worker(WorkerConfig(cores=1))
    forever(started, folder)


def forever(_held, folder):
    pathlib.Path(folder, "ready").touch()
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
    client = Client(os.environ["SERVER"])
    job = Job()
    # Tasks are numbered from 0.
    job.program(["true"], stdout=os.devnull, stderr=os.devnull)
    for task in range(1, count + 1):
        place = lambda option: options[option].replace("%{TASK_ID}", str(task))
        job.program(["sh", named[8]], cwd=options["--cwd"], stdout=place("--stdout"), stderr=place("--stderr"))
    sys.exit(0 if client.wait_for_jobs([client.submit(job)], raise_on_error=False) else 1)


class Cluster:
    """A server and two workers, each a separate process."""

    def __init__(self, folder):
        folder.mkdir()
        self.server = folder / "server"
        self.processes = [self.start("serve", self.server)]
        self.workers = [self.start("work", folder / f"worker-{i}", self.server) for i in (1, 2)]
        self.processes += self.workers

    def start(self, role, folder, *more):
        folder.mkdir()
        words = [sys.executable, __file__, role, folder, *more]
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, start_new_session=True)
        until(f"{folder}", (folder / "ready").exists)
        return process

    def lose(self, worker):
        """Kills a worker with its tasks as if its machine were lost: it cannot report that they have failed."""
        tasks = []

        def caught():
            os.kill(worker.pid, signal.SIGSTOP)
            found = subprocess.run(["pgrep", "--parent", str(worker.pid)], capture_output=True, text=True).stdout
            tasks.extend(map(int, found.split()))
            if not tasks:
                os.kill(worker.pid, signal.SIGCONT)
            return tasks

        until("a task of the worker", caught)
        for process in (*tasks, worker.pid):
            os.kill(process, signal.SIGKILL)
        worker.wait()

    def kill(self):
        for process in self.processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def test(hamel, folder):
    folder = pathlib.Path(folder)
    whole = folder / "whole"
    subprocess.run([hamel, *SWEEP, "--out", whole], check=True)
    wanted = shards(whole)
    assert len(wanted) == 48

    hq = folder / "hq"
    hq.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{os.path.abspath(__file__)}" submit "$@"\n')
    hq.chmod(0o755)

    def submitted(cluster, runs, **options):
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "SERVER": str(cluster.server)}
        words = [hamel, *SWEEP, "--out", runs, "--submit", "hyperqueue", "--tasks", "16", "--wait"]
        return subprocess.Popen(words, env=environment, start_new_session=True, **options)

    # HyperQueue gives the task of a lost worker to the other one, and the submission succeeds.
    runs, cluster = folder / "runs", Cluster(folder / "cluster")
    try:
        submission = submitted(cluster, runs, stderr=subprocess.DEVNULL)
        until("a shard", lambda: len(shards(runs)) > 4)
        cluster.lose(cluster.workers[0])
        there = len(shards(runs))
        assert there < len(wanted), "it was over before a worker was lost"
        until("the rest", lambda: submission.poll() is not None)
    finally:
        cluster.kill()
    assert submission.returncode == 0
    assert shards(runs) == wanted
    print(f"{len(wanted)} shards by 16 tasks, the same as those of one process: a worker was lost with {there} of them there")

    # Server, workers and client are killed, and the same command is repeated.
    runs, cluster = folder / "again", Cluster(folder / "first")
    submission = submitted(cluster, runs, stderr=subprocess.DEVNULL)
    until("a shard", lambda: len(shards(runs)) > 4)
    os.killpg(submission.pid, signal.SIGKILL)
    submission.wait()
    cluster.kill()
    there = len(shards(runs))
    assert there < len(wanted), "it was over before it was killed"
    cluster = Cluster(folder / "second")
    try:
        # Tasks that outlive their worker keep their parts locked until they end.
        until("the rest", lambda: submitted(cluster, runs).wait() == 0)
    finally:
        cluster.kill()
    assert shards(runs) == wanted
    print(f"the same after all was killed with {there} of {len(wanted)} shards")


def shards(folder):
    return {path.name: path.read_bytes() for path in folder.glob("*.parquet")}


def until(what, holds):
    begin = time.monotonic()
    while not holds():
        assert time.monotonic() - begin < PATIENCE, f"{what} does not happen"
        time.sleep(0.05)


if __name__ == "__main__":
    role, *rest = sys.argv[1:]
    roles = {"serve": serve, "work": work, "submit": lambda *words: submit(list(words)), "test": test}
    roles[role](*rest)
