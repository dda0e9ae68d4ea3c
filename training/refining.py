"""A second look: networks that learn what others leave over.

A network fitted to its end leaves smooth errors of a tenth of a percent, many times what the rows
are uncertain by, and more steps or nodes hardly change it. A second one that learns the errors of
the first, magnified, halves them in a fraction of the steps; its hidden layers stand beside those
of the first, so that both are one network when they are asked. Of a sphere, fast limit and relaxed
start, which were one network each, get members of their own here: the spread of the answers counts
their doubt too. Work, and the travel to zero force, are looked at again in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace

import numpy as np

from viscotack.surrogate import physics
from viscotack.surrogate.model import Surrogate
from viscotack.surrogate.network import Networks, added, single, together

from .fitting import Fit, Task
from .recipe import fast_task, force_task, give_task, work_task
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
class Looks:
    """How a network is fitted, and the one that learns what it leaves over."""

    first: Fit
    second: Stage


@dataclass(frozen=True, eq=False)
class Begun:
    """A network, and the one that is being fitted to what it leaves over."""

    first: Networks
    second: Future[Networks]

    def done(self) -> Networks:
        """Return both as one when the second is done."""
        return added(self.first, self.second.result())


def again(first: Networks, task: Task, stage: Stage, shop: Shop, seed: int) -> Begun:
    """Begin to learn what one network leaves over of a task."""
    left = replace(task, before=first.plain(task.inputs)[0], gain=stage.gain)
    return Begun(first, shop.fit(left, stage.fit, seed=seed))


def all_done(begun: Sequence[Begun]) -> Networks:
    """Return several networks as one object when they are done."""
    return together([one.done() for one in begun])


def twice(tasks: Sequence[Task], looks: Looks, shop: Shop) -> Callable[[], Networks]:
    """Begin to learn tasks, a network each; what is returned waits, and looks at each again."""
    begun = [shop.fit(task, looks.first, seed=i) for i, task in enumerate(tasks)]

    def done() -> Networks:
        firsts = zip(tasks, [one.result() for one in begun], strict=True)
        return all_done([again(f, t, looks.second, shop, i) for i, (t, f) in enumerate(firsts)])

    return done


@dataclass(frozen=True)
class Refinement:
    """What is learned in second looks at a sphere.

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
    networks, members = rough.networks, range(how.members)
    limiting = [single(networks["fast"], 0) for _ in members]
    for seed in members:
        for stage in how.fast:
            limiting[seed] = again(limiting[seed], fast_task(fast), stage, shop, seed).done()
    tasks = [force_task(rows, rough.having(fast=one)) for one in limiting]
    some, pressed = rows.chosen(slice(None, None, how.thinned)), rows.chosen(rows.start_force > 0)
    begun = {
        "force": [
            again(single(networks["force"], i), task, how.force, shop, i)
            for i, task in enumerate(tasks)
        ],
        "start": [
            again(single(networks["start"], 0), _start(networks["start"], some), how.start, shop, i)
            for i in members
        ],
        "work": _each(networks["work"], work_task(rows).task, how, how.work, shop),
        "give": _each(networks["give"], give_task(pressed).task, how, how.give, shop),
    }
    found = {name: all_done(each) for name, each in begun.items()}
    found = {n: replace(networks[n], weights=x.weights, biases=x.biases) for n, x in found.items()}
    return rough.having(fast=together(limiting), **found)


def _each(rough: Networks, task: Task, how: Refinement, stage: Stage, shop: Shop) -> list[Begun]:
    """Begin to look again at a task by several networks."""
    return [again(single(rough, i), task, stage, shop, i) for i in range(how.members)]


def _start(rough: Networks, rows: Rows) -> Task:
    """Return the task to learn relaxed starts, on the scale of networks that learned them."""
    assert rough.centre is not None and rough.spread is not None, "starts are scaled"
    said = [physics.start_output(rows.groups, rows.start_force), np.log10(rows.start_radius)]
    target = (np.column_stack(said) - rough.centre) / rough.spread
    inputs = physics.scaled(rows.groups)[:, physics.START]
    return Task(inputs, target, np.ones_like(target))
