"""A worker process of the page: its tasks by name, and their error messages."""

import traceback
from contextlib import suppress
from importlib import import_module
from multiprocessing.connection import Connection
from typing import Any

from viscotack.errors import TOO_LARGE, InputError
from viscotack.system import begin_worker

# Task -> module and function; a module is imported by the first task that needs it.
TASKS = {
    "forms": ("page_tasks", "ask_forms"),
    "state": ("page_tasks", "ask_state"),
    "quick": ("page_tasks", "ask_quick"),
    "verdict": ("page_tasks", "ask_verdict"),
    "theory": ("page_tasks", "ask_theory"),
    "moduli": ("page_tasks", "ask_moduli"),
    "operation": ("operating", "run_operation"),
    "job": ("operating", "run_operation"),
}
# Memory that a process may take [bytes].
_MOST_MEMORY = 4 * 2**30


def serve(line: Connection, first: str, own: tuple[str, ...], nice: int) -> None:
    """Answer questions until the parent ends: ``("told", news)`` and one of three last messages.

    These are ``("answer", found)``, ``("refused", why)`` and ``("failed", what)``.
    """
    also, unfit = (), ""
    try:
        from viscotack.problem.nouns import own_nouns

        also = own_nouns(own)
        _module(first).warm()
    except InputError as error:
        unfit = str(error)
    begin_worker(_MOST_MEMORY, nice)
    with suppress(EOFError, OSError):  # the parent has ended and needs no answer
        line.send(("ready", None))
        while True:
            asked = line.recv()
            line.send(("refused", unfit) if unfit else _answered(asked, line, also))


def _answered(question: Any, line: Connection, also: tuple[Any, ...]) -> tuple[str, Any]:
    """Run a task; return its last message."""
    task = question["task"]
    try:
        function = getattr(_module(task), TASKS[task][1])
        return "answer", function(question["asked"], lambda news: line.send(("told", news)), also)
    except InputError as error:
        return "refused", str(error)
    except ArithmeticError:
        return "refused", TOO_LARGE
    except MemoryError:
        return "refused", "the memory limit of this server was exceeded"
    except Exception as error:
        traceback.print_exc()
        return "failed", f"{type(error).__name__}: {error}"


def _module(task: str) -> Any:
    return import_module(f"viscotack.app.engine.{TASKS[task][0]}")
