"""The problem with one of its numbers changed by a little, for derivatives.

A number is named by its path, as in campaigns: ``material.tau0``, ``protocol.start.force``, and
``material.branches.2.0`` and ``.1`` for modulus and time of an arm. In dimensionless groups the
names are those of the groups: ``rate``, ``start.depth``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.problem.problem import Case, Groups

# Relative change of a number to both sides of its value. Dimensionless groups are checked to 1e-6,
# so that a change by less would pass where no change is possible.
_CHANGE = 1e-4


@dataclass(frozen=True, eq=False)
class Changed:
    """A problem with one number a little smaller, and a little larger, than it is.

    Attributes
    ----------
    name, value : str, float
        Name and value of the number.
    low, high : Problem or Groups
        The problem with the smaller and with the larger value; one of them is the problem itself
        where the value is at the end of its range.
    down, up : float
        Relative changes of the number in the two problems, 0 or negative and 0 or positive.
    base : Groups
        The dimensionless problem itself.
    """

    name: str
    value: float
    low: Case
    high: Case
    down: float
    up: float
    base: Groups

    @property
    def step(self) -> float:
        """The difference of the logarithms of the number in the two problems."""
        return float(np.log1p(self.up) - np.log1p(self.down))

    @cached_property
    def groups(self) -> tuple[Groups, Groups]:
        """The dimensionless problems with the smaller and the larger value."""
        return self.low.groups(), self.high.groups()


def changed(problem: Case, names: Iterable[str] | None = None) -> list[Changed]:
    """Return the problem with each number changed by a little, all that can change by default.

    In groups the reduced numbers, like a rubbery modulus of 1, are not inputs, nor is the Poisson
    ratio of a bonded layer, which is that of its material.

    Raises
    ------
    ValueError
        If there is no number of a given name, or it cannot change alone.
    """
    paths = {_name(path): path for path, value in _numbers(problem, ()) if value}
    wanted = list(paths) if names is None else list(names)
    found = []
    for name in wanted:
        one = _pair(problem, name, paths[name]) if name in paths else None
        if one is not None:
            found.append(one)
        elif names is not None:
            known = ", ".join(each.name for each in changed(problem))
            raise InputError(f"{name!r} is not an input that can change; the inputs are {known}")
    return found


def moved(problem: Case, name: str, factor: float) -> Case:
    """Return the problem with a number multiplied by a factor; InputError if it cannot be."""
    paths = {_name(path): path for path, value in _numbers(problem, ()) if value}
    path = paths[name]
    found = _moved(problem, path, _at(problem, path) * factor)
    if found is None:
        raise InputError(f"{name} cannot be multiplied by {factor:g}")
    return found


def _pair(problem: Case, name: str, path: tuple[Any, ...]) -> Changed | None:
    """Return the problem with a number changed to both sides, None if it cannot change."""
    value = _at(problem, path)
    low, high = (_moved(problem, path, value * (1 + way * _CHANGE)) for way in (-1, 1))
    if low is None and high is None:
        return None
    down, up = -_CHANGE if low is not None else 0.0, _CHANGE if high is not None else 0.0
    return Changed(name, value, low or problem, high or problem, down, up, problem.groups())


def _moved(problem: Any, path: tuple[Any, ...], value: float) -> Any:
    """Return the problem with another number at a place, None if it may not have it."""
    try:
        if path == ("material", "poisson_ratio") and hasattr(problem.body, "poisson_ratio"):
            material = replace(problem.material, poisson_ratio=value)
            body = problem.body
            if body.poisson_ratio is not None:
                body = replace(body, base=replace(body.base, poisson_ratio=value))
            return replace(problem, material=material, body=body)
        return _replaced(problem, path, value)
    except InputError:
        return None


def _replaced(thing: Any, path: tuple[Any, ...], value: float) -> Any:
    """Return a dataclass or tuple with another number at a place in it."""
    if not path:
        return value
    first, rest = path[0], path[1:]
    if isinstance(first, int):
        return tuple(_replaced(x, rest, value) if i == first else x for i, x in enumerate(thing))
    return replace(thing, **{first: _replaced(getattr(thing, first), rest, value)})


def _numbers(thing: Any, path: tuple[Any, ...]) -> Iterator[tuple[tuple[Any, ...], float]]:
    """Yield place and value of every number in a dataclass or tuple."""
    if isinstance(thing, float):
        yield path, thing
    elif isinstance(thing, tuple):
        for i, each in enumerate(thing):
            yield from _numbers(each, (*path, i))
    elif is_dataclass(thing):
        for each in fields(thing):
            yield from _numbers(getattr(thing, each.name), (*path, each.name))


def _at(thing: Any, path: tuple[Any, ...]) -> float:
    for part in path:
        thing = thing[part] if isinstance(part, int) else getattr(thing, part)
    return thing


def _name(path: tuple[Any, ...]) -> str:
    return ".".join(map(str, path))
