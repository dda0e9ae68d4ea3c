"""Processes of this machine, each with one case at a time, and none of them trusted to end it.

The supervisor has no threads and waits for nobody: it looks at all its workers some twenty times a
second. One that is beyond a limit, or gives no sign of life, is killed, and another one takes its
place; its case is the only one that it can take along.
"""

import os
import pickle
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from time import monotonic, sleep
from typing import Any

from .case import Answer, CaseSettings, Work
from .crew import Lost, NoWorker
from .identity import difference, identity
from .memory import resident_memory
from .worker import Line

# What a worker does first, before it imports anything that takes a while: where the system can kill
# it when its parent ends, also while it waits in C, it is asked to.
_MORTAL = """\
import ctypes, os, signal, sys
if sys.platform == "linux":
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
if os.getppid() != {parent}:
    os._exit(1)  # it has ended already
"""
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Seconds between two looks at the workers: a limit is kept to about as much.
_LOOK = 0.05
# Seconds beyond the time limit in which a case may still end by itself.
GRACE = 2.0
# Seconds without a sign of life after which a worker is taken for stopped; it gives one a second,
# but not while foreign code holds the interpreter.
_SILENCE = 60.0
# Seconds that a process may take to import what it needs, on a machine that is busy with others.
_START = 60.0
# So many starts in a row that come to nothing, and there will be no worker.
_STARTS = 3
# Seconds in which a worker takes a message, and in which one that is dismissed ends.
_PATIENCE = 5.0
# Of two looks no more is counted than so much [s]: a machine that slept, a run that was halted by
# ctrl-Z together with its workers, is no case that took long.
_LONGEST = 1.0


@dataclass(eq=False)
class _Worker:
    """A process, and what is known of it; times are counted in looks [s]."""

    process: subprocess.Popen[bytes]
    line: Line
    ready: bool = False
    number: int | None = None
    age: float = 0.0
    silence: float = 0.0
    base: float = 0.0
    most: float = 0.0
    news: list[Any] = field(default_factory=list)

    def begin(self, number: int) -> None:
        """Count for a case from now on."""
        self.number, self.age, self.silence = number, 0.0, 0.0
        self.base = self.most = resident_memory(self.process.pid)


