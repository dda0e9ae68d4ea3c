"""The problem with one of its inputs changed by a little, for derivatives.

An input is named by its path (:mod:`.inputs`): ``material.tau0``, ``protocol.start.force``, and
``material.branches.2.0`` and ``.1`` for modulus and time of an arm.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import cached_property
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.problem.inputs import inputs_of, made
from viscotack.problem.nouns import known
from viscotack.problem.problem import Case, Groups
from viscotack.problem.record import to_dict

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
    """Return the problem with each input changed by a little, all that can change by default.

    In groups the reduced numbers, like a rubbery modulus of 1, are not inputs, nor is the Poisson
    ratio of a bonded layer, which is that of its material.

    Raises
    ------
    ValueError
        If there is no input of a given name, or it cannot change alone.
    """
    entries, record, own = inputs_of(problem), to_dict(problem), tuple(set(_own(problem)))
    values = {path: entry.value for path, entry in entries.items() if entry.value}
    base, found = problem.groups(), []
    for name in values if names is None else names:
        low, high = (_made(record, entries, own, name, 1 + way * _CHANGE) for way in (-1, 1))
        if name in values and (low or high):
            down, up = -_CHANGE if low else 0.0, _CHANGE if high else 0.0
            ends = low or problem, high or problem
            found.append(Changed(name, values[name], *ends, down, up, base))
        elif names is not None:
            able = ", ".join(each.name for each in changed(problem))
            raise InputError(f"{name!r} is not an input that can change; the inputs are {able}")
    return found


def moved(problem: Case, name: str, factor: float) -> Case | None:
    """Return the problem with an input multiplied by a factor, None if that is not possible."""
    own = tuple(set(_own(problem)))
    return _made(to_dict(problem), inputs_of(problem), own, name, factor)


def _made(
    record: dict[str, Any],
    entries: Mapping[str, Any],
    own: tuple[type, ...],
    name: str,
    factor: float,
) -> Case | None:
    """Return the problem of a record with an input multiplied by a factor, if possible."""
    if name not in entries or not (value := entries[name].value):
        return None
    try:
        return made(record, entries, own, {name: value * factor})
    except InputError:
        return None


def _own(thing: Any) -> Iterator[type]:
    """Yield the user-defined classes of a problem and its parts."""
    if is_dataclass(thing):
        if known().types.get(type(thing).__name__) is not type(thing):
            yield type(thing)
        for field in fields(thing):
            yield from _own(getattr(thing, field.name))
    elif isinstance(thing, tuple):
        for entry in thing:
            yield from _own(entry)
