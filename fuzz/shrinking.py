"""Simpler cases that still fail: fewer moves, plainer nouns, rounder numbers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

from viscotack import (
    AtDepth,
    AtForce,
    Elastic,
    Frictionless,
    Groups,
    InputError,
    Layer,
    LennardJones,
    Sphere,
    StandardSolid,
)

# Longest time of a search [s].
_PATIENCE = 30.0


def shrunk(case: Any, fails: Callable[[Any], bool], patience: float = _PATIENCE) -> Any:
    """Return a simpler case that fails as well, none simpler being found in the time."""
    until, better = time.monotonic() + patience, True
    while better and time.monotonic() < until:
        better = False
        for simpler in simpler_ones(case):
            if time.monotonic() > until:
                break
            if size(simpler) < size(case) and fails(simpler):
                case, better = simpler, True
                break
    return case


def size(case: Any) -> tuple[int, int]:
    """Return how long the text of a case is: its nouns, then its digits."""
    text = repr(case)
    return text.count("("), len(text)


def simpler_ones(case: Any) -> Iterator[Any]:
    """Yield variants of a case, those that change most first."""
    for change in (*_other_nouns(case), *_rounder(case)):
        try:
            yield change()
        except (InputError, ValueError, TypeError):
            continue  # the simpler one does not exist


def _other_nouns(case: Any) -> Iterator[Callable[[], Any]]:
    if not isinstance(case, Groups):
        return
    moves = case.moves
    for at in range(len(moves)):
        yield lambda at=at: replace(case, moves=(*moves[:at], *moves[at + 1 :]))
    k = case.modulus_ratio
    common = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
    changes: list[dict[str, Any]] = [
        {"stiffness": None},
        {"traction": LennardJones(1.0, 1.0)},
        {"material": Elastic(**common)},
        {"material": StandardSolid(**common, glassy_modulus=1 / k, tau0=1.0)},
        {"start": AtForce(0.0)},
        {"start": AtDepth(1.0)},
    ]
    if moves:
        changes.append({"rate": None})
    changes.append(
        {"body": replace(case.body, base=Frictionless())}
        if isinstance(case.body, Layer)
        else {"geometry": Sphere(1.0)}
    )
    for change in changes:
        if any(getattr(case, name) != value for name, value in change.items()):
            yield lambda change=change: replace(case, **change)


def _rounder(thing: Any) -> Iterator[Callable[[], Any]]:
    """Yield copies of a noun with one number of it rounder."""
    if isinstance(thing, bool):
        return
    if isinstance(thing, float):
        for digits in (1, 2, 3):
            value = float(f"{thing:.{digits - 1}e}")
            if value != thing:
                yield lambda value=value: value
        return
    if isinstance(thing, tuple):
        if len(thing) > 12:
            return  # a table
        for at, part in enumerate(thing):
            for change in _rounder(part):
                yield lambda at=at, change=change: (*thing[:at], change(), *thing[at + 1 :])
        return
    if is_dataclass(thing):
        for one in fields(thing):
            for change in _rounder(getattr(thing, one.name)):
                yield lambda one=one, change=change: replace(thing, **{one.name: change()})
