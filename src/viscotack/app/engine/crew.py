"""Worker processes, each with one task at a time, that can be stopped.

The server computes nothing itself: what takes long, hangs or crashes does so in a process that can
be ended. One that is idle has its modules imported, so that a task begins at once.
"""

import asyncio
import json
import os
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from typing import Any

# Seconds that a task has to stop by itself before its process is ended, and a process to begin.
_GRACE, _START = 0.2, 120.0
# Longest message of a worker: the profiles of a run are the longest.
_LONGEST = 2**26
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_NUMBERS = count()

Told = Callable[[dict[str, Any]], None]


class Refused(ValueError):
    """A question that has no answer; says why."""


class Defect(RuntimeError):
    """A task that failed where it should not; says how."""


class TooLong(Refused):
    """A task that met its time limit."""


class Halted(Exception):
    """A task that was stopped because nobody wants its answer any more."""


@dataclass(frozen=True)
class Lane:
    """A kind of tasks, and how many of them go on at once.

    Attributes
    ----------
    name : str
        What it is called.
    workers : int
        Most processes.
    first : tuple of str
        Tasks whose modules its processes import before the first one comes.
    nice : int
        How far its processes stand back for others.
    """

    name: str
    workers: int
    first: tuple[str, ...]
    nice: int = 0


class _Worker:
    """A process and the way to it."""

    def __init__(self, process: Process) -> None:
        self.process = process

    async def send(self, message: dict[str, Any]) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(message).encode() + b"\n")
        await self.process.stdin.drain()

    async def hear(self) -> dict[str, Any]:
        """Return the next message; Defect where the process has ended."""
        assert self.process.stdout is not None
        text = await self.process.stdout.readline()
        if not text:
            status = await self.process.wait()
            raise Defect(f"the process of the task ended with status {status}")
        return json.loads(text)

    async def end(self) -> None:
        """End the process, which cannot refuse."""
        with suppress(ProcessLookupError):
            self.process.kill()
        await self.process.wait()


