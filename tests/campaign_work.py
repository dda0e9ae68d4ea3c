"""Stand-ins for the solution of a case, importable by workers, and an executor in this process."""

import ctypes
import os
import signal
from concurrent.futures import BrokenExecutor, Executor, Future
from time import sleep

from viscotack import InputError
from viscotack.campaign import Store, read_plan


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


def interrupting(problem, settings):
    """Press ctrl-C in one case; only within this process."""
    if problem.rate == 7:
        os.kill(os.getpid(), signal.SIGINT)
    return stand_in(problem, settings)


def dangerous(problem, settings):
    """Kill the worker, hang in C, or take much memory, by the rate."""
    if problem.rate == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    if problem.rate == 3:
        ctypes.PyDLL(None).sleep(1000)
    if problem.rate == 4:
        bytearray(2_000_000_000)
    return stand_in(problem, settings)


def told(folder):
    """Return all that a campaign says, but for wall times."""
    store = Store(folder)
    tables = [list(store.results()), list(store.failures())]
    for row in (row for table in tables for row in table):
        row.pop("wall_time_s")
    return *tables, store.cases(), store.settings


class Inline(Executor):
    """An executor that does each batch when it is submitted; some rates kill it."""

    def __init__(self, deaths=()):
        self.deaths, self.done, self.lost = deaths, [], []

    def __call__(self):
        """Return an executor that is not broken."""
        return self

    def submit(self, function, *given):
        future = Future()
        if len(given) == 1:  # it is asked whether it has begun
            future.set_result(function(*given))
            return future
        work, statement, batch = given
        rates = [case.inputs["rate"] for case in batch]
        if set(rates) & set(self.deaths):
            self.lost.append(rates)
            future.set_exception(BrokenExecutor("a process died"))
            return future
        answers = function(work, statement, batch)
        self.done += rates[: len(answers)]
        future.set_result(answers)
        return future
