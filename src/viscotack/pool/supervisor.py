"""Supervisor of worker processes. It has no threads and never blocks on a worker.

It polls the workers about twenty times a second while any of them is busy. A worker that exceeds a
limit or sends no heartbeat is killed and replaced; only its own task is lost.
"""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from math import inf
from selectors import EVENT_READ, DefaultSelector
from time import monotonic
from typing import Any

from viscotack import system

from .event import Event, Kind, NoWorker
from .line import Code, Line

# First lines of a worker process, run before any slow import. On Linux the kernel then kills the
# worker when its parent ends, even while it runs C code.
_MORTAL = """\
import ctypes, os, signal, sys
if sys.platform == "linux":
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
# in a virtual environment of Windows the parent is a launcher
if os.name == "posix" and os.getppid() != {parent}:
    os._exit(1)  # the parent has ended already
"""
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Interval between two polls of the workers [s]; limits are enforced with about this accuracy.
LOOK = 0.05
# Time without a heartbeat after which a worker counts as suspended [s]. Workers send one a second,
# except while compiled code holds the interpreter lock.
_SILENCE = 60.0
# Time allowed for the imports of a new process on a busy machine [s].
_START = 120.0
# Consecutive failed starts after which the pool gives up.
_STARTS = 3
# Time allowed for a worker to receive a message, and for a dismissed worker to end [s].
_PATIENCE = 5.0
# Longest time counted between two polls [s], so that a sleeping machine, or a run suspended by
# ctrl-Z together with its workers, does not cause time-limit failures.
_LONGEST = 1.0


@dataclass(frozen=True)
class Setup:
    """Start-up configuration of the processes of a pool.

    Attributes
    ----------
    prepare : str
        ``"module:function"``, called once in each process with `given`. Its result is the third
        argument of all tasks.
    given : object
        Argument of `prepare`; must be representable in the format `code`.
    code : {"json", "pickle"}
        Format of arguments and results.
    nice : int
        Added to the nice level of the processes.
    address_space : int, optional
        Address space of a process [bytes]; an allocation beyond it raises MemoryError in the task.
    idle : float, optional
        Time without a task after which a process ends [s]; None for no limit.
    """

    prepare: str
    given: Any
    code: Code = "pickle"
    nice: int = 0
    address_space: int | None = None
    idle: float | None = None


@dataclass(frozen=True)
class Limits:
    """Time and memory limits of a task.

    Attributes
    ----------
    seconds : float
        Longest time [s].
    grace : float
        Time after the limit, or after a request to stop, in which the task may end by itself [s];
        then its process is killed.
    interrupts : bool
        Whether the pool interrupts the task at the time limit. False for a task that checks the
        time itself.
    memory : float
        Largest growth of the resident memory of its process [bytes].
    """

    seconds: float = inf
    grace: float = 0.0
    interrupts: bool = True
    memory: float = inf


@dataclass(eq=False)
class _Worker:
    """A process and its task; times [s] are sums of polling intervals."""

    process: subprocess.Popen[bytes]
    line: Line
    ready: bool = False
    # the caller's number of the task, and the internal one: callers may reuse theirs
    number: int | None = None
    turn: int = 0
    limits: Limits = field(default_factory=Limits)
    age: float = 0.0
    silence: float = 0.0
    until: float = inf
    stopping: Kind | None = None
    base: float = 0.0
    most: float = 0.0
    # reason for which it was killed
    verdict: Event | None = None

    @property
    def idle(self) -> bool:
        return self.ready and self.number is None and self.verdict is None

    def begin(self, number: int, limits: Limits) -> None:
        """Reset the counters for a new task."""
        self.number, self.limits, self.turn = number, limits, self.turn + 1
        self.age, self.silence, self.until, self.stopping = 0.0, 0.0, limits.seconds, None
        self.base = self.most = system.resident_memory(self.process.pid)

    def stop(self, cause: Kind) -> None:
        """Interrupt the task."""
        self.until, self.stopping = min(self.until, self.age), cause
        # the next poll detects a process that has just ended
        with suppress(OSError):
            self.line.send(self.line.packed(("stop", self.turn)), _PATIENCE)

    def kill(self, kind: Kind, words: str) -> None:
        """Kill the process; it is removed when the system has ended it."""
        self.process.kill()
        self.verdict, self.age = self.event(kind, words), 0.0

    def event(self, kind: Kind, what: Any) -> Event:
        return Event(kind, what, self.age, self.most)


