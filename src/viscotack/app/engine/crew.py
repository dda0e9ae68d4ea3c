"""Worker processes of the page, each watched by a thread, which passes on one task at a time.

The server process computes nothing itself, so that slow or crashing tasks do not affect it. Idle
worker processes have their modules imported, so that a task starts immediately. A task that is
cancelled or too slow ends with its process, and a fresh one takes its place.
"""

import asyncio
import signal
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from math import inf
from queue import Empty, LifoQueue
from time import monotonic
from typing import Any

from viscotack.system import FRESH

from .worker import serve

# Interval between two looks at the clock, and time that is allowed for the end of a process [s].
_LOOK, _PATIENCE = 0.05, 5.0


class Refused(ValueError):
    """A request has no answer; the message gives the reason."""


class Defect(RuntimeError):
    """A task failed because of a defect."""


class TooLong(Refused):
    """A task exceeded its time limit."""


class _Worker:
    """A process, and this end of the pipe to it."""

    def __init__(self, *given: Any) -> None:
        self.line, theirs = FRESH.Pipe()
        self.process = FRESH.Process(target=serve, args=(theirs, *given), daemon=True)
        self.process.start()
        theirs.close()
        self.ready = False

    def end(self) -> str:
        """Kill the process if it has not ended; return how it ended."""
        self.process.join(0.1)
        self.process.kill()
        self.process.join(_PATIENCE)
        self.line.close()
        code = self.process.exitcode
        return f"ended by {signal.Signals(-code).name}" if code and code < 0 else f"status {code}"


class Crew:
    """The worker processes of a lane, and the requests that wait for them.

    Parameters
    ----------
    workers : int
        Largest number of processes.
    first : str
        Task whose module the processes import and warm up in advance.
    own : tuple of str
        Python files with user-defined classes.
    nice : int
        Added to the nice level of the processes.
    """

    def __init__(self, workers: int, first: str, own: tuple[str, ...], nice: int = 0) -> None:
        self._threads = ThreadPoolExecutor(workers)
        self._given = first, own, nice
        self._idle: LifoQueue[_Worker] = LifoQueue()
        self._workers: list[_Worker] = []
        self._open = True

    def begin(self) -> None:
        """Start a process."""
        self._idle.put(self._started())

    def processes(self) -> list[int]:
        """Return the identifiers of the living processes."""
        return [w.process.pid for w in self._workers if w.process.pid and w.process.is_alive()]

    async def ask(
        self,
        task: str,
        asked: dict[str, Any],
        *,
        seconds: float,
        told: Callable[[dict[str, Any]], None] = lambda news: None,
        begun: Callable[[], None] = lambda: None,
    ) -> dict[str, Any]:
        """Run a task and return its answer.

        Cancellation of the caller ends the task, and waits until that is so.

        Parameters
        ----------
        task, asked : str, dict
            Name of the task and its input.
        seconds : float
            Time limit [s], waiting for a process not counted.
        told : callable
            Called with the progress of the task.
        begun : callable
            Called when a process starts the task.

        Raises
        ------
        Refused
            If the question has no answer, or not in that time (TooLong).
        Defect
            If the task failed because of a defect.
        """
        call, unwanted = asyncio.get_running_loop().call_soon_threadsafe, threading.Event()

        def hear(kind: str, what: Any = None) -> None:
            if not unwanted.is_set():
                call(begun) if kind == "begun" else call(told, what)

        future = self._threads.submit(
            self._do, {"task": task, "asked": asked}, seconds, hear, unwanted
        )
        outcome = asyncio.wrap_future(future)
        try:
            return await asyncio.shield(outcome)
        except asyncio.CancelledError:
            unwanted.set()
            if not future.cancel():
                await asyncio.wait([outcome])
                outcome.exception()
            raise

    def end(self) -> None:
        """Kill all processes; questions that are still open fail."""
        self._open = False
        self._threads.shutdown(wait=False, cancel_futures=True)
        for worker in self._workers:
            worker.process.kill()
        self._threads.shutdown()
        for worker in self._workers:
            worker.end()
        self._workers.clear()

    def _started(self) -> _Worker:
        worker = _Worker(*self._given)
        self._workers.append(worker)
        return worker

    def _do(
        self, question: Any, seconds: float, hear: Callable[..., None], unwanted: threading.Event
    ) -> dict[str, Any]:
        """Pass a question to a process, in a thread; return its answer."""
        try:
            worker = self._idle.get_nowait()
        except Empty:
            worker = self._started()
        try:
            worker.line.send(question)
            kind, what = self._heard(worker, seconds, hear, unwanted)
        except RecursionError:
            self._idle.put(worker)
            raise Refused("the question is nested too deeply") from None
        except (EOFError, OSError):
            how = self._replace(worker)
            raise Defect(f"its process was {how}") from None
        except BaseException:
            self._replace(worker)
            raise
        self._idle.put(worker)
        if kind == "answer":
            return what
        raise Refused(what) if kind == "refused" else Defect(what)

    def _heard(
        self,
        worker: _Worker,
        seconds: float,
        hear: Callable[..., None],
        unwanted: threading.Event,
    ) -> tuple[str, Any]:
        """Return the last message of a task, and pass on the others."""
        until = inf
        while True:
            if worker.ready and until == inf:
                until = monotonic() + seconds
                hear("begun")
            kind, what = worker.line.recv() if worker.line.poll(_LOOK) else ("", None)
            if kind == "ready":
                worker.ready = True
            elif kind == "told":
                hear("told", what)
            elif kind:
                return kind, what
            if unwanted.is_set():
                raise Refused("it was cancelled")
            if monotonic() > until:
                raise TooLong(
                    f"exceeded the time limit of {seconds:g} s of this server; request less "
                    "accuracy or a smaller problem, or run viscotack on your own machine"
                )

    def _replace(self, worker: _Worker) -> str:
        """End a process and start another one; return how it ended."""
        how = worker.end()
        self._workers.remove(worker)
        if self._open:
            self._idle.put(self._started())
        return how
