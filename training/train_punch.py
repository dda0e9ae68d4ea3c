"""The surrogate of the punch, from its datasets to its file and its scores.

``python -m training.train_punch --out DIR``. First the two limits and the
relaxed start are learned, then where between the limits the stress is, then work and curve; each is
looked at twice, for what a network leaves over is smooth. Fitted networks are kept in the folder,
so that a run that was stopped goes on. Of the rows one part is kept apart to measure how wide
intervals must be, and one to judge; which, is the same in every run. So it is with the rows of
`punch_faces`, from none of which anything else is learned.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from viscotack import datasets
from viscotack.datasets.files import checksum
from viscotack.problem.outputs import PLANE
from viscotack.surrogate import punch_physics as physics
from viscotack.surrogate import store
from viscotack.surrogate.model import Surrogate
from viscotack.surrogate.network import Networks
from viscotack.surrogate.punch_physics import Array, PunchContact, told
from viscotack.version import __version__

from .calibration import judged, worth
from .fitting import Fit, Task
from .recipe import scaled_task
from .refining import Looks, Stage, twice
from .rows import Rows, joined, of_table
from .shop import Shop

LEARNED, LIMITS, FACES = ("punch", "punch_starts"), "punch_limits", "punch_faces"
# Parts of the rows that measure intervals and that judge, and the seed of the draw.
_MEASURING, _JUDGING, _SEED = 0.1, 0.1, 2026
# Networks of each kind but the line.
_MEMBERS = 3


SMALL, LARGE = (20, 20, 20), (32, 32, 32)
SLOW = Looks(Fit(SMALL, 3000, 1e-9, 0.1), Stage(Fit(SMALL, 1500, 1e-6, 1e-3), 0.01))
FAST = Looks(Fit(SMALL, 4000, 1e-9, 0.1), Stage(Fit(SMALL, 2000, 1e-6, 1e-3), 0.01))
STRESS = Looks(Fit(LARGE, 4000, 1e-9, 0.1), Stage(Fit(LARGE, 2500, 1e-6, 1e-3), 0.02))
WORK = Looks(Fit(LARGE, 4000, 1e-9, 1.0), Stage(Fit(LARGE, 2500, 1e-6, 0.01), 0.02))
GIVE = Looks(Fit(SMALL, 3000, 1e-9, 1.0), Stage(Fit(SMALL, 2000, 1e-6, 0.01), 0.02))
START = Looks(Fit(SMALL, 3000, 1e-9, 1.0), Stage(Fit(SMALL, 2000, 1e-6, 0.01), 0.02))
LINE = Fit((40, 40, 40), 3000, 1e-8, 1.0)
Mask = npt.NDArray[np.bool_]


def read(name: str) -> Rows:
    """Return the rows of a set of punches."""
    return of_table(datasets.load(name), inputs=physics.INPUTS, kind=PLANE)


def learn(rows: Rows, limits: Rows, shop: Shop, said: Callable[[str], None]) -> Surrogate:
    """Return a surrogate that learned from rows and from those of the limits, without intervals."""
    elastic = limits.groups[:, physics.MODULUS_RATIO] == 1
    slow, fast = limits.chosen(elastic), limits.chosen(~elastic)
    everything = joined([rows, limits])
    stressed = (everything.groups / physics.unit(everything.groups))[:, physics.PRELOAD]
    starting = _begin(
        physics.scaled(everything.groups)[:, physics.START],
        np.log10(everything.start_force) - np.log10(stressed),
        START,
        shop,
        members=1,
    )
    slows = _limit(slow, physics.SLOW, physics.least(slow.groups), SLOW, shop)
    fasts = _limit(fast, physics.FAST, physics.least_fast(fast.groups), FAST, shop)
    made = Surrogate(PunchContact, {"start": starting(), "fast": fasts(), "slow": slows()})
    said("limits")
    tests, log = made.tests(rows.groups), np.log10(rows.force)
    low, high = tests.slow, tests.fast
    tasks = [
        Task(tests.told, log[:, None], np.ones_like(log[:, None]), (a, b))
        for a, b in zip(low, high, strict=True)
    ]
    known = told(tests.scaled, low.mean(axis=0), log)
    with_work = np.column_stack([known, np.log10(rows.work)])
    give = np.log10(rows.give * rows.start_force / rows.groups[:, physics.PRELOAD])
    stresses = twice(tasks, STRESS, shop)
    works = _begin(known, np.log10(rows.work) - log, WORK, shop)
    gives = _begin(known, give, GIVE, shop)
    line = scaled_task(with_work, rows.line, rows.known)
    shapes = shop.fit(line.task, LINE)
    made = made.having(force=stresses(), work=works(), give=gives(), line=line.of(shapes.result()))
    said("stress, work and curve")
    return made


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


def make(folder: Path, *, workers: int) -> dict[str, Any]:
    """Train and write ``punch.npz`` in the folder; return its metadata.

    :mod:`training.second` measures the intervals.
    """
    began = perf_counter()

    def say(what: str) -> None:
        print(f"{perf_counter() - began:6.0f} s  {what}", file=sys.stderr, flush=True)

    sets = [read(name) for name in LEARNED]
    masks = [parts(len(rows)) for rows in sets]
    learned, measuring = (
        joined([rows.chosen(mask) for rows, mask in zip(sets, some, strict=True)])
        for some in ([~(m | j) for m, j in masks], [m for m, _ in masks])
    )
    ends = faces()
    measuring = joined([measuring, ends.chosen(slice(0, None, 2))])
    with threadpool_limits(1), Shop(folder / "networks", workers) as shop:
        made = learn(learned, read(LIMITS), shop, say)
    facts = {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        "sets": {n: checksum(datasets.path(n).read_bytes()) for n in (*LEARNED, LIMITS, FACES)},
        "rows": {
            "learned": len(learned),
            "measuring": len(measuring),
            "judging": len(joined(judging())),
        },
    }
    store.save(made, folder / "punch.npz", facts)
    say("done")
    return facts


def main() -> None:
    """Train and print metadata."""
    parser = argparse.ArgumentParser(prog="python -m training.train_punch")
    parser.add_argument("--out", type=Path, required=True, help="folder of networks and the file")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    given = parser.parse_args()
    print(json.dumps(make(given.out, workers=given.workers), indent=1))


if __name__ == "__main__":
    main()
