"""A worker process: it runs the tasks of a pool one after another and ends with its parent.

Messages are pairs over a :class:`Line`. In: ``("setup", {...})`` first, then ``("task", (turn,
"module:function", asked))`` and ``("stop", turn)``. Out: ``("ready", None)`` or ``("unfit",
words)``; ``("told", news)`` while a task runs, and one of ``answer``, ``refused``, ``failed`` and
``stopped`` at its end. A thread beside the task receives messages and sends ``("alive", None)``
once a second.
"""

import os
import queue
import select
import socket
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from typing import Any

from viscotack import system
from viscotack.errors import InputError

from .event import NoWorker
from .line import Code, Line

# Interval between two heartbeats of a worker that runs a task [s].
BEAT = 1.0


class Stopped(BaseException):
    """Raised inside a cancelled task."""


def serve(handle: int, code: Code) -> None:
    """Run the tasks that arrive over a socket; return when the peer closes it.

    Parameters
    ----------
    handle : int
        File descriptor of the socket, inherited.
    code : {"json", "pickle"}
        Format of the messages.
    """
    runner = _Runner(Line(socket.socket(fileno=handle), code, strict=True))
    # the parent handles ctrl-C and decides about tasks
    system.serve_interrupts(runner.check_stopped)
    with suppress(ConnectionError):  # the parent has ended and needs no answer
        runner.serve()


class _Runner:
    def __init__(self, line: Line) -> None:
        self._line = line
        self._messages: queue.SimpleQueue[Any] = queue.SimpleQueue()
        # a received task without an answer keeps this process busy
        self._received = self._answered = 0
        # numbers of the running task and of the task to stop
        self._current: int | None = None
        self._unwanted: int | None = None
        self._telling = False

    def serve(self) -> None:
        threading.Thread(target=self._listen, daemon=True).start()
        setup = self._messages.get()
        if setup is None:
            return
        try:
            system.lower_priority(setup["nice"])
            if setup["address_space"] is not None:
                system.bound_memory(setup["address_space"])
            context = named(setup["prepare"])(setup["given"])
        except (InputError, NoWorker) as error:
            return self._say("unfit", str(error))
        except BaseException as error:
            return self._say("unfit", f"no worker can start: {type(error).__name__}: {error}")
        self._answer(self._line.packed(("ready", None)))
        while (message := self._next(setup["idle"])) is not None:
            turn, task, asked = message
            self._answer(self._done(turn, task, asked, context))

    def _next(self, idle: float | None) -> Any:
        """Wait for a task; None at the end of the connection or after an idle time [s]."""
        try:
            return self._messages.get(timeout=idle)
        except queue.Empty:
            return None

    def _done(self, turn: int, task: str, asked: Any, context: Any) -> bytes:
        """Run a task and return its final message."""
        try:
            try:
                self._current = turn
                self.check_stopped()  # the request may have arrived before the task started
                return self._line.packed(("answer", named(task)(asked, self._tell, context)))
            finally:
                self._current = None
        except Stopped:
            return self._line.packed(("stopped", ""))
        except InputError as error:
            return self._line.packed(("refused", str(error)))
        except Exception as error:
            traceback.print_exc()
            return self._line.packed(("failed", f"{type(error).__name__}: {error}"))

    def _tell(self, news: Any) -> None:
        self._telling = True  # an interrupted message would corrupt all later ones
        try:
            self._say("told", news)
        finally:
            self._telling = False
        self.check_stopped()

    def check_stopped(self, *_: Any) -> None:
        """Raise Stopped, once, if the running task is to stop."""
        if self._current is not None and self._unwanted == self._current and not self._telling:
            self._current = None
            raise Stopped

    def _answer(self, content: bytes) -> None:
        # decremented first: the parent may close the connection right after the answer
        self._answered += 1
        self._line.send(content)

    def _say(self, kind: str, what: Any) -> None:
        self._line.send(self._line.packed((kind, what)))

    def _listen(self) -> None:
        """Receive messages and send heartbeats until the parent has ended."""
        with suppress(OSError, EOFError):
            while True:
                if select.select([self._line], [], [], BEAT)[0]:
                    for kind, what in self._line.receive():
                        self._take(kind, what)
                elif self._received > self._answered:
                    self._say("alive", None)
        if self._received > self._answered:
            os._exit(1)
        self._messages.put(None)

    def _take(self, kind: str, what: Any) -> None:
        if kind == "stop":
            self._unwanted = what
            system.interrupt()
        else:
            self._received += 1
            self._messages.put(what)


def named(function: str) -> Callable[..., Any]:
    """Import a function given as ``"package.module:function"``."""
    module, _, name = function.partition(":")
    return getattr(import_module(module), name)
