r"""A little beyond what was learned: two ends at which physics says how the answer goes on.

**Faster than 1e10 h0/tau0.** The force goes on from where it is there to that of a solid that does
not relax at all, the fast limit of the same start, which is learned as well. What is faster lies
between the two; for exponents above about 0.5 they are the same within the interval.

**Tabor numbers below 0.01.** Adhesion deforms the solid by mu gaps or less, and what the start's
depth has made of the surface hardly depends on it: at one depth, rate and solid the force over its
slow limit f(mu) is about that of 0.01, within some percent a decade. The work is not, for it has
half of a gap's travel in it that a stiffer contact has not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from viscotack.theory import lennard_jones

if TYPE_CHECKING:
    from viscotack.surrogate.model import Answers, Intervals, Surrogate

Array = npt.NDArray[np.float64]

# How far it goes on: simulations were compared so far (`benchmarks/beyond.py`).
LEAST_TABOR, MOST_RATE = 1e-3, 1e16
# What is added to half an interval of log10 for a Tabor number smaller by a decade.
_WIDER = 2.5e-2


@dataclass(frozen=True, eq=False)
class Beyond:
    """Answers beyond what was learned, as those inside.

    Attributes
    ----------
    groups : ndarray, shape (n, 5)
        At the end of the range that was learned from.
    answers : Answers
    intervals : Intervals
    with_work : bool
        Whether the work is known.
    why : str
        On what ground.
    """

    groups: Array
    answers: Answers
    intervals: Intervals
    with_work: bool
    why: str


def beyond(learned: Surrogate, groups: Array, confidence: float) -> Beyond | None:
    """Return the answer to one row of groups that is out at no other end than these two.

    Returns
    -------
    Beyond or None
        None where the row is out elsewhere, or further.
    """
    from viscotack.surrogate import physics

    mu, rate = groups[0, physics.TABOR], groups[0, physics.RATE]
    low, high = learned.limits["tabor"][0], learned.limits["rate"][1]
    at_end = groups.copy()
    at_end[0, physics.TABOR], at_end[0, physics.RATE] = max(mu, low), min(rate, high)
    if not (LEAST_TABOR <= mu and rate <= MOST_RATE and learned.inside(at_end).all()):
        return None
    said = learned.evaluate(at_end)
    held = learned.intervals(at_end, said, confidence=confidence)
    why = []
    if rate > high:
        glassy = at_end.copy()
        glassy[0, physics.EXPONENT] = learned.limits["exponent"][1]
        most = learned.evaluate(glassy)
        said, held = _between(
            (said, held), (most, learned.intervals(glassy, most, confidence=confidence))
        )
        why.append(f"a rate beyond {high:g} lies between that and the fast limit of the start")
    if mu < low:
        factor = float(lennard_jones.pull_off_ratio(mu) / lennard_jones.pull_off_ratio(low))
        said, held = _times(said, held, factor, _WIDER * float(np.log10(low / mu)))
        why.append(f"below a Tabor number of {low:g} adhesion hardly changes the surface")
    return Beyond(at_end, said, held, mu >= low, "; ".join(why))


def _between(
    one: tuple[Answers, Intervals], other: tuple[Answers, Intervals]
) -> tuple[Answers, Intervals]:
    """Return what lies between two answers, and the interval that holds both of theirs."""
    (a, held_a), (b, held_b) = one, other

    def hull(x: Array, y: Array) -> Array:
        return np.column_stack([np.minimum(x, y)[:, 0], np.maximum(x, y)[:, 1]])

    return (
        replace(
            a,
            pull_off_force=np.sqrt(a.pull_off_force * b.pull_off_force),
            work_to_pull_off=np.sqrt(a.work_to_pull_off * b.work_to_pull_off),
        ),
        replace(
            held_a,
            pull_off_force=hull(held_a.pull_off_force, held_b.pull_off_force),
            work_to_pull_off=hull(held_a.work_to_pull_off, held_b.work_to_pull_off),
            curve=np.maximum(held_a.curve, held_b.curve),
        ),
    )


def _times(
    said: Answers, held: Intervals, factor: float, wider: float
) -> tuple[Answers, Intervals]:
    """Return a force and its interval times a factor, the interval wider by so much of log10."""
    ends = np.array([10**-wider, 10**wider])
    return (
        replace(said, pull_off_force=said.pull_off_force * factor),
        replace(held, pull_off_force=held.pull_off_force * factor * ends),
    )
