"""The flags of ``viscotack simulate sphere`` that state a problem, for other commands."""

import inspect
from collections.abc import Callable
from typing import Any, get_type_hints

from . import commands


def with_sphere_flags(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command whose ``**flags`` are those of simulate sphere that state the problem.

    The names of the flags reach the command as :func:`viscotack.app.cli.flags.problem_from_flags`
    takes them when `_` is written as `-`; the file in place of flags is its parameter `case`.
    """
    hints = get_type_hints(command, include_extras=True)
    own = [
        p.replace(kind=inspect.Parameter.KEYWORD_ONLY, annotation=hints[name])
        for name, p in inspect.signature(command).parameters.items()
        if p.kind is not inspect.Parameter.VAR_KEYWORD
    ]
    names = {p.name for p in own}
    flags = [p for p in _sphere_flags() if p.name not in names]
    # arguments in front, then the problem, then what is to be done with it
    front = [p for p in own if p.default is inspect.Parameter.empty]
    parameters = [*front, *flags, *(p for p in own if p not in front)]
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in parameters}
    return command


def _sphere_flags() -> list[inspect.Parameter]:
    """Return the parameters of simulate sphere that state the problem: all before --until."""
    hints = get_type_hints(commands.simulate_sphere, include_extras=True)
    found = []
    for name, parameter in inspect.signature(commands.simulate_sphere).parameters.items():
        if name == "until":
            break
        kind = inspect.Parameter.KEYWORD_ONLY
        found.append(parameter.replace(annotation=hints[name], kind=kind))
    return found


def as_flags(given: dict[str, Any]) -> dict[str, Any]:
    """Return the flags of a command by their names on the command line."""
    return {name.replace("_", "-"): value for name, value in given.items()}
