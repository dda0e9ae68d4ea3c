"""A second look: networks that learn what those of a rough surrogate leave over.

A network fitted to its end leaves smooth errors of a tenth of a percent, many times what the rows
are uncertain by, and more steps or nodes hardly change it. A second one that learns the errors of
the first, magnified, halves them in a fraction of the steps; its hidden layers stand beside those
of the first, so that both are one network when they are asked. Fast limit and relaxed start, which
were one network each, get members of their own here: the spread of the answers counts their doubt
too. Work, and the travel to zero force, are looked at again in the same way.
"""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import dataclass, replace

import numpy as np

from .. import physics
from ..model import Scaled, Surrogate
from ..network import Networks, added, single, together
from .fitting import Fit, Task
from .recipe import give_task, work_task
from .rows import Rows
from .shop import Shop


@dataclass(frozen=True)
class Stage:
    """Networks that learn what is left over.

    Attributes
    ----------
    fit : Fit
        Their size and steps; its scale is about the size of the errors that are left.
    gain : float
        What their outputs are multiplied by before they are added.
    """

    fit: Fit
    gain: float


@dataclass(frozen=True)
class Refinement:
    """What is learned in second looks.

    Attributes
    ----------
    start, force, work, give : Stage
        Of the relaxed start, the force, the work and the travel to zero force.
    fast : tuple of Stage
        Of the fast limit, one after the other.
    thinned : int
        Every so many rows tell the start, which depends on two of the inputs.
    members : int
        So many of the networks of the force, the work and the travel are looked at again, and kept.
    """

    start: Stage = Stage(Fit((16, 16, 16), steps=1000, scale=0.1, penalty=1e-6), 0.03)
    fast: tuple[Stage, ...] = (
        Stage(Fit((32, 32, 32), steps=5000, scale=1e-3, penalty=1e-6), 1e-2),
        Stage(Fit((32, 32, 32), steps=4000, scale=1e-4, penalty=1e-5), 2e-3),
    )
    force: Stage = Stage(Fit((32, 32, 32), steps=2000, scale=1e-3, penalty=1e-6), 1e-2)
    work: Stage = Stage(Fit((32, 32, 32), steps=2000, scale=2e-3, penalty=1e-6), 2e-2)
    give: Stage = Stage(Fit((32, 32, 32), steps=2000, scale=2e-3, penalty=1e-6), 2e-2)
    thinned: int = 8
    members: int = 3


# Of a trial: to see that everything runs.
_ONE, _TWO = (
    Stage(Fit(hidden, steps=100, scale=1e-2, penalty=1e-6), 0.1) for hidden in ((8,), (8, 8))
)
QUICK_REFINEMENT = Refinement(start=_ONE, fast=(_ONE,), force=_TWO, work=_TWO, give=_TWO, members=2)


def refine(rough: Surrogate, rows: Rows, fast: Rows, how: Refinement, shop: Shop) -> Surrogate:
    """Return a surrogate that has looked again at the rows; its intervals are not measured yet.

    Parameters
    ----------
    rough : Surrogate
        Networks that have learned the rows once.
    rows, fast : Rows
        What they learned from.
    how : Refinement
        Sizes and steps.
    shop : Shop
        Where networks are fitted.
    """
    members = how.members
    limiting = [_fast(single(rough.fast, 0), fast, how, shop, seed) for seed in range(members)]
    forces = [
        _force(single(rough.force, i), one, rows, how, shop, i) for i, one in enumerate(limiting)
    ]
    some = rows.chosen(slice(None, None, how.thinned))
    starts = [_start(rough.start, some, how.start, shop, seed) for seed in range(members)]
    works = _scaled(rough.work, work_task(rows)[0], how.work, members, shop)
    pressed = rows.chosen(rows.start_force > 0)
    gives = _scaled(rough.give, give_task(pressed)[0], how.give, members, shop)
    return replace(
        rough,
        fast=together(limiting),
        force=_all(forces),
        start=replace(rough.start, networks=_all(starts)),
        work=replace(rough.work, networks=_all(works)),
        give=replace(rough.give, networks=_all(gives)),
    )


@dataclass(frozen=True, eq=False)
class _Begun:
    """A network, and the one that is being fitted to what it leaves over."""

    first: Networks
    second: Future[Networks]


def _done(begun: _Begun) -> Networks:
    return added(begun.first, begun.second.result())


def _all(begun: list[_Begun]) -> Networks:
    return together([_done(one) for one in begun])


def _again(first: Networks, task: Task, stage: Stage, shop: Shop, seed: int) -> _Begun:
    """Begin to learn what one network leaves over of a task."""
    before = first(task.inputs)[0]
    left = replace(task, before=before, gain=stage.gain)
    return _Begun(first, shop.fit(left, stage.fit, seed=seed))


def _fast(first: Networks, fast: Rows, how: Refinement, shop: Shop, seed: int) -> Networks:
    limits = physics.slow_limit(fast.groups), physics.largest_fast_limit(fast.groups)
    target = np.log10(fast.force)[:, None]
    inputs = physics.scaled(fast.groups)[:, physics.FAST]
    task = Task(inputs, target, np.ones_like(target), limits)
    for stage in how.fast:
        first = _done(_again(first, task, stage, shop, seed))
    return first


def _force(
    first: Networks, limit: Networks, rows: Rows, how: Refinement, shop: Shop, seed: int
) -> _Begun:
    target = np.log10(rows.force)[:, None]
    slow, high = physics.way(rows.groups, limit)
    task = Task(physics.scaled(rows.groups), target, np.ones_like(target), (slow, high[0]))
    return _again(first, task, how.force, shop, seed)


def _scaled(rough: Scaled, task: Task, stage: Stage, members: int, shop: Shop) -> list[_Begun]:
    """Begin to look again at a task by several networks, whose outputs are scaled."""
    return [_again(single(rough.networks, i), task, stage, shop, i) for i in range(members)]


def _start(rough: Scaled, rows: Rows, stage: Stage, shop: Shop, seed: int) -> _Begun:
    inputs = physics.scaled(rows.groups)[:, physics.START]
    said = [physics.start_output(rows.groups, rows.start_force), np.log10(rows.start_radius)]
    target = (np.column_stack(said) - rough.centre) / rough.spread
    return _again(
        single(rough.networks, 0), Task(inputs, target, np.ones_like(target)), stage, shop, seed
    )
