"""Tasks of the worker processes of the page by name, and their error messages."""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from viscotack.errors import TOO_LARGE, InputError

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


def prepare(given: Mapping[str, Any]) -> tuple[Any, ...]:
    """Read the user's own nouns; import, and warm up, the module of the first task."""
    from viscotack.problem.nouns import own_nouns

    also = own_nouns(given["own"])
    _module(given["first"]).warm()
    return also


def answer(
    asked: Mapping[str, Any], tell: Callable[[dict[str, Any]], None], also: tuple[Any, ...]
) -> dict[str, Any]:
    """Run a task; InputError with a reason if it has no answer."""
    task = asked["task"]
    try:
        return getattr(_module(task), TASKS[task][1])(asked["asked"], tell, also)
    except ArithmeticError:
        raise InputError(TOO_LARGE) from None
    except MemoryError:
        raise InputError("the memory limit of this server was exceeded") from None


def _module(task: str) -> Any:
    return import_module(f"viscotack.app.engine.{TASKS[task][0]}")
