r"""Probability that a contact of two in series opens, if works and preload scatter.

Works of adhesion and the preload are log-normal with relative standard deviations. With the
logarithms x of the work of the first contact, y of that of the second and p of the preload,
relative to their means, the first contact opens below a critical work :math:`x < c(y, p)`. To first
order :math:`c = c_0 + \alpha y + \beta p`, so

.. math:: P = \Phi\!\left(\frac{c_0}{\sqrt{\sigma_1^2 + \alpha^2 \sigma_2^2 +
          \beta^2 \sigma_p^2}}\right).

The critical work comes from bisection with steady cracks in series. Two elastic spheres of equal
range open by their pull-off forces, which are proportional to the works, so there
:math:`\alpha = 1` and :math:`\beta = 0`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import exp, inf, isinf, sqrt
from statistics import NormalDist
from typing import Annotated, Any

from viscotack.cards import Quantity, conform
from viscotack.model.problem import Problem
from viscotack.model.protocol import AtForce
from viscotack.simulate.in_series import SeriesOpening, opening_by_cracks

from .opening import check_pair

# Tolerance of a critical work, relative, and standard deviations to which it is searched.
_CLOSE, _FAR = 2e-3, 4.0
# Part of a standard deviation by which work and preload are moved for the slopes.
_PART = 0.5
# Largest slope of the critical work that is expected, for the range of the search.
_STEEP = 1.5
_Share = Annotated[
    float, Quantity("1", "s", "relative standard deviation", least=0, most=0.5, example="0.1")
]


@dataclass(frozen=True)
class WindowScatter:
    """Relative standard deviations of the works of stamp, donor and receiver, and of the preload.

    Each lies between 0 and 0.5.
    """

    stamp: _Share = 0.0
    donor: _Share = 0.0
    receiver: _Share = 0.0
    preload: _Share = 0.0

    def __post_init__(self) -> None:
        conform(self)


@dataclass(frozen=True)
class Chance:
    """Probability, and its interval by the bands of the strengths of both contacts."""

    value: float
    low: float
    high: float

    @property
    def reverse(self) -> Chance:
        """Probability of the opposite."""
        return Chance(1 - self.value, 1 - self.high, 1 - self.low)


def opening_chance(
    first: Problem, second: Problem, *, works: tuple[float, float], preload: float = 0.0
) -> Chance:
    """Return the probability that the first of two contacts in series opens, by critical works.

    Parameters
    ----------
    first, second : Problem
        Both contacts, as for :func:`viscotack.which_opens`.
    works, preload : float
        Relative standard deviations of both works of adhesion and of the preload.

    Raises
    ------
    OutOfRange
        If steady cracks do not cover a contact.
    ValueError
        As for :func:`viscotack.which_opens`.
    """
    check_pair(first, second)
    opens = partial(_opens, first, second)
    reach = _FAR * sqrt(works[0] ** 2 + _STEEP**2 * works[1] ** 2 + preload**2)
    middle = opens(0.0, 0.0, 0.0)
    center = _critical(opens, reach)
    if isinf(center):
        chance = float(center > 0)
        ends = (chance, chance) if middle.opened is not None else (0.0, 1.0)
        return Chance(chance, *ends)
    variance = works[0] ** 2
    for name, deviation in (("y", works[1]), ("p", preload)):
        if deviation > 0:
            step = _PART * deviation
            ends = [_critical(opens, reach, **{name: sign * step}) for sign in (-1.0, 1.0)]
            low, high = (center if isinf(each) else each for each in ends)
            variance += ((high - low) / (2 * step) * deviation) ** 2
    band = sum(middle.bands or ())
    chances = (NormalDist().cdf((center + off) / sqrt(variance)) for off in (0.0, -band, band))
    return Chance(*chances)


def _critical(opens: Any, reach: float, y: float = 0.0, p: float = 0.0) -> float:
    """Return ln of the critical work of the first contact; infinite beyond the reach."""
    low, high = -reach, reach
    if opens(low, y, p).nominal != 0:
        return -inf
    if opens(high, y, p).nominal == 0:
        return inf
    while high - low > _CLOSE:
        middle = (low + high) / 2
        low, high = (middle, high) if opens(middle, y, p).nominal == 0 else (low, middle)
    return (low + high) / 2


def _opens(first: Problem, second: Problem, x: float, y: float, p: float) -> SeriesOpening:
    """Return which contact opens with factors exp(x) and exp(y) on the works, exp(p) on preload."""
    return opening_by_cracks(_moved(first, x, p), _moved(second, y, p))


def _moved(problem: Problem, work: float, preload: float) -> Problem:
    law, test = problem.traction, problem.protocol
    start = test.start
    assert isinstance(start, AtForce)
    changed: Any = law
    if work != 0:
        changed = replace(changed, work_of_adhesion=exp(work) * law.work_of_adhesion)
    force = AtForce(exp(preload) * start.force) if preload != 0 else start
    return replace(problem, traction=changed, protocol=replace(test, start=force))
