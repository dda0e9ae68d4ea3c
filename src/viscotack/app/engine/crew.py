"""Worker processes of the page: tasks wait in queues for a pool driven by the event loop.

The server process computes nothing itself, so that slow or crashing tasks do not affect it. Idle
worker processes have their modules imported, so that a task starts immediately.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

from viscotack.pool import Event, Limits, NoWorker, Pool, Setup
from viscotack.pool.event import Kind
from viscotack.pool.supervisor import LOOK

# Time allowed for a task to stop before its process is killed [s].
_GRACE = 0.2
# Interval between two polls of busy processes on systems that do not report messages [s].
_OFTEN = 0.01
# Address space of a process [bytes].
_MOST_MEMORY = 4 * 2**30
_PREPARE, _TASK = (f"viscotack.app.engine.worker:{name}" for name in ("prepare", "answer"))


class Refused(ValueError):
    """A request has no answer; the message gives the reason."""


class Defect(RuntimeError):
    """A task failed because of a defect."""


class TooLong(Refused):
    """A task exceeded its time limit."""


@dataclass(eq=False)
class _Question:
    asked: dict[str, Any]
    limits: Limits
    told: Callable[[dict[str, Any]], None]
    begun: Callable[[], None]
    outcome: asyncio.Future[Event]
    number: int = -1


class Crew:
    """The worker processes of a queue, and the requests that wait for them.

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
        setup = Setup(
            _PREPARE,
            {"own": own, "first": first},
            code="json",
            nice=nice,
            address_space=_MOST_MEMORY,
        )
        self._pool, self._numbers = Pool(setup, workers), count()
        self._waiting: deque[_Question] = deque()
        self._running: dict[int, _Question] = {}
        self._next_turn: asyncio.TimerHandle | None = None
        # idle processes that are kept: none after a failed start, until somebody asks
        self._spare = 1
        self.processes = self._pool.processes

    def begin(self) -> None:
        """Start the first process and begin to accept questions."""
        if (descriptor := self._pool.fileno()) is not None:
            asyncio.get_running_loop().add_reader(descriptor, self._turn)
        self._turn()

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

        Cancellation of the caller stops the task and waits until its process is free.

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
        outcome = asyncio.get_running_loop().create_future()
        limits = Limits(seconds, _GRACE)
        question = _Question({"task": task, "asked": asked}, limits, told, begun, outcome)
        self._waiting.append(question)
        self._spare = 1
        self._turn()
        try:
            await asyncio.wait([outcome])
        finally:
            if not outcome.done():
                self._withdraw(question)
                await asyncio.wait([outcome])
        return _read(outcome.result(), seconds)

    def end(self) -> None:
        """Kill all processes; questions that are still open fail."""
        if self._next_turn is not None:
            self._next_turn.cancel()
        if (descriptor := self._pool.fileno()) is not None:
            asyncio.get_running_loop().remove_reader(descriptor)
        self._pool.dismiss(at_once=True)
        for question in [*self._running.values(), *self._waiting]:
            _end(question, "failed", "the server ends")

    def _turn(self) -> None:
        """Forward messages of the processes, and give waiting questions to idle ones."""
        for number, event in self._pool.collect(0.0):
            if event.kind == "told":
                self._running[number].told(event.what)
            else:
                self._running.pop(number).outcome.set_result(event)
        try:
            room = self._pool.room(max(self._spare, len(self._running) + len(self._waiting)))
        except (NoWorker, OSError) as error:
            room = self._spare = 0
            while self._waiting:
                _end(self._waiting.popleft(), "refused", str(error))
        for _ in range(min(room, len(self._waiting))):
            self._hand(self._waiting.popleft())
        self._turn_again()

    def _hand(self, question: _Question) -> None:
        question.number = next(self._numbers)
        try:
            self._pool.hand(question.number, _TASK, question.asked, question.limits)
        except (TypeError, ValueError) as error:
            return _end(question, "failed", f"the question is no JSON: {error}")
        except RecursionError:
            return _end(question, "refused", "the question is nested too deeply")
        self._running[question.number] = question
        question.begun()

    def _turn_again(self) -> None:
        """Poll the processes while any is busy."""
        if self._next_turn is not None:
            self._next_turn.cancel()
        loop = asyncio.get_running_loop()
        delay = _OFTEN if self._pool.fileno() is None else LOOK
        self._next_turn = loop.call_later(delay, self._turn) if self._pool.busy() else None

    def _withdraw(self, question: _Question) -> None:
        """Stop a question whose answer is no longer wanted."""
        question.told = lambda news: None
        if question in self._waiting:
            self._waiting.remove(question)
            _end(question, "stopped", "")
        else:
            self._pool.stop(question.number)


def _end(question: _Question, kind: Kind, words: str) -> None:
    question.outcome.set_result(Event(kind, words, 0.0, 0.0))


def _read(event: Event, seconds: float) -> dict[str, Any]:
    match event.kind:
        case "answer":
            return event.what
        case "refused":
            raise Refused(event.what)
        case "time limit":
            raise TooLong(
                f"exceeded the time limit of {seconds:g} s of this server; request less accuracy "
                "or a smaller problem, or run viscotack on your own machine"
            )
        case "lost":
            raise Defect(f"its process {event.what}")
    raise Defect(event.what)
