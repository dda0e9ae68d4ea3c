"""The surrogate of a sphere from rows: which network learns what, and in which order."""

from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace

import numpy as np

from viscotack.surrogate import line, physics
from viscotack.surrogate.model import Surrogate
from viscotack.surrogate.network import Networks, together
from viscotack.surrogate.physics import Array, SphereContact

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
class Scaled:
    """A task whose targets are of order one, and what they stand for.

    Attributes
    ----------
    task : Task
    centre, spread : ndarray, shape (outputs,)
        As :class:`..network.Networks` have them.
    """

    task: Task
    centre: Array
    spread: Array

    def of(self, networks: Networks) -> Networks:
        """Return networks that learned the task, in the units of the targets."""
        return replace(networks, centre=self.centre, spread=self.spread)


def scaled_task(inputs: Array, target: Array, known: Array | None = None) -> Scaled:
    """Return the task to learn targets, each scaled by its mean and deviation."""
    known = np.ones_like(target) if known is None else known
    count = known.sum(axis=0)
    centre = (known * target).sum(axis=0) / count
    spread = np.sqrt((known * (target - centre) ** 2).sum(axis=0) / count)
    spread = np.maximum(spread, _LEAST_SPREAD)
    return Scaled(Task(inputs, (target - centre) / spread, known), centre, spread)


def learn_limits(rows: Rows, fast: Rows, recipe: Recipe, shop: Shop) -> Surrogate:
    """Return a surrogate of the relaxed start, from rows, and the fast limit, from the set of it.

    Both depend on two and three of the inputs only. They are known in cells and bands that other
    networks are judged on: what is told there is the way between the limits.
    """
    begun = start_task(rows)
    starting = shop.fit(begun.task, recipe.limits)
    limiting = shop.fit(fast_task(fast), recipe.limits)
    networks = {"start": begun.of(starting.result()), "fast": limiting.result()}
    return Surrogate(SphereContact, networks)


@dataclass(frozen=True, eq=False)
class Pending:
    """A surrogate whose networks are being fitted."""

    limits: Surrogate
    forces: list[Future[Networks]]
    others: Mapping[str, tuple[Scaled, list[Future[Networks]]]]

    def surrogate(self) -> Surrogate:
        """Return it when all are done; its intervals have not been measured yet."""
        others = {name: task.of(_all(begun)) for name, (task, begun) in self.others.items()}
        return self.limits.having(force=_all(self.forces), **others)


def learn(rows: Rows, limits: Surrogate, recipe: Recipe, shop: Shop) -> Pending:
    """Begin to learn force, work and curves of rows.

    Parameters
    ----------
    rows : Rows
        What is learned from.
    limits : Surrogate
        What it stands on.
    recipe : Recipe
        Sizes and steps.
    shop : Shop
        Where networks are fitted.
    """
    forces = begin_forces(rows, limits, recipe.force, shop, members=recipe.members)
    pressed = rows.chosen(rows.start_force > 0)
    assert rows.line.shape[1] == line.OUTPUTS
    tasks = {
        "work": (work_task(rows), recipe.work, recipe.members),
        "give": (give_task(pressed), recipe.work, recipe.members),
        "line": (scaled_task(_told(rows), rows.line, rows.known), recipe.line, 1),
    }
    others = {
        name: (each, [shop.fit(each.task, how, seed=i) for i in range(members)])
        for name, (each, how, members) in tasks.items()
    }
    return Pending(limits, forces, others)


def begin_forces(
    rows: Rows, limits: Surrogate, how: Fit, shop: Shop, *, members: int = 1
) -> list[Future[Networks]]:
    """Begin to learn the force alone."""
    task = force_task(rows, limits)
    return [shop.fit(task, how, seed=i) for i in range(members)]


def _all(futures: list[Future[Networks]]) -> Networks:
    return together([future.result() for future in futures])


# Tasks ---------------------------------------------------------------------------------------


def force_task(rows: Rows, limits: Surrogate) -> Task:
    """Return the task to learn the force between limits, the fast one of the first network."""
    tests, target = limits.tests(rows.groups), np.log10(rows.force)[:, None]
    return Task(tests.told, target, np.ones_like(target), (tests.slow, tests.fast[0]))


def fast_task(fast: Rows) -> Task:
    """Return the task to learn the fast limit."""
    limits = physics.slow_limit(fast.groups), physics.largest_fast_limit(fast.groups)
    target = np.log10(fast.force)[:, None]
    inputs = physics.scaled(fast.groups)[:, physics.FAST]
    return Task(inputs, target, np.ones_like(target), limits)


def start_task(rows: Rows) -> Scaled:
    """Return the task to learn force and log10 of the radius of relaxed starts."""
    force, radius = physics.start_output(rows.groups, rows.start_force), np.log10(rows.start_radius)
    inputs = physics.scaled(rows.groups)[:, physics.START]
    return scaled_task(inputs, np.column_stack([force, radius]))


def work_task(rows: Rows) -> Scaled:
    """Return the task to learn work over force."""
    force = np.log10(rows.force)
    return scaled_task(_knowing(rows, force), (np.log10(rows.work) - force)[:, None])


def give_task(rows: Rows) -> Scaled:
    """Return the task to learn the travel to zero force of pressed starts, as `rows` have it."""
    return scaled_task(_told(rows), np.log10(rows.give)[:, None])


def _told(rows: Rows) -> Array:
    return _knowing(rows, np.log10(rows.force), np.log10(rows.work))


def _knowing(rows: Rows, *logarithms: Array) -> Array:
    inputs = physics.scaled(rows.groups)
    return physics.with_start(inputs, rows.start_force, rows.start_radius, *logarithms)
