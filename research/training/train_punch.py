"""The surrogate of the punch from its datasets; six minutes on four cores.

First the two limits and the relaxed start are learned, then where between the limits the stress is,
then work and curve; each is looked at twice, for what a network leaves over is smooth. Of the rows
one part is kept apart to measure how wide intervals must be, and one to judge; which, is the same
in every run. So it is with the rows of `punch_faces`, from none of which anything else is learned.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack import datasets
from viscotack.model.problem.outputs import PLANE
from viscotack.prediction.surrogate import punch_physics as physics
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks
from viscotack.prediction.surrogate.punch_physics import Array, PunchContact, told

from .calibration import judged, worth
from .fitting import Fit, Task
from .refining import Looks, Stage, scaled_task, twice
from .rows import Rows, joined, of_table
from .shop import Shop

LEARNED, LIMITS, FACES = ("punch", "punch_starts"), "punch_limits", "punch_faces"
# Parts of the rows that measure intervals and that judge, and the seed of the draw.
_MEASURING, _JUDGING, _SEED = 0.1, 0.1, 2026
# Networks of each kind but the line.
_MEMBERS = 3

_SMALL, _LARGE = (20, 20, 20), (32, 32, 32)
RECIPE = {
    "slow": Looks(Fit(_SMALL, 3000, 1e-9, 0.1), Stage(Fit(_SMALL, 1500, 1e-6, 1e-3), 0.01)),
    "fast": Looks(Fit(_SMALL, 4000, 1e-9, 0.1), Stage(Fit(_SMALL, 2000, 1e-6, 1e-3), 0.01)),
    "force": Looks(Fit(_LARGE, 4000, 1e-9, 0.1), Stage(Fit(_LARGE, 2500, 1e-6, 1e-3), 0.02)),
    "work": Looks(Fit(_LARGE, 4000, 1e-9, 1.0), Stage(Fit(_LARGE, 2500, 1e-6, 0.01), 0.02)),
    "give": Looks(Fit(_SMALL, 3000, 1e-9, 1.0), Stage(Fit(_SMALL, 2000, 1e-6, 0.01), 0.02)),
    "start": Looks(Fit(_SMALL, 3000, 1e-9, 1.0), Stage(Fit(_SMALL, 2000, 1e-6, 0.01), 0.02)),
}
LINE = Fit((40, 40, 40), 3000, 1e-8, 1.0)
# Of a trial: every so many rows, and small networks.
_THINNED, _TRIAL = 4, Fit((8,), steps=60, scale=0.3)
QUICK = dict.fromkeys(RECIPE, Looks(_TRIAL, Stage(_TRIAL, 0.1)))
Mask = npt.NDArray[np.bool_]


def read(name: str) -> Rows:
    """Return the rows of a set of punches."""
    return of_table(datasets.load(name), inputs=physics.INPUTS, kind=PLANE)


def learn(rows: Rows, limits: Rows, shop: Shop, how: Mapping[str, Looks], line: Fit) -> Surrogate:
    """Return a surrogate that learned from rows and from those of the limits, without intervals."""
    elastic = limits.groups[:, physics.MODULUS_RATIO] == 1
    slow, fast = limits.chosen(elastic), limits.chosen(~elastic)
    everything = joined([rows, limits])
    stressed = (everything.groups / physics.unit(everything.groups))[:, physics.PRELOAD]
    starting = _begin(
        physics.scaled(everything.groups)[:, physics.START],
        np.log10(everything.start_force) - np.log10(stressed),
        how["start"],
        shop,
        members=1,
    )
    slows = _limit(slow, physics.SLOW, physics.least(slow.groups), how["slow"], shop)
    fasts = _limit(fast, physics.FAST, physics.least_fast(fast.groups), how["fast"], shop)
    made = Surrogate(PunchContact, {"start": starting(), "fast": fasts(), "slow": slows()})
    tests, log = made.tests(rows.groups), np.log10(rows.force)
    low, high = tests.slow, tests.fast
    tasks = [
        Task(tests.told, log[:, None], np.ones_like(log[:, None]), (a, b))
        for a, b in zip(low, high, strict=True)
    ]
    known = told(tests.scaled, low.mean(axis=0), log)
    with_work = np.column_stack([known, np.log10(rows.work)])
    give = np.log10(rows.give * rows.start_force / rows.groups[:, physics.PRELOAD])
    stresses = twice(tasks, how["force"], shop)
    works = _begin(known, np.log10(rows.work) - log, how["work"], shop)
    gives = _begin(known, give, how["give"], shop)
    shape = scaled_task(with_work, rows.line, rows.known)
    shapes = shop.fit(shape.task, line)
    return made.having(force=stresses(), work=works(), give=gives(), line=shape.of(shapes.result()))


def _limit(
    rows: Rows, inputs: list[int], least: Array, looks: Looks, shop: Shop
) -> Callable[[], Networks]:
    """Begin to learn a limit of the stress."""
    target = np.log10(rows.force)[:, None]
    told = physics.scaled(rows.groups)[:, inputs]
    task = Task(told, target, np.ones_like(target), (least, np.zeros(len(least))))
    return twice([task] * _MEMBERS, looks, shop)


def _begin(
    inputs: Array, target: Array, looks: Looks, shop: Shop, *, members: int = _MEMBERS
) -> Callable[[], Networks]:
    """Begin to learn one output that is scaled by its mean and deviation."""
    task = scaled_task(inputs, target[:, None])
    begun = twice([task.task] * members, looks, shop)
    return lambda: task.of(begun())


def scored(made: Surrogate, rows: Rows) -> dict[str, Any]:
    """Return what a surrogate is worth on rows that it has not learned from, ready for JSON."""
    found = worth(made, judged(made, rows))
    return {"stress" if name == "force" else name: each for name, each in found.items()}


def judging() -> list[Rows]:
    """Return the rows of each set that judge."""
    sets = [read(name) for name in LEARNED]
    return [rows.chosen(parts(len(rows))[1]) for rows in sets]


def scores(made: Surrogate) -> dict[str, Any]:
    """Return what a surrogate is worth on the rows that judge, by set."""
    each = judging()
    found = {"all": scored(made, joined(each))}
    found |= {name: scored(made, rows) for name, rows in zip(LEARNED, each, strict=True)}
    return found | {"faces": scored(made, faces().chosen(slice(1, None, 2)))}


def parts(count: int) -> tuple[Mask, Mask]:
    """Return which of so many rows measure intervals, and which judge: the same in every run.

    Rows that are added to a set leave those before them where they are.
    """
    place = np.random.default_rng(_SEED).random(count)
    return place < _MEASURING, (place >= _MEASURING) & (place < _MEASURING + _JUDGING)


def faces() -> Rows:
    """Return the rows at ends of the range: every second one measures, the others judge."""
    return read(FACES)


def parted() -> tuple[list[Rows], list[Rows]]:
    """Return the rows of each set that networks learn from, and those that measure intervals."""
    sets = [read(name) for name in LEARNED]
    masks = [parts(len(rows)) for rows in sets]
    learn = [rows.chosen(~(m | j)) for rows, (m, j) in zip(sets, masks, strict=True)]
    return learn, [rows.chosen(m) for rows, (m, _) in zip(sets, masks, strict=True)]


def learned(
    shop: Shop, *, quick: bool = False
) -> tuple[Surrogate, tuple[str, ...], dict[str, Any]]:
    """Return the surrogate of punches without intervals, its sets and its facts."""
    learn_from, measuring = parted()
    rows = joined(learn_from)
    if quick:
        rows = rows.chosen(slice(None, None, _THINNED))
    counts = {
        "learned": len(rows),
        "measuring": len(joined([*measuring, faces().chosen(slice(0, None, 2))])),
        "judging": len(joined(judging())),
    }
    made = learn(rows, read(LIMITS), shop, *((QUICK, _TRIAL) if quick else (RECIPE, LINE)))
    return made, (*LEARNED, LIMITS, FACES), {"rows": counts}
