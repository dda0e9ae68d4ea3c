"""Stand-ins for the solution of a case, importable by workers, and a crew within this process."""

import ctypes
import json
import os
import signal
from contextlib import contextmanager
from pathlib import Path
from time import sleep

from viscotack import InputError
from viscotack.campaign import Store, read_plan
from viscotack.campaign.case import Lost, attempt


def plan_of(folder, cases=20, text="", own=()):
    """Return a plan of so many cases, the rates of which are 1, 2, ..."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "plan.toml"
    path.write_text(
        f"{text}\n[[grid]]\ntabor = 1.0\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5.0\n"
        f"rate = {[float(i + 1) for i in range(cases)]}\n"
    )
    return read_plan(path, own=own)


def stand_in(problem, settings):
    """Return a row that depends on the problem only, at once."""
    curve = [problem.rate * i for i in range(24)]
    words = {"status": "detached", "outcome": "detached"}
    return words | {"pull_off_force": 1 / problem.rate, "trajectory_force": curve}


def slow(problem, settings):
    """Do the same in about 20 ms."""
    sleep(0.02)
    return stand_in(problem, settings)


def picky(problem, settings):
    """Refuse every fifth rate."""
    if problem.rate % 5 == 0:
        raise InputError(f"no contact at a rate of {problem.rate:g}")
    return stand_in(problem, settings)


def tell_that_it_began():
    """Leave a file by the number of this process, where somebody waits for it."""
    if folder := os.environ.get("CAMPAIGN_TEST_BEGAN"):
        Path(folder, str(os.getpid())).touch()


def waiting(problem, settings):
    """Wait in C, where no exception reaches."""
    tell_that_it_began()
    ctypes.CDLL(None).sleep(1000)


def interrupting(problem, settings):
    """Press ctrl-C in one case; only for a crew within the process."""
    if problem.rate == 7:
        os.kill(os.getpid(), signal.SIGINT)
    return stand_in(problem, settings)


def told(folder):
    """Return all that a campaign says, but for wall times."""
    store = Store(folder)
    tables = [table.to_pylist() for table in (store.results(), store.failures())]
    for row in (row for table in tables for row in table):
        row.pop("wall_time_s")
    return *tables, store.cases(), store.settings


def finished(store):
    """Return the names of the cases with a result, and the failures by name of the others."""
    failed = {row["name"]: row["failure"] for row in store.failures().to_pylist()}
    return {row["name"] for row in store.results().to_pylist()}, failed


class InlineCrew:
    """A crew that does each case when it is handed in; `deaths` names the rates that kill it."""

    def __init__(self, workers=2, deaths=(), blame=True):
        self.count, self.deaths, self.blame = workers, list(deaths), blame
        self.done, self.alone, self.waiting = [], [], []

    def room(self):
        return 2 * self.count + 1 - len(self.waiting)

    def hand(self, number, problem):
        rate = json.loads(problem)["groups"].get("rate")
        if rate in self.deaths:
            self.deaths.remove(rate)
            self.alone.append(not self.waiting)
            self.waiting.append((number, Lost("its worker process died", blame=self.blame)))
            return
        self.done.append(rate)
        self.waiting.append((number, attempt(self.work, problem, self.settings)))

    def collect(self, seconds):
        return [self.waiting.pop(0)] if self.waiting else []

    def workers(self):
        return self.count


def employ(monkeypatch, crew):
    """Let `run` use this crew in place of processes."""
    from importlib import import_module

    @contextmanager
    def local(work, settings, workers):
        crew.work, crew.settings = work, settings
        crew.waiting.clear()
        yield crew

    # the package has a function of the same name as the module
    monkeypatch.setattr(import_module("viscotack.campaign.running"), "local", local)
    return crew
