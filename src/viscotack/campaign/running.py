"""Run the missing cases of a plan on an executor, and store rows as they come.

Cases go to the workers in batches that take a quarter of a second, so that many small ones cost
little. Where a worker dies, its executor is replaced, and the cases that were under way are done
again at the end, one at a time: one that kills its worker alone, twice, has failed.
"""

import faulthandler
import json
import signal
import sys
import tempfile
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, partial
from operator import methodcaller
from pathlib import Path
from time import monotonic, perf_counter, sleep
from typing import Any

from viscotack.errors import InputError, NotInstalled, install_command
from viscotack.model.problem.rows import Kind
from viscotack.system import Processes, begin_worker

from .case import CaseSettings, Unsolved, identity, measure
from .plan import Case, Plan, restored_kind
from .store import PASSING, Store, locked

Work = Callable[[Any, CaseSettings], dict[str, Any]]

# Time after which a worker hands in the cases of a batch that it has done [s], and its most cases.
_BATCH, _MOST = 0.25, 200
# Cases that have crashed, without any solved one, after which the run stops.
_CRASHES = 20
# Longest wait for an answer before the clock is looked at, and time between two reports [s].
_LOOK, _REPORT = 0.25, 0.5
# Seconds beyond twice the time limit after which a worker ends itself with a case that hangs.
_GRACE = 5.0
# What futures say of an executor that has broken.
_BROKEN = (BrokenExecutor, CancelledError)
# Time in which the futures of a broken executor end [s].
_BREAKS = 30.0
# Seconds to wait for the scheduler, and for a worker when there is none.
_CONNECT, _WORKER = 30.0, 120.0
# Seconds for which a count of the workers serves: they come and go.
_LISTED = 1.0


