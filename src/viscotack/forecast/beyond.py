r"""A little beyond what was learned: three ends at which physics says how the answer goes on.

**Faster than 1e10 h0/tau0.** The force goes on from where it is there to that of a solid that does
not relax at all, the fast limit of the same start, which is learned as well. What is faster lies
between the two; for exponents above about 0.5 they are the same within the interval.

**Tabor numbers below 0.01.** Adhesion deforms the solid by mu gaps or less, and what the start's
depth has made of the surface hardly depends on it: at one depth, rate and solid the force over its
slow limit f(mu) is about that of 0.01, within some percent a decade. The work is not, for it has
half of a gap's travel in it that a stiffer contact has not.

**Modulus ratios below 1e-4.** A crack that feels the compliance c of its solid, over the relaxed
one, takes an energy of about 1/c; c is k and what has crept, g. So the force goes as 1/(k + g)
until k is small beside g, where it stays, and how fast it goes with k at the end of the range,
:math:`S = -d \ln P/d \ln k = k_0/(k_0 + g)`, says how far it goes on:

.. math:: \ln \frac{P(k)}{P(k_0)} = -\ln \left[ 1 - S \left(1 - \frac{k}{k_0}\right) \right] .

Work that grows goes on with the force. Work that falls does so with what the solid still gives at
once, in proportion to k.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.theory import lennard_jones

if TYPE_CHECKING:
    from viscotack.surrogate.answers import Answers, Intervals
    from viscotack.surrogate.model import Surrogate


# How far it goes on: simulations were compared so far (`benchmarks/beyond.py`).
LEAST_TABOR, MOST_RATE, LEAST_RATIO = 1e-3, 1e16, 1e-6
# What is added to half an interval of log10 for a Tabor number smaller by a decade.
_WIDER = 2.5e-2
# The same for a modulus ratio below the range: for slopes of force and work at the end of networks,
# and so much of the way that these go on.
_SLOPE, _PART = np.array([1.5e-3, 4e-3]), 0.25
# Of the slope by the modulus ratio: force in proportion to 1/k.
_STEEPEST = 1 - 1e-6


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
    """Return the answer to one row of groups that is out at no other end than these three.

    Returns
    -------
    Beyond or None
        None where the row is out elsewhere, or further.
    """
    from viscotack.surrogate import physics

    mu, rate = groups[0, physics.TABOR], groups[0, physics.RATE]
    low, high = learned.limits["tabor"][0], learned.limits["rate"][1]
    k, least = groups[0, physics.MODULUS_RATIO], learned.limits["modulus_ratio"][0]
    at_end = groups.copy()
    at_end[0, physics.TABOR], at_end[0, physics.RATE] = max(mu, low), min(rate, high)
    at_end[0, physics.MODULUS_RATIO] = max(k, least)
    near = LEAST_TABOR <= mu and rate <= MOST_RATE and k >= LEAST_RATIO
    if not (near and learned.inside(at_end).all()) or (k < least and (mu < low or rate > high)):
        return None
    tests = learned.tests(at_end)
    said = learned.evaluate(tests)
    held = learned.intervals(tests, said, confidence=confidence)
    why = []
    if rate > high:
        rows = at_end.copy()
        rows[0, physics.EXPONENT] = learned.limits["exponent"][1]
        glassy = learned.tests(rows)
        most = learned.evaluate(glassy)
        said, held = _between(
            (said, held), (most, learned.intervals(glassy, most, confidence=confidence))
        )
        why.append(f"a rate beyond {high:g} lies between that and the fast limit of the start")
    if mu < low:
        factor = float(lennard_jones.pull_off_ratio(mu) / lennard_jones.pull_off_ratio(low))
        wider = _WIDER * float(np.log10(low / mu))
        said, held = _times(said, held, (factor, 1.0), (wider, 0.0))
        why.append(f"below a Tabor number of {low:g} adhesion hardly changes the surface")
    if k < least:
        ways = _with_ratio(learned, at_end, float(k / least))
        said, held = _times(said, held, np.exp(ways), _SLOPE + _PART * np.abs(ways) / np.log(10))
        why.append(f"a modulus ratio below {least:g} goes on by how the force depends on it there")
    return Beyond(at_end, said, held, mu >= low, "; ".join(why))


def _with_ratio(learned: Surrogate, at_end: Array, ratio: float) -> Array:
    """Return ln of how much larger force and work are for a modulus ratio so many times smaller."""
    from viscotack.surrogate.physics import MODULUS_RATIO

    force, work = (-float(of[0, MODULUS_RATIO]) for of in learned.slopes(at_end))
    steep = float(np.clip(force, 1e-9, _STEEPEST))
    way = -np.log1p(-steep * (1 - ratio))
    return np.array([way, way * min(work / steep, 1.0) if work > 0 else work * (1 - ratio)])


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
            travel=hull(held_a.travel, held_b.travel),
        ),
    )


def _times(
    said: Answers, held: Intervals, factors: npt.ArrayLike, wider: npt.ArrayLike
) -> tuple[Answers, Intervals]:
    """Return force and work times a factor each, their intervals wider by so much of log10."""
    (force, work), (of_force, of_work) = np.asarray(factors), np.asarray(wider)
    side = np.array([-1.0, 1.0])
    return (
        replace(
            said,
            pull_off_force=said.pull_off_force * force,
            work_to_pull_off=said.work_to_pull_off * work,
        ),
        replace(
            held,
            pull_off_force=held.pull_off_force * force * 10 ** (of_force * side),
            work_to_pull_off=held.work_to_pull_off * work * 10 ** (of_work * side),
        ),
    )
