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

from .. import physics
from ..answers import Answers
from ..model import Surrogate
from ..network import together
from ..physics import Array
from ..trust import CONFIDENCES, OF, Trust, error_inputs
from .fitting import Fit, Task
from .rows import Rows
from .scores import curve_errors, travel_errors
from .shop import Shop

# The part of the errors that a network of their reach is to hold: the far ones decide, for where
# errors are as large as elsewhere in the median their tails may be longer. And smaller errors than
# those of the rows themselves [log10, log10, part of the pull-off force, log10], not worth telling.
REACH, LEAST = 0.98, np.array([5e-5, 1e-4, 3e-4, 1e-4])
# How many times a row counts that was kept apart, in learning how far errors reach.
_WEIGHT = 8.0
# Networks for each half of these rows: one alone errs by chance in places.
_MEMBERS = 2
HOW = Fit(hidden=(24, 24), steps=700, scale=1.0, penalty=3e-5)


@dataclass(frozen=True, eq=False)
class Apart:
    """How far a surrogate is off on some rows.

    Attributes
    ----------
    told : ndarray, shape (n, trust.INPUTS)
        What a network of their reach is told.
    error : ndarray, shape (n, 4)
        Of log10 of force and of work, the largest of the curve in tension over the pull-off force,
        and of log10 of the travel to zero force; that is nan for starts in tension.
    """

    told: Array
    error: Array

    def chosen(self, which: Any) -> "Apart":
        """Return the rows of a mask."""
        return Apart(**{f.name: getattr(self, f.name)[which] for f in fields(self)})


def judged(surrogate: Surrogate, rows: Rows) -> Apart:
    """Return how far a surrogate is off on some rows."""
    said = surrogate.evaluate(rows.groups)
    inputs = error_inputs(physics.scaled(rows.groups), said)
    return Apart(inputs, errors_of(surrogate, rows, said))


def errors_of(asked: Any, rows: Rows, said: Answers) -> Array:
    """Return how far answers and the curves that go with them are off, as :class:`Apart` has it.

    Parameters
    ----------
    asked : Surrogate or PunchSurrogate
        Whose curves they are.
    rows : Rows
        What was simulated.
    said : Answers
        To these rows.
    """
    errors = (
        np.log10(said.pull_off_force / rows.force),
        np.log10(said.work_to_pull_off / rows.work),
        np.nanmax(np.abs(curve_errors(asked, rows, said)), axis=1),
        travel_errors(asked, rows, said),
    )
    return np.column_stack(errors)


def trusted(
    surrogate: Surrogate,
    learned: Apart,
    kept: Sequence[Apart],
    hard: Apart,
    shop: Shop,
    *,
    how: Fit = HOW,
) -> Surrogate:
    """Return a surrogate with intervals.

    Parameters
    ----------
    surrogate : Surrogate
        Whose errors they are.
    learned : Apart
        Of rows that it learned from.
    kept : sequence of Apart
        Of others, a set each for which intervals are to hold.
    hard : Apart
        Of others, that were sought where errors are large: they tell how far errors reach there,
        and nothing of how often.
    shop : Shop
        Where networks are fitted.
    how : Fit
        Of the networks of the reach.
    """
    halves = [[one.chosen(np.arange(len(one.told)) % 2 == half) for one in kept] for half in (0, 1)]
    begun = [
        [shop.fit(reach_task(learned, [*half, hard]), how, seed=seed) for seed in range(_MEMBERS)]
        for half in halves
    ]
    members = [together([one.result() for one in several]) for several in begun]
    of_each = [
        [scored(Trust(one, untested()), some) for some in half]
        for one, half in zip(members, halves[::-1], strict=True)
    ]
    levels = [levels_of(np.concatenate(scores)) for scores in zip(*of_each, strict=True)]
    return replace(surrogate, trust=Trust(together(members), np.max(levels, axis=0)))


def reach_task(learned: Apart, kept: Sequence[Apart], *, weight: float = _WEIGHT) -> Task:
    """Return the task to learn how far errors reach, from rows kept apart by so much more."""
    inputs = np.concatenate([one.told for one in (learned, *kept)])
    error = np.concatenate([one.error for one in (learned, *kept)])
    known = np.isfinite(error)
    target = np.log10(np.maximum(np.where(known, np.abs(error), 1.0), LEAST))
    counts = known.astype(float)
    counts[len(learned.told) :] *= weight
    return Task(inputs, target, counts, quantile=REACH)


def untested() -> Array:
    """Return levels of one, before any case has measured them."""
    return np.ones((len(OF), len(CONFIDENCES)))


def measured(trust: Trust, apart: Apart) -> Trust:
    """Return a trust whose levels hold the wanted shares of some rows.

    Examples
    --------
    >>> from viscotack.surrogate.store import shipped
    >>> from viscotack.surrogate.training.rows import read
    >>> apart = judged(shipped(), read("chosen").chosen(slice(None, 200)))
    >>> levels = measured(shipped().trust, apart).levels
    >>> bool(np.all(np.diff(levels, axis=1) >= 0))
    True
    """
    return replace(trust, levels=levels_of(scored(replace(trust, levels=untested()), apart)))


def scored(trust: Trust, apart: Apart) -> Array:
    """Return errors over how far they usually reach, shape (n, 4); nan where there is none."""
    return np.abs(apart.error) / np.column_stack(trust.widths(apart.told, CONFIDENCES[0]))


def levels_of(scores: Array) -> Array:
    """Return the levels that hold the wanted shares of scores, shape (4, confidences)."""
    return np.array([_level(column[np.isfinite(column)]) for column in scores.T])


def _level(scores: Array) -> Array:
    scores, count = np.sort(scores), len(scores)
    # a score of one more case is below the i-th of them in i of count + 1 cases
    place = np.ceil(np.array(CONFIDENCES) * (count + 1)).astype(int) - 1
    return scores[np.minimum(place, count - 1)]


def covers(trust: Trust, apart: Apart, *, confidence: float = 0.9) -> Array:
    """Return 1.0 where an interval holds, 0.0 where not, and nan where there is none, (n, 4)."""
    widths = np.column_stack(trust.widths(apart.told, confidence))
    held = np.abs(apart.error) <= widths
    return np.where(np.isfinite(apart.error), held, np.nan)