class Crew:
    """The processes of a lane.

    Parameters
    ----------
    lane : Lane
        What they are for.
    own : tuple of str
        Python files with nouns of the user's own.
    """

    def __init__(self, lane: Lane, own: tuple[str, ...] = ()) -> None:
        self.lane, self._own = lane, own
        # processes that wait for a task, and what kept one from beginning
        self._idle: asyncio.Queue[_Worker | Exception] = asyncio.Queue()
        self._all: set[_Worker] = set()
        self._starting: set[asyncio.Task[None]] = set()

    async def begin(self) -> None:
        """Start the first process; Refused where none can begin."""
        first = await self._start()
        self._idle.put_nowait(first)

    async def ask(
        self,
        task: str,
        asked: dict[str, Any],
        *,
        seconds: float,
        told: Told = lambda news: None,
        stop: asyncio.Event | None = None,
        begun: Callable[[], None] = lambda: None,
    ) -> dict[str, Any]:
        """Return the answer of a task.

        Parameters
        ----------
        task, asked : str, dict
            What is asked.
        seconds : float
            After which it is stopped, waiting for a process not counted.
        told : callable
            Is given what the task tells of itself.
        stop : asyncio.Event, optional
            Set when the answer is wanted no more.
        begun : callable
            Called when a process takes it up.

        Raises
        ------
        Refused
            If the question has no answer, or not in that time (TooLong).
        Halted
            If it was stopped.
        Defect
            If it failed where it should not.
        """
        stop = asyncio.Event() if stop is None else stop
        worker, keep = await self._free(stop), False
        try:
            begun()
            number = next(_NUMBERS)
            await worker.send({"number": number, "task": task, "asked": asked})
            answer = await self._heard(worker, number, seconds, told, stop)
            keep = True
        except Halted as halted:
            keep = bool(halted.args)
            raise
        except OSError as error:
            raise Defect(f"the process of the task has gone: {error}") from None
        finally:
            await self._back(worker, keep)
        return _read(answer)

    async def end(self) -> None:
        """End all processes."""
        starting = list(self._starting)
        for task in starting:
            task.cancel()
        await asyncio.gather(*starting, return_exceptions=True)
        await asyncio.gather(*(worker.end() for worker in list(self._all)))
        self._all.clear()

    def processes(self) -> list[int]:
        """Return the numbers of the processes that live."""
        return [worker.process.pid for worker in self._all]

    async def _free(self, stop: asyncio.Event) -> _Worker:
        """Wait for a process that is free; Halted where nobody wants the answer by then."""
        while True:
            if self._idle.empty():
                self.grow()
            turn = asyncio.ensure_future(self._idle.get())
            try:
                await _first(turn, stop)
            finally:
                turn.cancel()  # changes nothing where it has come
            with suppress(asyncio.CancelledError):
                await turn
            if turn.cancelled():
                raise Halted
            found = turn.result()
            if isinstance(found, Exception):
                raise found
            if stop.is_set():
                self._idle.put_nowait(found)
                raise Halted
            if found.process.returncode is None:
                return found
            self._all.discard(found)  # ended while it waited

    def grow(self) -> None:
        """Start one more process, if there may be one more."""
        if len(self._all) + len(self._starting) < self.lane.workers:
            starting = asyncio.ensure_future(self._add())
            self._starting.add(starting)
            starting.add_done_callback(self._starting.discard)

    async def _add(self) -> None:
        try:
            self._idle.put_nowait(await self._start())
        except (Refused, Defect, OSError, TimeoutError) as error:
            self._idle.put_nowait(Defect(f"no process could begin: {error}"))

    async def _heard(
        self, worker: _Worker, number: int, seconds: float, told: Told, stop: asyncio.Event
    ) -> dict[str, Any]:
        """Return the last message of a task; Halted(True) where it has stopped by itself."""
        loop = asyncio.get_running_loop()
        until = loop.time() + seconds
        stopping = late = False
        hearing = asyncio.ensure_future(worker.hear())
        try:
            while True:
                wait = max(until - loop.time(), 0.0)
                await _first(hearing, stop, wait, only=stopping)
                if hearing.done():
                    message = hearing.result()
                    if "told" in message and not stopping:
                        told(message["told"])
                    elif "told" not in message:
                        if late:
                            raise TooLong(_late(seconds))
                        if stopping:
                            raise Halted(True)
                        return message
                    hearing = asyncio.ensure_future(worker.hear())
                elif not stopping:
                    # a task that tells of itself ends by itself, and its process is kept
                    stopping, late = True, not stop.is_set()
                    until = loop.time() + _GRACE
                    await worker.send({"stop": number})
                elif late:
                    raise TooLong(_late(seconds))
                else:
                    raise Halted
        finally:
            if not hearing.done():
                hearing.cancel()
                with suppress(asyncio.CancelledError):
                    await hearing

    async def _back(self, worker: _Worker, keep: bool) -> None:
        """Keep a process for the next task, or end it and start another one."""
        if keep and worker.process.returncode is None:
            self._idle.put_nowait(worker)
            return
        self._all.discard(worker)
        await worker.end()
        self.grow()

    async def _start(self) -> _Worker:
        settings = {"own": self._own, "first": self.lane.first, "nice": self.lane.nice}
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "viscotack.app.engine.worker",
            json.dumps(settings),
            stdin=PIPE,
            stdout=PIPE,
            stderr=DEVNULL if os.environ.get("VISCOTACK_QUIET") else None,
            limit=_LONGEST,
            env=os.environ | dict.fromkeys(_THREADS, "1"),
            # what ends the server by the keyboard is not for them: they end with it
            start_new_session=True,
        )
        worker = _Worker(process)
        try:
            first = await asyncio.wait_for(worker.hear(), _START)
            if "unfit" in first:
                raise Refused(first["unfit"])
        except BaseException:
            await worker.end()
            raise
        self._all.add(worker)
        return worker


async def _first(
    waited: asyncio.Future[Any],
    stop: asyncio.Event,
    seconds: float | None = None,
    *,
    only: bool = False,
) -> None:
    """Wait for one thing, until it is wanted no more (unless only for it) or time is over."""
    others = [] if only else [asyncio.ensure_future(stop.wait())]
    try:
        await asyncio.wait([waited, *others], timeout=seconds, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for other in others:
            other.cancel()


def _late(seconds: float) -> str:
    return (
        f"it took longer than the {seconds:g} s that this server gives it; ask for less accuracy "
        "or a smaller question, or run viscotack on your own machine"
    )


def _read(message: dict[str, Any]) -> dict[str, Any]:
    if "refused" in message:
        raise Refused(message["refused"])
    if "defect" in message:
        raise Defect(message["defect"])
    return message["answer"]