class Pool:
    """Worker processes and their supervisor.

    Parameters
    ----------
    setup : Setup
        How the processes begin.
    workers : int
        Largest number of processes.
    """

    def __init__(self, setup: Setup, workers: int) -> None:
        self._setup, self._count = setup, workers
        self._workers: list[_Worker] = []
        self._selector = DefaultSelector()
        self._failed, self._unfit = 0, ""
        self._looked = monotonic()

    def fileno(self) -> int | None:
        """File descriptor that becomes readable when `collect` has a message to read.

        None on systems without such a descriptor (Windows): call `collect` often.
        """
        descriptor = getattr(self._selector, "fileno", None)
        return None if descriptor is None else descriptor()

    def room(self, wanted: int | None = None) -> int:
        """Return the number of idle workers; start processes up to the wanted number.

        Raises
        ------
        NoWorker
            If `Setup.prepare` failed, or several processes in a row ended before they were ready.
        """
        if self._unfit:
            words, self._unfit, self._failed = self._unfit, "", 0
            raise NoWorker(words)
        wanted = self._count if wanted is None else min(wanted, self._count)
        while len(self._workers) < wanted:
            self._workers.append(self._start())
        return sum(worker.idle for worker in self._workers)

    def hand(self, number: int, task: str, asked: Any, limits: Limits) -> None:
        """Submit a task to an idle worker.

        Parameters
        ----------
        number : int
            Number chosen by the caller; returned with the events of the task.
        task : str
            ``"module:function"``, called with `asked`, a function that reports progress, and the
            result of `Setup.prepare`.
        asked : object
            First argument of the task; must be representable in the format of the pool.
        limits : Limits
            Of this task.
        """
        worker = next(worker for worker in self._workers if worker.idle)
        content = worker.line.packed(("task", (worker.turn + 1, task, asked)))
        self._pass_time()
        worker.begin(number, limits)
        # the next poll detects a process that has just ended, with its task
        with suppress(OSError):
            worker.line.send(content, _PATIENCE)

    def stop(self, number: int) -> None:
        """Interrupt a task; `collect` returns its final event as usual."""
        for worker in self._workers:
            if worker.number == number and worker.verdict is None:
                worker.stop("stopped")

    def collect(self, seconds: float) -> list[tuple[int, Event]]:
        """Wait for events for at most the given time [s], and enforce limits meanwhile."""
        until = monotonic() + seconds
        while True:
            wait = max(0.0, min(LOOK, until - monotonic()))
            heard = [key.data for key, _ in self._selector.select(wait)]
            found = [event for worker in heard for event in self._heard(worker)]
            found += self._looked_after()
            if found or monotonic() >= until:
                return found

    def workers(self) -> int:
        """Largest number of processes."""
        return self._count

    def processes(self) -> list[int]:
        """Return the process identifiers of the living workers."""
        return [worker.process.pid for worker in self._workers]

    def busy(self) -> bool:
        """Whether any process is starting, running a task or ending, and must be polled."""
        return not all(worker.idle for worker in self._workers)

    def dismiss(self, *, at_once: bool) -> None:
        """End all processes: idle ones exit by themselves, or all are killed (`at_once`)."""
        for worker in self._workers:
            if at_once or worker.number is not None:
                # kill before closing the socket, or the process might exit by itself first
                worker.process.kill()
            worker.line.close()
        for worker in self._workers:
            _ended(worker.process)
        self._workers.clear()
        self._selector.close()

    def _start(self) -> _Worker:
        setup = self._setup
        ours, theirs = socket.socketpair()
        with theirs:
            with system.without_interrupts():
                process: Any = subprocess.Popen(
                    [sys.executable, "-c", _program(theirs.fileno(), setup.code)],
                    stdin=subprocess.DEVNULL,
                    # output printed by a task must not mix with the output of the command
                    stdout=2,
                    env=os.environ | dict.fromkeys(_THREADS, "1"),
                    **system.child_options(theirs.fileno()),
                )
        worker = _Worker(process, Line(ours, setup.code))
        self._selector.register(worker.line, EVENT_READ, worker)
        with suppress(OSError):
            worker.line.send(worker.line.packed(("setup", vars(setup))), _PATIENCE)
        return worker

    def _heard(self, worker: _Worker) -> Iterator[tuple[int, Event]]:
        try:
            messages = worker.line.receive()
        except EOFError:
            yield from self._remove(worker)
            return
        worker.silence = 0.0
        for kind, what in messages:
            if kind == "ready":
                worker.ready, self._failed = True, 0
            elif kind == "unfit":
                self._unfit = what
            elif worker.number is not None and worker.verdict is None and kind != "alive":
                cause = worker.stopping if kind == "stopped" else None
                yield worker.number, worker.event(cause or kind, what)
                worker.number = worker.number if kind == "told" else None

    def _pass_time(self) -> None:
        now = monotonic()
        passed, self._looked = min(now - self._looked, _LONGEST), now
        for worker in self._workers:
            worker.age += passed
            worker.silence += passed

    def _looked_after(self) -> list[tuple[int, Event]]:
        """Enforce the limits of all workers."""
        self._pass_time()
        found = []
        for worker in list(self._workers):
            if worker.verdict is not None:
                if worker.age > _PATIENCE:  # the system may take time to end it
                    found += self._remove(worker)
            elif not worker.ready:
                if worker.age > _START:
                    worker.kill("lost", f"did not start within {_START:g} s")
            elif worker.number is not None:
                _enforce(worker)
        return found

    def _remove(self, worker: _Worker) -> Iterator[tuple[int, Event]]:
        """Remove a process that has ended; yield the final event of its task, if it had one."""
        self._workers.remove(worker)
        self._selector.unregister(worker.line)
        worker.line.close()
        how = _ended(worker.process)
        end = worker.verdict or worker.event("lost", how)
        if worker.number is not None:
            yield worker.number, end
        elif not worker.ready:
            self._failed += 1
            if self._failed >= _STARTS and not self._unfit:
                self._unfit = (
                    f"{self._failed} worker processes in a row ended during start-up; the "
                    f"last one {end.what}"
                )