class CannotRun(RuntimeError):
    """The cases cannot be run, for a reason that is not theirs; what is stored is safe."""


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
    elapsed_s : float
        Time of this run [s].
    stopped : bool
        The run was asked to stop, and ends when the cases in flight are done.
    """

    cases: int
    done: int
    failed: int
    rate: float = 0.0
    elapsed_s: float = 0.0
    stopped: bool = False


def run(
    plan: Plan | None,
    folder: str | Path,
    *,
    own: Iterable[str | Path] = (),
    workers: int | Callable[[], int] = 1,
    executor: Callable[[], Executor] | None = None,
    retry: bool = False,
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
    workers : int or callable
        Cases that run at a time: processes of this machine, or threads of the executor; a function
        where their number changes.
    executor : callable, optional
        Returns an executor of ``concurrent.futures`` that runs the cases in place of processes of
        this machine, such as :class:`viscotack.campaign.Dask`. It is called again when an executor
        has broken.
    retry : bool
        Also run the cases that have failed. Those that crashed or whose worker died are always run.
    work : callable
        Returns the row of a problem; a stand-in must be importable by the workers.
    report : callable, optional
        Called with a :class:`Progress` twice a second.

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
    CannotRun
        If the first cases all crash, or a worker has another version: a fault of the installation.
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
    if isinstance(workers, int) and workers < 1:
        raise InputError(f"workers must be at least 1, got {workers}")
    if plan is None:
        Store(folder)  # refuses a folder without a campaign before a lock is left in it
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        store = Store(folder) if plan is None else Store.create(folder, plan)
        this = _Run(store, plan or store.plan(own), work, retry=retry, report=report)
        if not this.todo:
            return this.progress()
        count = (lambda: workers) if isinstance(workers, int) else workers
        if executor is None:
            executor = partial(_processes, min(count(), len(this.todo)), this.plan.settings)
        store.note_run()
        return this.go(executor, count)


class _Run:
    """State of one run: cases to do, cases in flight, and how those of the plan stand."""

    def __init__(
        self,
        store: Store,
        plan: Plan,
        work: Work,
        *,
        retry: bool,
        report: Callable[[Progress], None] | None,
    ) -> None:
        self.store, self.plan, self.work, self.report = store, plan, work, report
        # what workers need to know of a campaign
        facts = {name: store.facts[name] for name in ("kind", "problem", "settings", "own")}
        self.statement = json.dumps(facts | {"identity": identity()})
        ended = store.ended()
        self.ended = {case.name: ended[case.name] for case in plan.cases if case.name in ended}
        again = {name for name, why in self.ended.items() if why and (retry or why in PASSING)}
        left = (c for c in plan.cases if c.name not in self.ended or c.name in again)
        self.todo = deque(left)
        # those that were under way when a worker died, and how often one did alone
        self.suspects: deque[Case] = deque()
        self.deaths: Counter[str] = Counter()
        self.flying: dict[Future[list[Answer]], tuple[list[Case], float]] = {}
        self.rows: list[dict[str, Any]] = []
        self.size, self.crashed, self.stored = 1, 0, 0
        self.solved, self.why = None in self.ended.values(), "no reason is known"
        self.began = self.reported = monotonic()
        self.asked = threading.Event()

    def go(self, make: Callable[[], Executor], workers: Callable[[], int]) -> Progress:
        """Do the cases; return when all are stored, or those in flight after a ctrl-C."""
        executor = make()
        try:
            with _asked_to_stop(self.asked):
                while True:
                    slots = workers()
                    while len(self.flying) < slots and (batch := self._next()):
                        try:
                            # the time of a case that is alone has no beginning of a worker in it
                            if not (self.todo or self.flying):
                                wait([executor.submit(_ready, self.statement)], _BREAKS)
                            future = executor.submit(solve, self.work, self.statement, batch)
                        except BrokenExecutor:  # it has just broken, without this batch
                            future = Future()
                            future.set_exception(CancelledError())
                        self.flying[future] = batch, monotonic()
                    self._store()  # while the workers go on
                    if not self.flying:
                        if self.asked.is_set() or not (self.todo or self.suspects):
                            executor.shutdown()
                            return self.progress()
                        sleep(_LOOK)  # until there is a worker
                        continue
                    done = set(wait(self.flying, _LOOK, FIRST_COMPLETED).done)
                    is_broken = any(isinstance(_error(future), _BROKEN) for future in done)
                    if is_broken:
                        wait(self.flying, _BREAKS)  # all of them break
                        done = set(self.flying)
                    self._collect(done)
                    if is_broken:
                        self._store()
                        executor.shutdown(wait=False)
                        executor = make()
        except BaseException:
            if isinstance(executor, Processes):
                executor.kill()
            else:
                executor.shutdown(wait=False)
            raise

    def progress(self) -> Progress:
        """Return how far the run is."""
        elapsed = monotonic() - self.began
        failed = sum(why is not None for why in self.ended.values())
        return Progress(
            cases=len(self.plan.cases),
            done=len(self.ended) - failed,
            failed=failed,
            rate=self.stored / elapsed if elapsed else 0.0,
            elapsed_s=elapsed,
            stopped=self.asked.is_set(),
        )

    def _next(self) -> list[Case]:
        """Return the next batch; none while one that may kill its worker is, or is to be, alone."""
        if self.asked.is_set():
            return []
        if self.todo:
            return [self.todo.popleft() for _ in range(min(self.size, len(self.todo)))]
        return [self.suspects.popleft()] if self.suspects and not self.flying else []

    def _collect(self, done: set[Future[list["Answer"]]]) -> None:
        """Take the answers that came; put back what was not done or lost."""
        was_alone, has_died, wrong = len(self.flying) == 1, False, None
        for future in done:
            batch, begun = self.flying.pop(future)
            error = _error(future)
            if error is None:
                answers = future.result()
                self.size = min(2 * len(answers), _MOST)
                for case, answer in zip(batch, answers, strict=False):
                    self._take(case, answer)
                self.todo.extendleft(reversed(batch[len(answers) :]))
            elif isinstance(error, CancelledError):
                self.todo.extendleft(reversed(batch))
            elif isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker":
                has_died = True
                self.suspects += batch
                if len(batch) == 1 and was_alone:
                    self._died(self.suspects[-1], monotonic() - begun, error)
            else:
                wrong = error
        self.crashed += has_died
        if wrong is not None or (self.crashed >= _CRASHES and not self.solved):
            self._store()
            raise wrong or CannotRun(
                f"the first cases have all crashed or killed their workers; {self.why}; the run "
                "was ended, for the fault is not in the cases"
            )

    def _died(self, case: Case, took: float, error: BaseException) -> None:
        """Give up a case that was alone when its worker died, if it hung or did so twice."""
        self.deaths[case.name] += 1
        limit = self.plan.settings.time_limit
        if took > 2 * limit + _GRACE:
            end = Answer(None, "time limit", f"took more than {limit:g} s and did not end", took)
        elif self.deaths[case.name] == 2:
            end = Answer(None, "worker died", f"its worker was killed, alone: {error}", took)
        else:
            return
        self.suspects.remove(case)
        self._take(case, end)

    def _take(self, case: Case, answer: "Answer") -> None:
        """Make the row of a case that has ended; it waits to be stored."""
        self.crashed += answer.failure in PASSING
        facts: dict[str, Any] = {"name": case.name, **case.inputs}
        if answer.row is None:
            self.why = answer.reason
            found = {"failure": answer.failure, "reason": answer.reason}
            found |= {"versions": identity()}
        else:
            self.solved = True
            # a row repeats inputs that went through the problem, which may cost their last digit
            found = answer.row | facts
        self.rows.append(facts | found | {"wall_time_s": answer.wall_time_s})

    def _store(self) -> None:
        """Store what has ended, and count it as done afterwards."""
        if self.rows:
            self.store.add(self.rows)
            self.ended |= {row["name"]: row.get("failure") for row in self.rows}
            self.stored += len(self.rows)
            self.rows = []
        if self.report is not None and monotonic() - self.reported > _REPORT:
            self.reported = monotonic()
            self.report(self.progress())


@dataclass(frozen=True)
class Answer:
    """Answer of a worker about a case: a row, or the kind of failure and its reason."""

    row: dict[str, Any] | None
    failure: str
    reason: str
    wall_time_s: float


def solve(work: Work, statement: str, batch: list[Case]) -> list[Answer]:
    """Do the first cases of a batch in a worker, as many as end in its time."""
    kind, settings = _read(statement)
    began, answers = perf_counter(), []
    for case in batch:
        # a thread of C ends the process, whatever it does, and says where it was
        longest = 2 * settings.time_limit + _GRACE
        faulthandler.dump_traceback_later(longest, exit=True, file=sys.__stderr__ or 2)
        try:
            answers.append(attempt(work, kind, case.inputs, settings))
        finally:
            faulthandler.cancel_dump_traceback_later()
        if perf_counter() - began > _BATCH:
            break
    return answers


def attempt(work: Work, kind: Kind, inputs: Mapping[str, float], settings: CaseSettings) -> Answer:
    """Do one case; exceptions become failures."""
    began = perf_counter()
    row, failure, reason = None, "", ""
    try:
        found = work(kind.problem(inputs), settings)
        row = json.loads(json.dumps(found, default=methodcaller("item")))  # numbers of NumPy too
    except MemoryError as error:
        failure, reason = "memory limit", f"more memory than its limit: {error}"
    except Unsolved as error:
        failure, reason = "stopped", str(error)
    except InputError as error:
        failure, reason = "refused", str(error)
    except (Exception, SystemExit) as error:
        failure, reason = "crashed", f"{type(error).__name__}: {error}"
    took = perf_counter() - began
    if failure in ("stopped", "refused") and took > settings.time_limit:
        failure, reason = "time limit", f"took more than {settings.time_limit:g} s"
    return Answer(row, failure, reason, took)


def _ready(statement: str) -> None:
    """Do nothing in a worker but what precedes its first case."""
    _read(statement)


@cache
def _read(statement: str) -> tuple[Kind, CaseSettings]:
    """Return kind and settings in a worker, whose own copies of user-defined files are executed."""
    facts = json.loads(statement)
    if identity() != facts["identity"]:
        raise CannotRun(
            f"a worker is of another program ({identity()}, and not {facts['identity']}); it needs "
            "the same versions, and a run ends when viscotack is changed. What is stored is safe: "
            "run again"
        )
    with tempfile.TemporaryDirectory(prefix="viscotack-") as folder:
        own = [Path(folder, str(i), name) for i, (name, _) in enumerate(facts["own"])]
        for path, (_, source) in zip(own, facts["own"], strict=True):
            path.parent.mkdir()
            path.write_text(source, encoding="utf-8")
        settings = CaseSettings(**facts["settings"] | {"own": own})
        also = settings.nouns  # read while the files are there
    return restored_kind(facts["kind"], facts["problem"], also), settings


def _processes(workers: int, settings: CaseSettings) -> Processes:
    return Processes(workers, _begin, (settings.memory_limit,))


def _begin(memory: float) -> None:
    begin_worker(memory)  # with what this module needs, its memory is counted at rest


def _error(future: Future[Any]) -> BaseException | None:
    """Return why a future has no result: it was cancelled, or never ended, with its executor."""
    return CancelledError() if future.cancelled() or not future.done() else future.exception()


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


@dataclass
class Dask:
    """Executors on the workers of a Dask cluster, ``run(plan, folder, executor=dask, ...)``.

    A context manager: the connection is closed at the end of the block.

    Attributes
    ----------
    address : str
        Of the scheduler, ``"tcp://host:8786"``; ``"tls://host:8786"`` with the certificates that
        the configuration of Dask names.
    """

    address: str
    _client: Any = None
    _threads: int = 0
    _counted: float = 0.0
    _seen: float = field(default_factory=monotonic)

    def __enter__(self) -> "Dask":
        return self

    def __exit__(self, *_: object) -> None:
        if self._client is not None:
            self._client.close(timeout=_CONNECT)

    def __call__(self) -> Any:
        """Connect to the scheduler, anew if it was lost, and return an executor.

        Raises
        ------
        ModuleNotFoundError
            If Dask distributed is not installed.
        ConnectionError
            If no scheduler answers at the address.
        """
        try:
            from distributed import Client
        except ImportError:
            raise NotInstalled(
                f"a cluster needs Dask distributed; install it with: {install_command('cluster')}"
            ) from None
        self.__exit__()
        try:
            self._client = Client(self.address, timeout=_CONNECT, set_as_default=False)
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            raise ConnectionError(
                f"no scheduler answers at {self.address!r}: {error}; start one with 'dask "
                "scheduler' and give the address it prints, such as tcp://host:8786. What is "
                "stored is safe"
            ) from None
        self._seen = monotonic()
        return self._client.get_executor(pure=False, retries=0)

    def threads(self) -> int:
        """Return the number of threads of all workers, for :func:`viscotack.campaign.run`.

        Raises
        ------
        ConnectionError
            If there have been none for two minutes.
        """
        now = monotonic()
        if now - self._counted > _LISTED:
            self._counted = now
            try:
                self._threads = sum(self._client.nthreads().values())
            except (OSError, TimeoutError, RuntimeError, ValueError):
                self._threads = 0  # the scheduler is away, and what it had is cancelled
        if self._threads:
            self._seen = now
        elif now - self._seen > _WORKER:
            raise ConnectionError(
                f"the scheduler {self.address} has no workers; start some with "
                f"'dask worker {self.address} --nthreads 1'. What is stored is safe"
            )
        return self._threads
