"""The surrogate of the punch, from its datasets to its file and its scores.

``python -m viscotack.surrogate.training.train_punch --out DIR``. First the two limits and the
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
from concurrent.futures import Future
from dataclasses import dataclass, replace
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
from viscotack.version import __version__

from .. import punch_physics as physics
from .. import punch_surrogate
from ..model import Scaled
from ..network import Networks, added, together
from ..punch_physics import Array
from ..punch_surrogate import PunchSurrogate, told, with_work
from ..trust import OF, Trust, error_inputs
from .calibration import HOW, Apart, errors_of, levels_of, reach_task, untested
from .calibration import scored as of_reach
from .fitting import Fit, Task
from .recipe import scaled_task
from .recipe import untested as everywhere_alike
from .rows import Rows, joined, of_table
from .shop import Shop

LEARNED, LIMITS, FACES = ("punch", "punch_starts"), "punch_limits", "punch_faces"
# Parts of the rows that measure intervals and that judge, and the seed of the draw.
_MEASURING, _JUDGING, _SEED = 0.1, 0.1, 2026
# Networks of each kind but the line.
_MEMBERS = 3


@dataclass(frozen=True)
class Looks:
    """How a network is fitted, and the one that learns what it leaves over.

    Attributes
    ----------
    first, second : Fit
        Scales of the second are about the errors that are left.
    gain : float
        What the outputs of the second are multiplied by before they are added.
    """

    first: Fit
    second: Fit
    gain: float


SMALL, LARGE = (20, 20, 20), (32, 32, 32)
SLOW = Looks(Fit(SMALL, 3000, 1e-9, 0.1), Fit(SMALL, 1500, 1e-6, 1e-3), 0.01)
FAST = Looks(Fit(SMALL, 4000, 1e-9, 0.1), Fit(SMALL, 2000, 1e-6, 1e-3), 0.01)
STRESS = Looks(Fit(LARGE, 4000, 1e-9, 0.1), Fit(LARGE, 2500, 1e-6, 1e-3), 0.02)
WORK = Looks(Fit(LARGE, 4000, 1e-9, 1.0), Fit(LARGE, 2500, 1e-6, 0.01), 0.02)
GIVE = Looks(Fit(SMALL, 3000, 1e-9, 1.0), Fit(SMALL, 2000, 1e-6, 0.01), 0.02)
START = Looks(Fit(SMALL, 3000, 1e-9, 1.0), Fit(SMALL, 2000, 1e-6, 0.01), 0.02)
LINE = Fit((40, 40, 40), 3000, 1e-8, 1.0)
Mask = npt.NDArray[np.bool_]


def read(name: str) -> Rows:
    """Return the rows of a set of punches."""
    return of_table(datasets.load(name), inputs=physics.INPUTS, kind=PLANE)


def learn(rows: Rows, limits: Rows, shop: Shop, said: Callable[[str], None]) -> PunchSurrogate:
    """Return a surrogate that learned from rows and from those of the limits, without intervals."""
    elastic = limits.groups[:, physics.MODULUS_RATIO] == 1
    slow, fast = limits.chosen(elastic), limits.chosen(~elastic)
    everything = joined([rows, limits])
    starting = _begin_scaled(
        physics.scaled(everything.groups)[:, physics.START],
        np.log10(everything.start_force) - _log(physics.stressed(everything.groups)),
        START,
        shop,
        members=1,
    )
    slows = _limit(slow, physics.SLOW, physics.least(slow.groups), SLOW, shop)
    fasts = _limit(fast, physics.FAST, physics.least_fast(fast.groups), FAST, shop)
    start, fast_networks = starting(), fasts()
    # what is not learned yet has a place holder
    made = PunchSurrogate(
        start=start,
        slow=slows(),
        fast=fast_networks,
        stress=fast_networks,
        work=start,
        give=start,
        line=start,
        trust=everywhere_alike(),
    )
    said("limits")
    log = np.log10(rows.force)
    low, high = made.way(rows.groups)
    inputs, target = physics.scaled(rows.groups), log[:, None]
    tasks = [
        Task(inputs, target, np.ones_like(target), (a, b)) for a, b in zip(low, high, strict=True)
    ]
    known = told(rows.groups, low.mean(axis=0), log)
    give = np.log10(rows.give * rows.start_force / rows.groups[:, physics.PRELOAD])
    stresses = _twice(tasks, STRESS, shop)
    works = _begin_scaled(known, np.log10(rows.work) - log, WORK, shop)
    gives = _begin_scaled(known, give, GIVE, shop)
    line, *of_line = scaled_task(with_work(known, rows.work), rows.line, rows.known)
    shapes = shop.fit(line, LINE)
    made = replace(
        made,
        stress=stresses(),
        work=works(),
        give=gives(),
        line=Scaled(shapes.result(), *of_line),
    )
    said("stress, work and curve")
    return made


def _log(stressed: Array) -> Array:
    return np.log10(stressed[:, physics.PRELOAD])


def _limit(
    rows: Rows, inputs: list[int], least: Array, looks: Looks, shop: Shop
) -> Callable[[], Networks]:
    """Begin to learn a limit of the stress."""
    target = np.log10(rows.force)[:, None]
    told = physics.scaled(rows.groups)[:, inputs]
    task = Task(told, target, np.ones_like(target), (least, np.zeros(len(least))))
    return _twice([task] * _MEMBERS, looks, shop)


def _twice(tasks: list[Task], looks: Looks, shop: Shop) -> Callable[[], Networks]:
    """Begin to learn tasks, a network each; what is returned waits, and looks at each again."""
    begun = [shop.fit(task, looks.first, seed=i) for i, task in enumerate(tasks)]

    def again(task: Task, first: Networks, seed: int) -> Future[Networks]:
        left = replace(task, before=first(task.inputs)[0], gain=looks.gain)
        return shop.fit(left, looks.second, seed=seed)

    def done() -> Networks:
        firsts = [one.result() for one in begun]
        seconds = [again(t, f, i) for i, (t, f) in enumerate(zip(tasks, firsts, strict=True))]
        return together([added(f, s.result()) for f, s in zip(firsts, seconds, strict=True)])

    return done


def _begin_scaled(
    inputs: Array, target: Array, looks: Looks, shop: Shop, *, members: int = _MEMBERS
) -> Callable[[], Scaled]:
    """Begin to learn one output that is scaled by its mean and deviation."""
    task, centre, spread = scaled_task(inputs, target[:, None])
    begun = _twice([task] * members, looks, shop)
    return lambda: Scaled(begun(), centre, spread)


def judged(made: PunchSurrogate, rows: Rows) -> Apart:
    """Return how far a surrogate is off on some rows."""
    said = made.evaluate(rows.groups)
    return Apart(error_inputs(physics.scaled(rows.groups), said), errors_of(made, rows, said))


def trusted(made: PunchSurrogate, learned: Apart, kept: Apart, shop: Shop) -> PunchSurrogate:
    """Return a surrogate with intervals: networks of the reach, and levels of rows kept apart.

    A network learns from the rows that were learned from and from one half of the others, and is
    judged by the other half, as :mod:`.calibration` has it.
    """
    halves = [kept.chosen(np.arange(len(kept.error)) % 2 == half) for half in (0, 1)]
    begun = [shop.fit(reach_task(learned, [half]), HOW, seed=i) for i, half in enumerate(halves)]
    members = [one.result() for one in begun]
    scores = [
        of_reach(Trust(one, untested()), half)
        for one, half in zip(members, halves[::-1], strict=True)
    ]
    return replace(made, trust=Trust(together(members), levels_of(np.concatenate(scores))))


def scored(made: PunchSurrogate, rows: Rows) -> dict[str, Any]:
    """Return what a surrogate is worth on rows that it has not learned from, ready for JSON."""
    errors = judged(made, rows)
    widths = np.column_stack(made.trust.widths(errors.told, 0.9))
    found: dict[str, Any] = {"rows": len(rows)}
    for i, name in enumerate(("stress", *OF[1:])):
        log = np.abs(errors.error[:, i])
        # errors of curves are parts of the pull-off stress, those of the others of logarithms
        part, half = (
            (log, widths[:, i]) if name == "curve" else (10**log - 1, 10 ** widths[:, i] - 1)
        )
        found[name] = {
            "mse_log10": None if name == "curve" else float(np.mean(log**2)),
            "median": float(np.median(part)),
            "95 %": float(np.quantile(part, 0.95)),
            "largest": float(part.max()),
            "cover": float(np.mean(log <= widths[:, i])),
            "half width": float(np.median(half)),
            "worst, half widths": float(np.max(log / widths[:, i])),
        }
    return found


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
    """Train, measure, write ``punch.npz`` in the folder; return what it is worth."""
    began = perf_counter()

    def say(what: str) -> None:
        print(f"{perf_counter() - began:6.0f} s  {what}", file=sys.stderr, flush=True)

    sets = [read(name) for name in LEARNED]
    masks = [parts(len(rows)) for rows in sets]
    learned, measuring, judging = (
        joined([rows.chosen(mask) for rows, mask in zip(sets, some, strict=True)])
        for some in ([~(m | j) for m, j in masks], [m for m, _ in masks], [j for _, j in masks])
    )
    ends = faces()
    measuring = joined([measuring, ends.chosen(slice(0, None, 2))])
    with threadpool_limits(1), Shop(folder / "networks", workers) as shop:
        made = learn(learned, read(LIMITS), shop, say)
        made = trusted(made, judged(made, learned), judged(made, measuring), shop)
        say("intervals")
    scores = {"all": scored(made, judging)} | {
        name: scored(made, rows.chosen(j))
        for name, rows, (_, j) in zip(LEARNED, sets, masks, strict=True)
    }
    scores["faces"] = scored(made, ends.chosen(slice(1, None, 2)))
    facts = {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        "sets": {n: checksum(datasets.path(n).read_bytes()) for n in (*LEARNED, LIMITS, FACES)},
        "rows": {"learned": len(learned), "measuring": len(measuring), "judging": len(judging)},
        "scores": scores,
    }
    punch_surrogate.save(made, folder / "punch.npz", facts)
    say("done")
    return facts


def main() -> None:
    """Train and say what it is worth."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.train_punch")
    parser.add_argument("--out", type=Path, required=True, help="folder of networks and the file")
    parser.add_argument("--workers", type=int, default=1, help="processes")
    given = parser.parse_args()
    print(json.dumps(make(given.out, workers=given.workers), indent=1))


if __name__ == "__main__":
    main()
