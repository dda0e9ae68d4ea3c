r"""How wide the intervals are to be: how far errors reach around a case, and conformal levels.

How far they reach is learned from the errors of all rows, most of which the networks learned from:
where limits or inputs are told badly, errors are the same for those and for others, and several
networks agree in them, so that no spread shows it. Overfitting makes them smaller for rows
that were learned from, most on the faces of the range; so rows that were kept apart count more, and
those that were drawn where errors reach far: by an adversary who sought where intervals of an
earlier surrogate failed, and by how far its errors reached. The levels, by which all widths are
multiplied, come from the latter: networks of the reach learn from a half of them each, and are
judged by the other half (cross-conformal prediction, Vovk, doi:10.1007/s10472-013-9368-4). Each set
of them has levels of its own, and the largest counts: what holds in cases that are spread evenly
must hold in those on faces too. What the rows themselves are uncertain by is in both.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks
from viscotack.prediction.surrogate.trust import CONFIDENCES, OF, Trust

from .fitting import Fit, Task, fit
from .joining import together
from .rows import LEARNED, Rows
from .scores import errors, labels_of

# The part of the errors that a network of their reach is to hold: that of the usual intervals, so
# that one level serves wherever errors are alike, as where labels were biased, and wherever a few
# are far (conformalised quantile regression, doi:10.48550/arXiv.1905.03222). And smaller errors
# than those of the rows themselves [log10, log10, part of the pull-off force, log10], not worth
# telling.
REACH, LEAST = 0.9, np.array([5e-5, 1e-4, 3e-4, 1e-4])
# How many times a row counts that was kept apart, in learning how far errors reach.
WEIGHT = 8.0
# Sets with fewer numbers than this measure no level of them.
ENOUGH = 60
HOW = Fit(hidden=(24, 24), steps=700, scale=1.0, penalty=3e-5)


@dataclass(frozen=True, eq=False)
class Apart:
    """How far a surrogate is off on some rows, and what a network of their reach is told."""

    told: Array
    # Of log10 of force and of work, the largest of the curve in tension over the pull-off force,
    # and of log10 of the travel to zero force, nan for starts in tension; shape (n, 4).
    error: Array

    def chosen(self, which: Any) -> "Apart":
        """Return the rows of a mask."""
        return Apart(**{f.name: getattr(self, f.name)[which] for f in fields(self)})

    def without_curves(self) -> "Apart":
        """Return the rows without errors of curves.

        Errors are larger between the points at which a data set keeps a curve. Intervals learned
        from such rows missed the curve of one case in five in some part of the range.
        """
        error = self.error.copy()
        error[:, OF.index("curve")] = np.nan
        return replace(self, error=error)


def judged(surrogate: Surrogate, rows: Rows, given: Any = None) -> Apart:
    """Return how far a surrogate is off on some rows, by their groups or what else it is given."""
    tests = surrogate.tests(rows.groups if given is None else given)
    said = surrogate.evaluate(tests)
    found = errors(said, surrogate.curves(tests, said), labels_of(rows))
    return Apart(tests.told_of_errors(said), found)


def by_set(surrogate: Surrogate, rows: Rows) -> dict[str, Any]:
    """Return :func:`worth` for spheres of all sets and of each."""
    sets = {name: rows.chosen(rows.origin == i) for i, name in enumerate(LEARNED)}
    some = {"all": rows, **sets}
    return {n: worth(surrogate, judged(surrogate, x)) for n, x in some.items() if len(x)}


def trusted(
    surrogate: Surrogate,
    learned: Apart,
    kept: Sequence[Apart],
    *,
    hard: Sequence[Apart] = (),
    how: Fit = HOW,
    least: Array = LEAST,
    seeds: tuple[Sequence[int], Sequence[int]] = ((0,), (1,)),
) -> Surrogate:
    """Return a surrogate with intervals, from its errors on rows that it learned from and others.

    Intervals are to hold for each set of `kept`. Rows of `hard` were sought where errors are large:
    they tell how far errors reach there, and nothing of how often. Errors below `least` count
    alike; `seeds` are of the networks that learn from each half of the rows kept apart.
    """
    halves = [[one.chosen(np.arange(len(one.told)) % 2 == half) for one in kept] for half in (0, 1)]
    tasks = [reach_task(learned, [*half, *hard], least) for half in halves]
    found = [[fit(task, how, seed=i) for i in s] for task, s in zip(tasks, seeds, strict=True)]
    members = [together(some) for some in found]
    # the sets whose scores come from networks that have not seen them
    pairs = [
        (untested(one), some)
        for one, half in zip(members, halves[::-1], strict=True)
        for some in half
    ]
    sets = [pairs[i :: len(kept)] for i in range(len(kept))]
    return replace(surrogate, trust=levelled(untested(together(members)), sets))


def levelled(trust: Trust, sets: Sequence[Sequence[tuple[Trust, Apart]]]) -> Trust:
    """Return a trust with levels, single and joint, for the numbers of each set that are given.

    Of the sets the largest level counts.
    """
    scores = [np.concatenate([scored(of, rows) for of, rows in one]) for one in sets]
    # starts in tension have no travel to zero force, stored rows no curves, and of the works of a
    # set few may be given
    levels = np.nanmax([levels_of(one) for one in scores], axis=0)
    joint = np.nanmax([_joint(one, levels) for one in scores], axis=0)
    return replace(trust, levels=levels, joint=joint)


def _joint(scores: Array, levels: Array) -> Array:
    """Return the factors with which force, work and curve of rows are inside together."""
    with_all = scores[np.isfinite(scores[:, :3]).all(axis=1), :3]
    worst = (with_all[:, :, None] / levels[:3]).max(axis=1)
    return np.array([_level(one)[i] for i, one in enumerate(worst.T)])


def reach_task(learned: Apart, kept: Sequence[Apart], least: Array) -> Task:
    """Return the task to learn how far errors reach, from rows kept apart by so much more."""
    inputs = np.concatenate([one.told for one in (learned, *kept)])
    error = np.concatenate([one.error for one in (learned, *kept)])
    known = np.isfinite(error)
    target = np.log10(np.maximum(np.where(known, np.abs(error), 1.0), least))
    counts = known.astype(float)
    counts[len(learned.told) :] *= WEIGHT
    return Task(inputs, target, counts, quantile=REACH)


def untested(reach: Networks) -> Trust:
    """Return a trust with levels of one, before any case has measured them."""
    count = len(CONFIDENCES)
    return Trust(reach, np.ones((len(OF), count)), np.ones(count))


def scored(trust: Trust, apart: Apart) -> Array:
    """Return errors over their predicted sizes, shape (n, 4); nan of what is not given."""
    size = 10.0 ** trust.reach(apart.told).mean(axis=0)
    return np.where(given_of(trust, apart), np.abs(apart.error) / size, np.nan)


def given_of(trust: Trust, apart: Apart) -> npt.NDArray[np.bool_]:
    """Return a mask of the numbers of ``OF`` that are given, shape (n, 4)."""
    return ~trust.doubtful(apart.told)[:, [0, 1, 1, 1]]


def levels_of(scores: Array) -> Array:
    """Return the levels that hold the wanted shares of scores, shape (4, confidences).

    Those of a column with fewer than ``ENOUGH`` scores are nan.
    """
    return np.array([_level(column[np.isfinite(column)]) for column in scores.T])


def _level(scores: Array) -> Array:
    scores, count = np.sort(scores), len(scores)
    if count < ENOUGH:
        return np.full(len(CONFIDENCES), np.nan)
    # a score of one more case is below the i-th of them in i of count + 1 cases
    place = np.ceil(np.array(CONFIDENCES) * (count + 1)).astype(int) - 1
    return scores[np.minimum(place, count - 1)]


def worth(surrogate: Surrogate, apart: Apart, *, confidence: float = 0.9) -> dict[str, Any]:
    """Return what given numbers and intervals are worth on rows not learned from, for JSON.

    Errors of curves are parts of the pull-off force, the others parts of the number itself.
    """
    assert surrogate.trust is not None, "intervals are measured first"
    widths = np.column_stack(surrogate.trust.widths(apart.told, confidence))
    given = given_of(surrogate.trust, apart)
    answer: dict[str, Any] = {"rows": len(apart.told)}
    for i, name in enumerate(OF):
        known = np.isfinite(apart.error[:, i]) & given[:, i]
        log, width = np.abs(apart.error[known, i]), widths[known, i]
        part, half = (log, width) if name == "curve" else (10**log - 1, 10**width - 1)
        answer[name] = {
            "given": float(np.mean(given[:, i])),
            "mse_log10": None if name == "curve" else float(np.mean(log**2)),
            "median": float(np.median(part)),
            "90 %": float(np.quantile(part, 0.9)),
            "95 %": float(np.quantile(part, 0.95)),
            "99 %": float(np.quantile(part, 0.99)),
            "largest": float(part.max()),
            "cover": float(np.mean(log <= width)),
            "half width": float(np.median(half)),
            "worst, half widths": float(np.max(log / width)),
        }
    return answer
