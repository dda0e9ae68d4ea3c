"""Run a plan into a folder: what is missing, the longest first, and store it as it comes."""

import signal
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from math import prod
from pathlib import Path
from queue import Empty, SimpleQueue
from time import perf_counter
from typing import Any

from viscotack.errors import InputError
from viscotack.files.lock import locked

from .case import Answer, Work, attempt, measure
from .columns import Kind
from .crew import Crew, Gone, Lost, cluster, local
from .plan import Case, Plan
from .store import Store

# So many cases are stored at once, however short the time since the last ones were.
_PART = 1000
# Failures that another run may not meet: it tries their cases again.
PASSING = ("crashed", "worker died")
# When so many cases have ended so, and none was solved, something is wrong with the program.
_CRASHES = 20
# Longest wait for a case to come back before the clock is looked at [s].
_LOOK = 0.25
# A case that was under way at so many deaths of workers is done alone, to know whether it kills.
_SUSPECT = 2


class AllCrashed(RuntimeError):
    """The first cases have all crashed, so that the rest was not tried."""


@dataclass(frozen=True)
class Progress:
    """How far a run is; `done` and `failed` are stored durably.

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
    workers: int = 1,
    scheduler: str | None = None,
    retry: bool = False,
    store_every: float = 2.0,
    work: Work = measure,
    report: Callable[[Progress], None] | None = None,
) -> Progress:
    """Run the cases of a plan that are not in the folder yet.

    Parameters
    ----------
    plan : Plan or None
        What to run; None goes on with the plan in the folder.
    folder : path
        Where the campaign is kept; made if missing.
    workers : int
        Processes on this machine.
    scheduler : str, optional
        Address of a Dask scheduler, ``"tcp://host:8786"``, whose workers do the cases instead.
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
    """
    folder = Path(folder)
    if workers < 1:
        raise InputError(f"workers must be at least 1, got {workers}")
    if plan is None:
        Store(folder)  # refuses a folder without a campaign before a lock is left in it
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        store = Store(folder) if plan is None else Store.create(folder, plan)
        store.tidy()
        this = _Run(
            store,
            store.plan() if plan is None else plan,
            work=work,
            report=report,
            retry=retry,
            store_every=store_every,
        )
        if not this.todo:
            return this.progress()
        number = store.note_run(scheduler=scheduler, workers=workers, to_run=len(this.todo))
        with local(workers) if scheduler is None else cluster(scheduler) as crew:
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


class _Run:
    """One run: what is to do, what is under way, and what waits to be stored."""

    def __init__(
        self,
        store: Store,
        plan: Plan,
        *,
        work: Work,
        report: Callable[[Progress], None] | None,
        retry: bool,
        store_every: float,
    ) -> None:
        self.store, self.plan, self.work, self.report = store, plan, work, report
        self.store_every = store_every
        planned = {case.name for case in plan.cases}
        done, failed = store.finished()
        self.done, self.failed = done & planned, failed.keys() & planned
        lasting = {name for name, failure in failed.items() if failure not in PASSING}
        kept = self.done if retry else self.done | lasting
        left = [case for case in plan.cases if case.name not in kept]
        self.cost = {case.name: expected_cost(plan.kind, case.inputs) for case in left}
        # The longest first, so that no worker is left alone with a long one at the end.
        self.todo = deque(sorted(left, key=lambda case: -self.cost[case.name]))
        self.cost_left, self.cost_done = sum(self.cost.values()), 0.0
        self.suspects: deque[Case] = deque()
        self.deaths: Counter[str] = Counter()
        self.alone = self.broken = False
        self.flying: dict[Future[Answer], Case] = {}
        self.landed: SimpleQueue[Future[Answer]] = SimpleQueue()
        self.crashed = 0
        self.rows: list[dict[str, Any]] = []
        self.reasons: list[dict[str, Any]] = []
        self.began = self.stored_at = perf_counter()
        self.stored, self.busy, self.peak = 0, 0.0, 0.0
        self.workers, self.asked = 1, threading.Event()

    def go(self, crew: Crew) -> Progress:
        """Do the cases; return when all are stored, or those in flight after a ctrl-C."""
        self.crew = crew
        with _asked_to_stop(self.asked):
            try:
                self._hand_out()
                while self.flying:
                    self._collect()
                    due = perf_counter() - self.stored_at > self.store_every
                    if due or self._waiting() >= _PART:
                        self._store()
                    self._hand_out()
            except (KeyboardInterrupt, Gone):
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
            done=len(self.done),
            failed=len(self.failed),
            rate=self.stored / elapsed,
            remaining_s=self.cost_left * elapsed / self.cost_done if known else None,
            elapsed_s=elapsed,
            worker_use=self.busy / (elapsed * self.workers),
            peak_memory=self.peak,
            stopped=self.asked.is_set(),
        )

    def _hand_out(self) -> None:
        """Give the crew enough that no worker waits, and little that a death would cost."""
        if self.asked.is_set() or (self.broken and self.flying):
            return
        if self.broken:
            self.crew.renew()
            self.broken = False
        self.workers = self.crew.workers()
        while len(self.flying) < 2 * self.workers + 1 and not (self.alone and self.flying):
            self.alone = bool(self.suspects)
            if self.alone and self.flying:
                return
            if not self.suspects and not self.todo:
                return
            case = (self.suspects or self.todo).popleft()
            problem = self.plan.problem(case)
            future = self.crew.submit(attempt, self.work, problem, self.store.settings)
            self.flying[future] = case
            future.add_done_callback(self.landed.put)

    def _collect(self) -> None:
        """Take what has come back; wait a little if nothing has."""
        try:
            future = self.landed.get(timeout=_LOOK)
        except Empty:
            return
        case = self.flying.pop(future)
        try:
            answer = self.crew.outcome(future)
        except Lost as death:
            self.broken = True
            self.deaths[case.name] += 1
            if self.alone or death.certain:
                self._take(case, Answer(None, "worker died", str(death), 0.0, 0.0))
            elif self.deaths[case.name] < _SUSPECT:
                self.todo.appendleft(case)
            else:
                self.suspects.append(case)
        else:
            self._take(case, answer)

    def _take(self, case: Case, answer: Answer) -> None:
        self.cost_left -= self.cost[case.name]
        self.cost_done += self.cost[case.name]
        self.busy += answer.wall_time_s
        self.peak = max(self.peak, answer.peak_memory)
        facts: dict[str, Any] = {"name": case.name, **case.inputs}
        if answer.row is not None:
            # A row repeats inputs that went through the problem, which may cost their last digit.
            self.rows.append(facts | answer.row | facts | {"wall_time_s": answer.wall_time_s})
        else:
            why = {"failure": answer.failure, "reason": answer.reason}
            self.reasons.append(facts | why | {"wall_time_s": answer.wall_time_s})
            self.crashed += answer.failure in PASSING
        if self.crashed >= _CRASHES and not (self.done or self.rows):
            raise AllCrashed(
                f"the first {self.crashed} cases have all crashed, the last with {answer.reason}; "
                "the run was ended, for the fault is not in the cases"
            )

    def _waiting(self) -> int:
        return len(self.rows) + len(self.reasons)

    def _store(self) -> None:
        """Store what waits, and only then call it done."""
        if self._waiting():
            rows, reasons, self.rows, self.reasons = self.rows, self.reasons, [], []
            self.store.add(rows, reasons)
            self.done |= {row["name"] for row in rows}
            self.failed = (self.failed | {row["name"] for row in reasons}) - self.done
            self.stored += len(rows) + len(reasons)
        self.stored_at = perf_counter()
        if self.report is not None:
            self.report(self.progress())


def expected_cost(kind: Kind, inputs: Mapping[str, float]) -> float:
    """Return the expected time of a case beside that of others of its kind; no unit."""
    powers = ((inputs.get(name, 1.0), power) for name, power in kind.cost.items())
    return float(prod(max(abs(value), 1e-3) ** power for value, power in powers))


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
