"""Stand-ins for the solution of a case, importable by workers, and a crew within this process."""

import os
import signal
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from time import sleep

from viscotack import InputError
from viscotack.campaign import read_plan
from viscotack.campaign.crew import Lost


def plan_of(folder, cases=20, text=""):
    """Return a plan of so many cases, the rates of which are 1, 2, ..."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "plan.toml"
    path.write_text(
        f"{text}\n[[grid]]\ntabor = 1.0\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5.0\n"
        f"rate = {[float(i + 1) for i in range(cases)]}\n"
    )
    return read_plan(path)


def stand_in(problem, settings):
    """Return a row that depends on the problem only, at once."""
    curve = [problem.rate * i for i in range(24)]
    words = {"status": "detached", "outcome": "detached"}
    return words | {"pull_off_force": 1 / problem.rate, "trajectory_force": curve}


def rounded(problem, settings):
    """Repeat an input, as a summary does, with its last digit lost."""
    return stand_in(problem, settings) | {"modulus_ratio": 0.1 + 1e-16}


def slow(problem, settings):
    """Do the same in about 20 ms."""
    sleep(0.02)
    return stand_in(problem, settings)


def picky(problem, settings):
    """Refuse every fifth rate."""
    if problem.rate % 5 == 0:
        raise InputError(f"no contact at a rate of {problem.rate:g}")
    return stand_in(problem, settings)


def broken(problem, settings):
    """Crash, as a program with a fault does."""
    raise TypeError("a fault of the program")


def crash_at_seven(problem, settings):
    """Crash in one case."""
    return broken(problem, settings) if problem.rate == 7 else stand_in(problem, settings)


def deadly(problem, settings):
    """End the worker's process in one case."""
    if problem.rate == 7:
        os._exit(1)
    sleep(0.01)
    return stand_in(problem, settings)


def interrupting(problem, settings):
    """Press ctrl-C in one case; only for a crew within the process."""
    if problem.rate == 7:
        os.kill(os.getpid(), signal.SIGINT)
    return stand_in(problem, settings)


class InlineCrew:
    """A crew that does each case when it is handed in; `deaths` names the rates that kill it."""

    def __init__(self, workers=2, deaths=(), certain=False):
        self.count, self.deaths, self.certain = workers, list(deaths), certain
        self.done, self.renewed = [], 0

    def submit(self, function, work, problem, settings):
        future = Future()
        rate = float(problem.split('"rate": ')[1].split(",")[0].rstrip("}"))
        if rate in self.deaths:
            self.deaths.remove(rate)
            future.set_exception(BrokenProcessPool("died"))
            return future
        self.done.append(rate)
        future.set_result(function(work, problem, settings))
        return future

    def outcome(self, future):
        try:
            return future.result()
        except BrokenProcessPool:
            raise Lost("its worker process died", certain=self.certain) from None

    def workers(self):
        return self.count

    def renew(self):
        self.renewed += 1


def employ(monkeypatch, crew):
    """Let `run` use this crew in place of processes."""
    from importlib import import_module

    @contextmanager
    def local(workers):
        yield crew

    # the package has a function of the same name as the module
    monkeypatch.setattr(import_module("viscotack.campaign.running"), "local", local)
    return crew
