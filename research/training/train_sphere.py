"""The surrogate of spheres on power laws from its datasets; 45 minutes on four cores.

Relaxed start and fast limit, which depend on two and three of the inputs only, are one network
each at the first look and have members of their own at the second: the spread of the answers counts
their doubt too.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.physics import SphereContact

from . import rows
from .fitting import Fit, Task
from .joining import together
from .refining import Looks, Scaled, Stage, again, all_done, scaled_task, twice
from .rows import FAR_OFF, FAST, LEARNED, Rows
from .shop import Shop

# Rows drawn at random that no network learns from.
_KEPT, _SEED = 0.06, 2026
# Every so many rows where all is only tried.
_THINNED = 4


@dataclass(frozen=True)
class Recipe:
    """How the networks of a surrogate are fitted.

    `limits` at the first look at relaxed start and fast limit, `start` and `fast` at further ones,
    `line` of the shapes of curves, `work` of the travel to zero force too. Every so many rows
    (`thinned`) tell the start at the second look; `members` of each kind but the shapes.
    """

    limits: Fit = Fit((24, 24, 24), steps=5000)
    line: Fit = Fit((48, 48, 48), steps=5000, scale=1.0)
    start: Stage = Stage(Fit((16, 16, 16), steps=1000, scale=0.1, penalty=1e-6), 0.03)
    fast: tuple[Stage, ...] = (
        Stage(Fit((32, 32, 32), steps=5000, scale=1e-3, penalty=1e-6), 1e-2),
        Stage(Fit((32, 32, 32), steps=4000, scale=1e-4, penalty=1e-5), 2e-3),
    )
    force: Looks = Looks(
        Fit(steps=8000), Stage(Fit((32, 32, 32), steps=2000, scale=1e-3, penalty=1e-6), 1e-2)
    )
    work: Looks = Looks(
        Fit(steps=5000, scale=1.0, penalty=1e-9),
        Stage(Fit((32, 32, 32), steps=2000, scale=2e-3, penalty=1e-6), 2e-2),
    )
    thinned: int = 8
    members: int = 3


_ONE, _TWO = (
    Stage(Fit(hidden, steps=100, scale=1e-2, penalty=1e-6), 0.1) for hidden in ((8,), (8, 8))
)
# Of a trial: to see that everything runs.
QUICK = Recipe(
    limits=Fit((8,), steps=150),
    line=Fit((12,), steps=100, scale=1.0),
    start=_ONE,
    fast=(_ONE,),
    force=Looks(Fit((12, 12), steps=200), _TWO),
    work=Looks(Fit((12, 12), steps=200, scale=1.0), _TWO),
    members=2,
)


def learned(
    shop: Shop, *, quick: bool = False
) -> tuple[Surrogate, tuple[str, ...], dict[str, Any]]:
    """Return the surrogate of spheres on power laws without intervals, its sets and its facts."""
    fast, recipe = rows.read(FAST), QUICK if quick else Recipe()
    learn_from, test = parted()
    if quick:
        every = slice(None, None, _THINNED)
        fast, learn_from, test = (some.chosen(every) for some in (fast, learn_from, test))
    counts = {"learned from": len(learn_from), "kept apart": len(test)}
    facts = {"rows": counts, "recipe": asdict(recipe)}
    return learn(learn_from, fast, recipe, shop), (*LEARNED, FAST, *FAR_OFF, "fresh"), facts


def learn(whole: Rows, fast: Rows, how: Recipe, shop: Shop) -> Surrogate:
    """Return a surrogate that learned from rows and from those of the fast limit."""
    starts, limit, members = start_task(whole), fast_task(fast), range(how.members)
    starting, limiting = (shop.fit(task, how.limits) for task in (starts.task, limit))
    limits = Surrogate(SphereContact, {"fast": limiting.result()})
    first = force_task(whole, limits)
    forces = [shop.fit(first, how.force.first, seed=i) for i in members]
    tasks = {"work": work_task(whole), "give": give_task(whole.chosen(whole.start_force > 0))}
    others = {n: twice([each.task] * how.members, how.work, shop) for n, each in tasks.items()}
    line = scaled_task(_told(whole), whole.line, whole.known)
    shapes = shop.fit(line.task, how.line)
    fasts = [limiting.result() for _ in members]
    for seed in members:
        for stage in how.fast:
            fasts[seed] = again(fasts[seed], limit, stage, shop, seed).done()
    second = [force_task(whole, limits.having(fast=one)) for one in fasts]
    looks = [
        again(one.result(), task, how.force.second, shop, i)
        for i, (one, task) in enumerate(zip(forces, second, strict=True))
    ]
    some = {n: getattr(starts.task, n)[:: how.thinned] for n in ("inputs", "target", "weight")}
    thinned = replace(starts.task, **some)
    begun = [again(starting.result(), thinned, how.start, shop, i) for i in members]
    return limits.having(
        fast=together(fasts),
        force=all_done(looks),
        start=starts.of(all_done(begun)),
        line=line.of(shapes.result()),
        **{name: tasks[name].of(done()) for name, done in others.items()},
    )


def measuring_rows(test: rows.Rows) -> tuple[rows.Rows, ...]:
    """Return the rows that measure intervals: those kept apart, and those of `fresh`.

    Of the former without those of `thesis`, most of which are materials of a few kinds; of the
    latter without those whose own errors are larger than what is to be measured, and those on faces
    of the range as a set of their own, for errors reach further there.
    """
    fresh = rows.read("fresh")
    measuring = rows.certain("fresh")
    low, high = np.array(list(physics.LIMITS.values())).T
    faces = np.any((fresh.groups == low) | (fresh.groups == high), axis=1)
    kept = test.chosen(test.origin != LEARNED.index("thesis"))
    return kept, fresh.chosen(measuring & ~faces), fresh.chosen(measuring & faces)


def parted() -> tuple[rows.Rows, rows.Rows]:
    """Return the rows that networks learn from, and those kept apart: the same in every run."""
    whole = rows.read(*LEARNED)
    kept = np.random.default_rng(_SEED).random(len(whole)) < _KEPT
    return whole.chosen(~kept), whole.chosen(kept)


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
