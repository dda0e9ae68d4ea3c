"""Run the missing cases of a plan, longest first, and store the results as they arrive."""

import signal
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.lock import locked
from viscotack.pool import NoWorker

from .case import Answer, Lost, Work, measure
from .cases import PASSING, Cases
from .cluster import Gone, Security, check_installed, cluster
from .columns import Kind
from .identity import identity, words
from .local import local
from .plan import Plan
from .store import Store

# Number of waiting cases that are stored immediately.
_PART = 1000
# Number of crashed cases, without any solved one, after which the run stops.
_CRASHES = 20
# Longest wait for a case to come back before the clock is looked at [s].
_LOOK = 0.25
# Number of processes, and of machines, that a case may lose; the last attempt runs alone.
_LIVES, _DEPARTURES = 3, 20


class AllCrashed(RuntimeError):
    """All of the first cases crashed, so the run was stopped."""


@dataclass(frozen=True)
class Progress:
    """Progress of a run, returned by :func:`run`; `done` and `failed` are stored durably.

    Attributes
    ----------
    cases : int
        Of the plan.
    done, failed : int
        With a result, and with a failure only, in this and in earlier runs.
    rate : float
        Cases stored a second in this run; 0 while there are none.
    remaining_s : float or None
        Expected time to the end [s], from the expected cost of the cases; None while unknown.
    elapsed_s : float
        Time of this run [s].
    worker_use : float
        Share of that time in which the workers were at a case; it counts their start.
    peak_memory : float
        Largest resident memory that a worker has had [bytes]; 0 where unknown.
    stopped : bool
        The run was asked to stop, and ends when the cases in flight are done.
    """

    cases: int
    done: int
    failed: int
    rate: float = 0.0
    remaining_s: float | None = None
    elapsed_s: float = 0.0
    worker_use: float = 0.0
    peak_memory: float = 0.0
    stopped: bool = False


def run(
    plan: Plan | None,
    folder: str | Path,
    *,
    own: Iterable[str | Path] = (),
    workers: int = 1,
    scheduler: str | None = None,
    security: Security | None = None,
    retry: bool = False,
    store_every: float = 2.0,
    work: Work = measure,
    report: Callable[[Progress], None] | None = None,
) -> Progress:
    """Run the cases of a plan that have no result in the folder yet.

    Parameters
    ----------
    plan : Plan or None
        The plan; None resumes the plan in the folder.
    folder : path
        Where the campaign is kept; made if missing.
    own : iterable of path
        Python files that may be executed, to go on with a campaign that was planned with them; of
        a plan `read_plan` was given them.
    workers : int
        Processes on this machine.
    scheduler : str, optional
        Address of a Dask scheduler, ``"tcp://host:8786"``, whose workers do the cases instead.
    security : Security, optional
        Certificates for a scheduler at ``"tls://host:8786"``.
    retry : bool
        Also run the cases that have failed. Those that crashed or whose worker died are always run.
    store_every : float
        Time between two parts of the store [s]: what a crash can cost.
    work : callable
        Returns the row of a problem; a stand-in must be importable by the workers.
    report : callable, optional
        Called with a :class:`Progress` at every such time.

    Returns
    -------
    Progress
        At the end.

    Raises
    ------
    FolderInUse
        If another run writes to the folder.
    OSError
        If the disk is full, or the scheduler cannot be reached; what was stored before is safe.
    AllCrashed
        If the first cases all crash: a fault of the program, or of its installation.
    ValueError
        If the folder holds a campaign of another kind or accuracy.

    Examples
    --------
    >>> import tempfile
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> from viscotack.campaign import CaseSettings, every_combination
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> plan = every_combination(base, {"tabor": 1.0}, settings=CaseSettings(accuracy=0.02))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     run(plan, folder).done
    1
    """
    folder = Path(folder)
    if workers < 1:
        raise InputError(f"workers must be at least 1, got {workers}")
    if plan is None:
        Store(folder)  # refuses a folder without a campaign before a lock is left in it
    arrow()  # what is not installed is said before a folder is made
    if scheduler is not None:
        check_installed()
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder) as hold:
        _check_whole(folder)
        store = Store(folder, hold) if plan is None else Store.create(folder, plan, hold)
        store.tidy()
        this = _Run(
            store,
            store.plan(own) if plan is None else plan,
            report=report,
            retry=retry,
            store_every=store_every,
        )
        if not this.left():
            return this.progress()
        settings = this.plan.settings
        settings.nouns()  # rejects user-defined files that have been edited
        number = store.note_run(scheduler=scheduler, workers=workers, to_run=this.left())
        count = min(workers, this.left())
        hired = (
            local(work, settings, count)
            if scheduler is None
            else cluster(work, settings, scheduler, security)
        )
        with hired as crew:
            end = this.go(crew)
        store.note_run(
            number,
            elapsed_s=round(end.elapsed_s, 2),
            done=end.done,
            failed=end.failed,
            worker_use=round(end.worker_use, 3),
            peak_memory_MB=round(end.peak_memory / 1e6, 1),
            stopped=end.stopped,
        )
        return end