def _enforce(worker: _Worker) -> None:
    """Interrupt or kill a worker whose task exceeds a limit; kill a suspended worker."""
    limits, resident = worker.limits, system.resident_memory(worker.process.pid)
    worker.most = max(worker.most, resident)
    gained = resident - worker.base
    if gained > limits.memory:
        words = f"took {gained / 1e6:.0f} MB, more than {limits.memory / 1e6:g} MB"
        worker.kill("memory limit", words)
    elif worker.age > worker.until + limits.grace:
        words = f"took more than {limits.seconds:g} s and did not end by itself"
        worker.kill(worker.stopping or "time limit", words)
    elif worker.silence > _SILENCE:
        worker.kill("lost", f"sent no heartbeat for {_SILENCE:g} s")
    elif worker.age > worker.until and limits.interrupts and not worker.stopping:
        worker.stop("time limit")


def _program(handle: int, code: Code) -> str:
    """Source code of a worker's program; it uses the module search path of this process."""
    return _MORTAL.format(parent=os.getpid()) + (
        f"sys.path[:] = {sys.path!r}\n"
        f"from viscotack.pool.worker import serve\n"
        f"serve({handle}, {code!r})\n"
    )


def _ended(process: subprocess.Popen[bytes]) -> str:
    """Describe how a process ended; kill it if it only closed its socket."""
    try:
        code = process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)
        return "closed its connection"
    if code < 0:
        return f"was ended by {signal.Signals(-code).name}: killed, out of memory or crashed"
    return f"ended with status {code}"
