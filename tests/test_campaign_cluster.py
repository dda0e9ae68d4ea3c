"""A Dask cluster whose machines come and go."""

import json
import os
import random
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from campaign_work import (
    InlineCrew,
    employ,
    plan_of,
    slow,
    stand_in,
    told,
)
from processes import until
from viscotack.campaign import cluster, run

pytest.importorskip("distributed", reason="the cluster extra is not installed")
HERE = Path(__file__).parent
DASK = [sys.executable, "-m", "dask"]


@pytest.fixture(autouse=True)
def findable(monkeypatch):
    monkeypatch.setattr(cluster, "_FIRST", 60.0)  # on a machine that is busy with others
    before = os.environ.get("PYTHONPATH")
    paths = [str(HERE), before] if before else [str(HERE)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(paths))


class Cluster:
    """A scheduler and workers, each a process of its own, over TCP."""

    def __init__(self, folder):
        self.folder = folder
        self.quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.workers = []
        file = folder / "scheduler.json"
        file.unlink(missing_ok=True)
        words = ["--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
        self.scheduler = subprocess.Popen([*DASK, "scheduler", *words], **self.quiet)
        until(lambda: file.exists() and file.read_text().endswith("}"))  # not whole at once
        self.address = json.loads(file.read_text())["address"]

    def hire(self, count=1):
        """Start workers."""
        words = ["--nthreads", "1", "--no-nanny", "--no-dashboard"]
        words += ["--local-directory", str(self.folder)]
        command = [*DASK, "worker", self.address, *words]
        self.workers += [
            subprocess.Popen(command, cwd=self.folder, **self.quiet) for _ in range(count)
        ]

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
def test_twenty_workers_that_come_and_go_give_the_same_table(tmp_path, monkeypatch):
    plan, chance = plan_of(tmp_path, cases=400), random.Random(5)
    with held(tmp_path) as dask:
        dask.hire(3)

        def stir(now):
            if len(dask.workers) < 20 and chance.random() < 0.5:
                dask.hire()
                chance.choice(dask.workers[:-2]).send_signal(
                    chance.choice([signal.SIGKILL, signal.SIGTERM])
                )

        options = {"work": slow, "report": stir, "store_every": 0.3}
        end = run(plan, tmp_path / "c", scheduler=dask.address, **options)
    assert (end.done, end.failed) == (400, 0)
    employ(monkeypatch, InlineCrew())
    run(plan, tmp_path / "here", work=stand_in)
    assert told(tmp_path / "c") == told(tmp_path / "here")
