"""A Dask cluster whose machines come and go."""

import os
import random
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

from campaign_work import Inline, plan_of, slow, stand_in, told
from viscotack.campaign import Dask, run

pytest.importorskip("distributed", reason="the cluster extra is not installed")
HERE = Path(__file__).parent
DASK = [sys.executable, "-m", "dask"]


@pytest.fixture(autouse=True)
def findable(monkeypatch):
    before = os.environ.get("PYTHONPATH")
    paths = [str(HERE), before] if before else [str(HERE)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "1")


def until(condition, seconds=120.0):
    """Wait for a state; the longest time decides no test."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it has not come about"
        time.sleep(0.01)


class Cluster:
    """A scheduler and workers, each a process of its own, over TCP."""

    def __init__(self, folder):
        self.folder, self.workers = folder, []
        self.quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.begin()

    def begin(self):
        """Start the scheduler, always at the same address."""
        file = self.folder / "scheduler.json"
        file.unlink(missing_ok=True)
        words = ["--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard"]
        command = [*DASK, "scheduler", *words, "--scheduler-file", str(file)]
        self.scheduler = subprocess.Popen(command, **self.quiet)
        until(lambda: file.exists() and file.read_text().endswith("}"))  # not whole at once

    def hire(self, count=1):
        """Start workers."""
        words = ["--nthreads", "1", "--no-nanny", "--no-dashboard"]
        command = [*DASK, "worker", self.address, *words]
        self.workers += [subprocess.Popen(command, **self.quiet) for _ in range(count)]

    def end(self):
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


@contextmanager
def held(folder):
    found = Cluster(folder)
    try:
        yield found
    finally:
        found.end()


@pytest.mark.slow
def test_workers_that_come_and_go_and_a_new_scheduler_give_the_same_table(tmp_path, monkeypatch):
    plan, chance = plan_of(tmp_path, cases=400), random.Random(5)
    with held(tmp_path) as cluster, Dask(cluster.address) as dask:
        cluster.hire(3)

        def stir(now):
            if len(cluster.workers) < 8 and now.done > 30 * len(cluster.workers):
                cluster.hire()
                chance.choice(cluster.workers[:-2]).send_signal(
                    chance.choice([signal.SIGKILL, signal.SIGTERM])
                )
            if now.done > 200 and not stirred:
                stirred.append(cluster.scheduler.kill())
                cluster.scheduler.wait()
                cluster.begin()
                cluster.hire(2)

        stirred = []
        options = {"work": slow, "report": stir, "workers": dask.threads, "executor": dask}
        end = run(plan, tmp_path / "c", **options)
    assert (end.done, end.failed) == (400, 0) and stirred
    run(plan, tmp_path / "here", work=stand_in, executor=Inline())
    assert told(tmp_path / "c") == told(tmp_path / "here")
