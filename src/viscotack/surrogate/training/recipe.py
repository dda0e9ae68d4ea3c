"""A surrogate from rows: which network learns what, and in which order."""

from concurrent.futures import Future
from dataclasses import dataclass

import numpy as np

from .. import line, physics
from ..model import Scaled, Surrogate
from ..network import Networks, together
from ..physics import Array
from ..trust import CONFIDENCES, INPUTS, OF, Trust
from .fitting import Fit, Task
from .rows import Rows
from .shop import Shop

# A shape's values that hardly vary are not worth all of the network's attention.
_LEAST_SPREAD = 0.03


@dataclass(frozen=True)
class Recipe:
    """How the networks of a surrogate are fitted.

    Attributes
    ----------
    members : int
        Networks for the force, for the work, and for the way to zero force.
    limits, force, work, line : Fit
        Of relaxed start and fast limit, of force, of work and that way, and of the shapes.
    """

    members: int = 4
    limits: Fit = Fit(hidden=(24, 24, 24), steps=5000)
    force: Fit = Fit(steps=8000)
    work: Fit = Fit(steps=5000, scale=1.0, penalty=1e-9)
    line: Fit = Fit(hidden=(48, 48, 48), steps=5000, scale=1.0)


# Of a force that is learned without a band, many times over.
BANDED = Fit(steps=3000)
# Of a trial: to see that everything runs.
QUICK = Recipe(
    members=2,
    limits=Fit(hidden=(8,), steps=150),
    force=Fit(hidden=(12, 12), steps=200),
    work=Fit(hidden=(12, 12), steps=200, scale=1.0),
    line=Fit(hidden=(12,), steps=100, scale=1.0),
)


@dataclass(frozen=True, eq=False)
class Limits:
    """What the other networks stand on: the relaxed start, and the fast limit."""

    start: Scaled
    fast: Networks


def learn_limits(rows: Rows, fast: Rows, recipe: Recipe, shop: Shop) -> Limits:
    """Return networks of the relaxed start, from rows, and of the fast limit, from the set of it.

    Both depend on two and three of the inputs only. They are known in cells and bands that other
    networks are judged on: what is told there is the way between the limits.
    """
    target = np.column_stack(
        [physics.start_output(rows.groups, rows.start_force), np.log10(rows.start_radius)]
    )
    task, centre, spread = scaled_task(physics.scaled(rows.groups)[:, physics.START], target)
    starting, limiting = shop.fit(task, recipe.limits), shop.fit(_fast(fast), recipe.limits)
    return Limits(Scaled(starting.result(), centre, spread), limiting.result())


@dataclass(frozen=True, eq=False)
class Pending:
    """A surrogate whose networks are being fitted."""

    limits: Limits
    forces: list[Future[Networks]]
    works: list[Future[Networks]]
    gives: list[Future[Networks]]
    line: Future[Networks]
    scales: tuple[tuple[Array, Array], tuple[Array, Array], tuple[Array, Array]]

    def surrogate(self) -> Surrogate:
        """Return it when all are done; its intervals have not been measured yet."""
        work, give, shapes = self.scales
        return Surrogate(
            start=self.limits.start,
            fast=self.limits.fast,
            force=_all(self.forces),
            work=Scaled(_all(self.works), *work),
            give=Scaled(_all(self.gives), *give),
            line=Scaled(self.line.result(), *shapes),
            trust=untested(),
        )


def learn(
    rows: Rows, limits: Limits, recipe: Recipe, shop: Shop, *, curves: Recipe | None = None
) -> Pending:
    """Begin to learn force, work and curves of rows.

    Parameters
    ----------
    rows : Rows
        What is learned from.
    limits : Limits
        What it stands on.
    recipe : Recipe
        Sizes and steps.
    shop : Shop
        Where networks are fitted.
    curves : Recipe, optional
        Another recipe for the curves, where they are not to be judged.
    """
    forces = begin_forces(rows, limits, recipe.force, shop, members=recipe.members)
    task, *of_work = work_task(rows)
    works = [shop.fit(task, recipe.work, seed=i) for i in range(recipe.members)]
    curves = curves or recipe
    task, *of_give = give_task(rows.chosen(rows.start_force > 0))
    gives = [shop.fit(task, curves.work, seed=i) for i in range(curves.members)]
    task, *of_line = _line(rows)
    shapes = shop.fit(task, curves.line)
    (a, b), (c, d), (e, f) = of_work, of_give, of_line
    return Pending(limits, forces, works, gives, shapes, ((a, b), (c, d), (e, f)))


def begin_forces(
    rows: Rows, limits: Limits, how: Fit, shop: Shop, *, members: int = 1
) -> list[Future[Networks]]:
    """Begin to learn the force alone."""
    target = np.log10(rows.force)[:, None]
    slow, high = physics.way(rows.groups, limits.fast)
    task = Task(physics.scaled(rows.groups), target, np.ones_like(target), (slow, high[0]))
    return [shop.fit(task, how, seed=i) for i in range(members)]


def untested(inputs: int = INPUTS) -> Trust:
    """Return intervals of one width everywhere, before any case has measured them."""
    flat = Networks((np.zeros((1, inputs, len(OF))),), (np.zeros((1, 1, len(OF))),))
    return Trust(reach=flat, levels=np.ones((len(OF), len(CONFIDENCES))))


def _all(futures: list[Future[Networks]]) -> Networks:
    return together([future.result() for future in futures])


def scaled_task(
    inputs: Array, target: Array, known: Array | None = None
) -> tuple[Task, Array, Array]:
    """Return the task to learn scaled targets, and centre and spread of each."""
    known = np.ones_like(target) if known is None else known
    count = known.sum(axis=0)
    centre = (known * target).sum(axis=0) / count
    spread = np.sqrt((known * (target - centre) ** 2).sum(axis=0) / count)
    spread = np.maximum(spread, _LEAST_SPREAD)
    return Task(inputs, (target - centre) / spread, known), centre, spread


def _fast(fast: Rows) -> Task:
    limits = physics.slow_limit(fast.groups), physics.largest_fast_limit(fast.groups)
    target = np.log10(fast.force)[:, None]
    inputs = physics.scaled(fast.groups)[:, physics.FAST]
    return Task(inputs, target, np.ones_like(target), limits)


def work_task(rows: Rows) -> tuple[Task, Array, Array]:
    """Return the task to learn work over force, and centre and spread of its target."""
    force = np.log10(rows.force)
    told = physics.with_start(rows.groups, rows.start_force, rows.start_radius, force)
    return scaled_task(told, (np.log10(rows.work) - force)[:, None])


def give_task(rows: Rows) -> tuple[Task, Array, Array]:
    """Return the task to learn the travel to zero force of pressed starts, as `rows` have it."""
    return scaled_task(_told(rows), np.log10(rows.give)[:, None])


def _line(rows: Rows) -> tuple[Task, Array, Array]:
    assert rows.line.shape[1] == line.OUTPUTS
    return scaled_task(_told(rows), rows.line, rows.known)


def _told(rows: Rows) -> Array:
    logs = np.log10(rows.force), np.log10(rows.work)
    return physics.with_start(rows.groups, rows.start_force, rows.start_radius, *logs)
