"""The cases of a run in processes of this machine."""

import pickle
import runpy
import sys
import types
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from viscotack.pool import Event, Limits, NoWorker, Pool, Setup

from .case import Answer, CaseSettings, Lost, Work, attempt
from .identity import difference, identity

# Seconds beyond the time limit in which a case may still end by itself.
GRACE = 2.0
# Seconds after which a process that is given no case ends: on a cluster none may ever come again.
_IDLE = 600.0


class LocalCrew:
    """A pool of processes for the cases of one run.

    Parameters
    ----------
    packed : bytes
        Work and settings, pickled.
    settings : CaseSettings
        Of which the limits are enforced here.
    workers : int
        Number of processes.
    main : str, optional
        The program in which the work is defined, where that is no module.
    """

    def __init__(
        self, packed: bytes, settings: CaseSettings, workers: int, main: str | None = None
    ) -> None:
        given = packed, main, identity()
        self._pool = Pool(Setup(f"{__name__}:prepare", given, idle=_IDLE), workers)
        self._limits = Limits(
            settings.time_limit, GRACE, interrupts=False, memory=settings.memory_limit
        )
        self.workers, self.processes = self._pool.workers, self._pool.processes
        self.room, self.dismiss = self._pool.room, self._pool.dismiss

    def hand(self, number: int, problem: str) -> None:
        """Give a case to an idle worker."""
        self._pool.hand(number, f"{__name__}:solve_case", problem, self._limits)

    def collect(self, seconds: float) -> list[tuple[int, Answer | Lost]]:
        """Return the answers that arrived; enforce limits meanwhile."""
        return [(number, _answer(event)) for number, event in self._pool.collect(seconds)]


def _answer(event: Event) -> Answer | Lost:
    if event.kind == "answer":
        return event.what
    if event.kind == "lost":
        return Lost(f"its worker process {event.what}")
    failure = "crashed" if event.kind == "failed" else event.kind
    return Answer(None, failure, event.what, event.seconds, event.memory)


@contextmanager
def local(work: Work, settings: CaseSettings, workers: int) -> Iterator[LocalCrew]:
    """Hold a crew of processes for the block; when it ends by an error they are killed."""
    main = None
    if getattr(work, "__module__", None) == "__main__":
        main = getattr(sys.modules["__main__"], "__file__", None)
    crew = LocalCrew(pickle.dumps((work, settings)), settings, workers, main)
    at_once = True
    try:
        yield crew
        at_once = False
    finally:
        crew.dismiss(at_once=at_once)


def prepare(given: tuple[bytes, str | None, dict[str, str]]) -> tuple[Work, CaseSettings]:
    """Unpack work and settings in a worker; NoWorker if it runs another program than its parent."""
    packed, main, wanted = given
    if words := difference(identity(), wanted):
        raise NoWorker(
            f"a worker that has just begun is of another program ({words}): viscotack was "
            "changed while this run went on; what is stored is safe: run again"
        )
    _become(main)
    return pickle.loads(packed)


def solve_case(
    problem: str, tell: Callable[[Any], None], held: tuple[Work, CaseSettings]
) -> Answer:
    """Do one case in a worker."""
    work, settings = held
    return attempt(work, problem, settings)


def _become(main: str | None) -> None:
    """Read the program of the parent, where the work is defined in it, as multiprocessing does."""
    if main is not None:
        module = types.ModuleType("__mp_main__")
        module.__dict__.update(runpy.run_path(main, run_name="__mp_main__"))
        sys.modules["__main__"] = sys.modules["__mp_main__"] = module
