"""What a worker process does: one task after the other, as they come over its standard input.

``python -m viscotack.app.engine.worker`` is started by :mod:`.crew` and by nobody else. A message
is one JSON object a line: ``{"number": 7, "task": "simulate", "asked": {...}}`` in, ``{"number": 7,
"told": {...}}`` any number of times out, and at last ``answer``, ``refused``, ``defect`` or
``stopped``. ``{"stop": 7}`` ends a task wherever it is in Python; one that stays in foreign code is
killed with its process. When the other end has gone, so does this one.
"""

import json
import os
import queue
import resource
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from viscotack.errors import InputError

# Task -> module and function; a module is imported by the first task that needs it.
TASKS = {
    "forms": ("asks", "ask_forms"),
    "state": ("asks", "ask_state"),
    "quick": ("asks", "ask_quick"),
    "verdict": ("asks", "ask_verdict"),
    "theory": ("asks", "ask_theory"),
    "moduli": ("asks", "ask_moduli"),
    "operation": ("operating", "run_operation"),
    "job": ("operating", "run_operation"),
}
_TOO_LARGE = "a number is too large or too small to compute with; check its unit"
# More than any answer takes beside the libraries; what asks for more ends itself, not the machine.
_MOST_MEMORY = 4 * 2**30


class Stopped(BaseException):
    """Whoever asked does not want the answer any more."""


class Line:
    """The way to the process that asks."""

    def __init__(self) -> None:
        # what a library prints must not come between the messages
        self._out = os.fdopen(os.dup(1), "w", encoding="utf-8")
        os.dup2(2, 1)
        self._tasks: queue.Queue[dict[str, Any]] = queue.Queue()
        # numbers of the task that goes on, and of that which is to stop
        self.current, self.stopped = -1, -2
        self._talking = False

    def listen(self) -> None:
        """Take messages until the other end has gone; then end the process, whatever it does."""
        for text in sys.stdin:
            message = json.loads(text)
            if "stop" in message:
                self.stopped = message["stop"]
                os.kill(os.getpid(), signal.SIGUSR1)  # the main thread is to look up
            else:
                self._tasks.put(message)
        os._exit(0)

    def look(self, *signal: Any) -> None:
        """Raise Stopped where the task that goes on is to stop, but in no half of a message."""
        if self.stopped == self.current and not self._talking:
            raise Stopped

    def next(self) -> dict[str, Any]:
        """Return the next task, when there is one."""
        return self._tasks.get()

    def say(self, message: Mapping[str, Any]) -> None:
        """Send a message."""
        text = json.dumps(message, allow_nan=False) + "\n"
        self._talking = True
        try:
            self._out.write(text)
            self._out.flush()
        except BrokenPipeError:
            os._exit(0)
        finally:
            self._talking = False
        self.look()


def serve(own: tuple[str, ...], first: tuple[str, ...]) -> None:
    """Do tasks until nobody asks any more.

    Parameters
    ----------
    own : tuple of str
        Python files with nouns of the user's own.
    first : tuple of str
        Tasks whose modules are imported, and warmed up, before the first one comes.
    """
    line = Line()
    signal.signal(signal.SIGUSR1, line.look)
    threading.Thread(target=line.listen, daemon=True).start()
    _bounded()
    try:
        from viscotack.problem.nouns import own_nouns

        also = own_nouns(own)
        for name in first:
            _module(name).warm()
    except InputError as error:
        line.say({"unfit": str(error)})
        return
    line.say({"ready": True})
    while True:
        message = line.next()
        try:
            line.current = message["number"]
            outcome = _done(line, message, also)
        except Stopped:
            outcome = {"stopped": True}
        finally:
            line.current = -1
        line.say({"number": message["number"]} | outcome)


def _done(line: Line, message: Mapping[str, Any], also: tuple[Any, ...]) -> dict[str, Any]:
    """Return what comes of a task: its answer, or why there is none."""
    number = message["number"]

    def tell(told: dict[str, Any]) -> None:
        line.say({"number": number, "told": told})

    try:
        return {"answer": _function(message["task"])(message["asked"], tell, also)}
    except InputError as error:
        return {"refused": str(error)}
    except ArithmeticError:  # 1e300 squared, or over nothing
        return {"refused": _TOO_LARGE}
    except MemoryError:
        return {"refused": "it takes more memory than this server gives to one question"}
    except Exception as error:
        traceback.print_exc()
        return {"defect": f"{type(error).__name__}: {error}"}


def _function(task: str) -> Callable[..., dict[str, Any]]:
    return getattr(_module(task), TASKS[task][1])


def _module(task: str) -> Any:
    return import_module(f"viscotack.app.engine.{TASKS[task][0]}")


def _bounded() -> None:
    """Give up more memory than a worker ever needs."""
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    least = _MOST_MEMORY if hard == resource.RLIM_INFINITY else min(_MOST_MEMORY, hard)
    resource.setrlimit(resource.RLIMIT_AS, (least, hard))


if __name__ == "__main__":
    settings = json.loads(sys.argv[1])
    os.nice(settings["nice"])
    serve(tuple(settings["own"]), tuple(settings["first"]))