class LocalCrew:
    """Worker processes and their supervisor.

    Parameters
    ----------
    packed : bytes
        Work and settings, pickled.
    settings : CaseSettings
        Of which the limits are kept here.
    workers : int
        How many processes.
    main : str, optional
        The program in which the work is defined, where that is no module.
    """

    def __init__(
        self, packed: bytes, settings: CaseSettings, workers: int, main: str | None = None
    ) -> None:
        self._first, self._settings, self._count = (packed, main), settings, workers
        self._workers: list[_Worker] = []
        self._failed = 0
        self._looked = monotonic()

    def room(self) -> int:
        """Return how many workers are idle; missing ones are started, and take a while."""
        while len(self._workers) < self._count:
            self._workers.append(self._start())
        return sum(worker.ready and worker.number is None for worker in self._workers)

    def hand(self, number: int, problem: str) -> None:
        """Give a case to an idle worker."""
        worker = next(w for w in self._workers if w.ready and w.number is None)
        worker.begin(number)
        # one that has just ended is met by the next look, with its case
        with suppress(OSError):
            worker.line.send(problem, _PATIENCE)

    def collect(self, seconds: float) -> list[tuple[int, Answer | Lost]]:
        """Return what has come back; limits are kept meanwhile."""
        until = monotonic() + seconds
        while True:
            wait = max(0.0, min(_LOOK, until - monotonic()))
            lines = {worker.line: worker for worker in self._workers}
            heard = select.select(list(lines), [], [], wait)[0] if lines else sleep(wait) or []
            found = [*self._listened(lines[line] for line in heard), *self._looked_after()]
            if found or monotonic() >= until:
                return found

    def workers(self) -> int:
        """Return the number of processes."""
        return self._count

    def processes(self) -> list[int]:
        """Return the numbers of the processes that live."""
        return [worker.process.pid for worker in self._workers]

    def dismiss(self, *, at_once: bool) -> None:
        """End the processes: when they have seen that nobody needs them, or at once."""
        for worker in self._workers:
            if at_once or worker.number is not None:
                # before its line closes, or it might end by itself first
                worker.process.kill()
            worker.line.close()
        until = monotonic() + _PATIENCE
        for worker in self._workers:
            try:
                worker.process.wait(max(0.0, until - monotonic()))
            except subprocess.TimeoutExpired:
                _end(worker.process)
        self._workers.clear()

    def _start(self) -> _Worker:
        ours, theirs = socket.socketpair()
        with theirs:
            # the child begins with what is blocked here: ctrl-C is never for it
            deaf = (signal.SIGINT, signal.SIGTERM)
            before = signal.pthread_sigmask(signal.SIG_BLOCK, deaf)
            try:
                process = subprocess.Popen(
                    [sys.executable, "-c", _program(theirs.fileno())],
                    stdin=subprocess.DEVNULL,
                    stdout=2,  # what the work prints is no answer of the command
                    pass_fds=[theirs.fileno()],
                    env=os.environ | dict.fromkeys(_THREADS, "1"),
                )
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)
        worker = _Worker(process, Line(ours))
        with suppress(OSError):
            worker.line.send(self._first, _PATIENCE)
        return worker

    def _listened(self, workers: Any) -> Iterator[tuple[int, Answer | Lost]]:
        for worker in workers:
            try:
                messages = worker.line.receive()
            except EOFError:
                yield from self._remove(worker, _ended(worker))
                continue
            worker.silence = 0.0
            for kind, what in messages:
                if kind == "ready":
                    self._check(what)
                    worker.ready, self._failed = True, 0
                elif kind == "unfit":
                    raise NoWorker(f"no worker can begin: {what}")
                elif kind == "answer" and worker.number is not None:
                    yield worker.number, what
                    worker.number = None

    def _check(self, theirs: dict[str, str]) -> None:
        if words := difference(theirs, identity()):
            raise NoWorker(
                f"a worker that has just begun is of another program ({words}): viscotack was "
                "changed while this run went on; what is stored is safe: run again"
            )

    def _looked_after(self) -> Iterator[tuple[int, Answer | Lost]]:
        now = monotonic()
        passed, self._looked = min(now - self._looked, _LONGEST), now
        for worker in list(self._workers):
            worker.age += passed
            worker.silence += passed
            if not worker.ready:
                if worker.age > _START:
                    _end(worker.process)
                    yield from self._remove(worker, f"did not begin in {_START:g} s")
            elif worker.number is not None:
                yield from self._kept(worker)

    def _kept(self, worker: _Worker) -> Iterator[tuple[int, Answer | Lost]]:
        """End the process of a case that is beyond a limit, or of which nothing is heard."""
        assert worker.number is not None
        limits, number = self._settings, worker.number
        resident = resident_memory(worker.process.pid)
        worker.most = max(worker.most, resident)
        gained = resident - worker.base
        if worker.age > limits.time_limit + GRACE:
            kind = "time limit"
            reason = f"took more than {limits.time_limit:g} s and did not end by itself"
        elif gained > limits.memory_limit:
            kind = "memory limit"
            reason = f"took {gained / 1e6:.0f} MB, more than {limits.memory_limit / 1e6:g} MB"
        elif worker.silence > _SILENCE:
            _end(worker.process)
            yield from self._remove(worker, f"gave no sign of life for {_SILENCE:g} s")
            return
        else:
            return
        _end(worker.process)
        worker.number = None
        yield from self._remove(worker, "")
        yield number, Answer(None, kind, reason, worker.age, worker.most)

    def _remove(self, worker: _Worker, reason: str) -> Iterator[tuple[int, Lost]]:
        """Forget a process that has ended; its case, if it had one, is lost."""
        self._workers.remove(worker)
        worker.line.close()
        if worker.number is not None:
            yield worker.number, Lost(f"its worker process {reason}")
        elif not worker.ready:
            self._failed += 1
            if self._failed >= _STARTS:
                raise NoWorker(
                    f"{self._failed} worker processes in a row have ended before they began; the "
                    f"last one {reason}"
                )


@contextmanager
def local(work: Work, settings: CaseSettings, workers: int) -> Iterator[LocalCrew]:
    """Hold a crew of processes for the block; when it ends by an error they are ended at once."""
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


def _program(handle: int) -> str:
    """Return what a fresh interpreter does to be a worker; modules are found where we find them."""
    return _MORTAL.format(parent=os.getpid()) + (
        f"sys.path[:] = {sys.path!r}\n"
        f"from viscotack.campaign.worker import serve\n"
        f"serve({handle})\n"
    )


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process, which cannot refuse; the system may be slow to bury it."""
    process.kill()
    with suppress(subprocess.TimeoutExpired):
        process.wait(_PATIENCE)


def _ended(worker: _Worker) -> str:
    """Return how a process has ended, in words."""
    try:
        code = worker.process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        _end(worker.process)
        return "closed its line"
    if code < 0:
        return f"was ended by {signal.Signals(-code).name}: killed, out of memory or crashed"
    return f"ended with status {code}"