def _check_whole(folder: Path) -> None:
    """Refuse the folder of an interrupted merge: the missing cases are in other folders."""
    if (folder / "provenance.json").exists() and (begun := Store(folder).merging):
        raise InputError(
            f"{folder} holds a merge of {', '.join(begun)} that has not ended; merge them again "
            "into it"
        )


class Crew(Protocol):
    """Workers that take cases by number, here or on a cluster, and bring back answers or a loss."""

    def room(self) -> int:
        """Return how many more cases may be submitted; NoWorker if there is no worker."""
        ...

    def hand(self, number: int, problem: str) -> None:
        """Give a case, with an identifier of the caller, to a worker with capacity."""
        ...

    def collect(self, seconds: float) -> list[tuple[int, Answer | Lost]]:
        """Return the answers that arrived, after waiting at most the given time [s]."""
        ...

    def workers(self) -> int:
        """Return the number of cases run in parallel."""
        ...


class _Run:
    """State of one run: cases to do, running cases, and rows to store.

    Cases are numbers here, their places in the plan.
    """

    def __init__(
        self,
        store: Store,
        plan: Plan,
        *,
        report: Callable[[Progress], None] | None,
        retry: bool,
        store_every: float,
    ) -> None:
        self.store, self.plan, self.report = store, plan, report
        self.store_every = store_every
        self.standing = store.standing(plan.cases)
        kept = self.standing.done if retry else self.standing.done | self.standing.lasting
        left = np.flatnonzero(~kept)
        self.cost = expected_costs(plan.kind, plan.cases)
        # The longest first, so that no worker is left alone with a long one at the end.
        self.todo = left[np.argsort(-self.cost[left], kind="stable")]
        self.next = 0
        self.cost_left, self.cost_done = float(self.cost[left].sum()), 0.0
        # What was lost is done again: first among the others, then after them and alone.
        self.again: deque[int] = deque()
        self.suspects: deque[int] = deque()
        self.losses: Counter[tuple[int, bool]] = Counter()
        self.flying: set[int] = set()
        self.crashed = 0
        self.rows: list[dict[str, Any]] = []
        self.reasons: list[dict[str, Any]] = []
        self.began = self.stored_at = perf_counter()
        self.stored, self.busy, self.peak = 0, 0.0, 0.0
        self.workers, self.asked = 1, threading.Event()

    def left(self) -> int:
        """Count the cases that have not been submitted yet."""
        return len(self.todo) - self.next + len(self.again) + len(self.suspects)

    def go(self, crew: Crew) -> Progress:
        """Do the cases; return when all are stored, or those in flight after a ctrl-C."""
        with _asked_to_stop(self.asked):
            try:
                while self._hand_out(crew) or self.flying:
                    for number, answer in crew.collect(_LOOK):
                        self._collect(number, answer)
                    due = perf_counter() - self.stored_at > self.store_every
                    if due or self._waiting() >= _PART:
                        self._store()
            except (KeyboardInterrupt, Gone, NoWorker):
                self._store()
                raise
            self._store()
        return self.progress()

    def progress(self) -> Progress:
        """Return how far the run is."""
        elapsed = perf_counter() - self.began
        known = self.stored and self.cost_done
        return Progress(
            cases=len(self.plan.cases),
            done=int(self.standing.done.sum()),
            failed=int(self.standing.failed.sum()),
            rate=self.stored / elapsed,
            remaining_s=self.cost_left * elapsed / self.cost_done if known else None,
            elapsed_s=elapsed,
            worker_use=self.busy / (elapsed * self.workers),
            peak_memory=self.peak,
            stopped=self.asked.is_set(),
        )

    def _hand_out(self, crew: Crew) -> bool:
        """Give the crew as many cases as it accepts; return whether any are left."""
        if self.asked.is_set() or not self.left():
            return False
        room = crew.room()
        self.workers = crew.workers()
        while room > 0 and (number := self._next()) is not None:
            room -= 1
            self.flying.add(number)
            crew.hand(number, self.plan.problem(self.plan.cases[number]))
        return True

    def _next(self) -> int | None:
        """Return the next case; None while one that may kill its worker is, or is to be, alone."""
        if self.again:
            return self.again.popleft()
        if self.next < len(self.todo):
            self.next += 1
            return int(self.todo[self.next - 1])
        if self.suspects and not self.flying:
            return self.suspects.popleft()
        return None

    def _collect(self, number: int, answer: Answer | Lost) -> None:
        self.flying.remove(number)
        if isinstance(answer, Answer):
            self._take(number, answer)
            return
        self.losses[number, answer.blame] += 1
        lost, most = self.losses[number, answer.blame], _LIVES if answer.blame else _DEPARTURES
        if lost >= most:
            self._take(number, Answer(None, "worker died", answer.reason, 0.0, 0.0))
        elif answer.blame and lost == most - 1:
            self.suspects.append(number)
        else:
            self.again.append(number)

    def _take(self, number: int, answer: Answer) -> None:
        self.cost_left -= self.cost[number]
        self.cost_done += self.cost[number]
        self.busy += answer.wall_time_s
        self.peak = max(self.peak, answer.peak_memory)
        case = self.plan.cases[number]
        facts: dict[str, Any] = {"name": case.name, **case.inputs}
        if answer.row is not None:
            # A row repeats inputs that went through the problem, which may cost their last digit.
            self.rows.append(facts | answer.row | facts | {"wall_time_s": answer.wall_time_s})
        else:
            why = {"failure": answer.failure, "reason": answer.reason}
            why |= {"versions": answer.versions or words(identity())}
            self.reasons.append(facts | why | {"wall_time_s": answer.wall_time_s})
            self.crashed += answer.failure in PASSING
        if self.crashed >= _CRASHES and not (self.rows or self.standing.done.any()):
            raise AllCrashed(
                f"the first {self.crashed} cases have all crashed, the last with {answer.reason}; "
                "the run was ended, for the fault is not in the cases"
            )

    def _waiting(self) -> int:
        return len(self.rows) + len(self.reasons)

    def _store(self) -> None:
        """Store the waiting results, and count them as done afterwards."""
        if self._waiting():
            rows, reasons, self.rows, self.reasons = self.rows, self.reasons, [], []
            self.store.add(rows, reasons)
            self.standing.note(self.plan.cases, rows, reasons)
            self.stored += len(rows) + len(reasons)
        else:
            self.store.confirm()
        self.stored_at = perf_counter()
        if self.report is not None:
            self.report(self.progress())


def expected_costs(kind: Kind, cases: Cases) -> npt.NDArray[np.float64]:
    """Return the expected times of cases beside one another; no unit."""
    found = np.ones(len(cases))
    for name, power in kind.cost.items():
        if name in cases.columns:
            values = np.maximum(np.abs(cases.columns[name]), 1e-3) ** power
            found *= np.where(np.isnan(values), 1.0, values)
    return found


@contextmanager
def _asked_to_stop(asked: threading.Event) -> Iterator[None]:
    """Let the first ctrl-C, or SIGTERM of a batch system, ask for an end; the next forces it."""

    def stop(*_: Any) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    if threading.current_thread() is not threading.main_thread():
        yield  # signals are for the main thread, which has its own way to end
        return
    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
