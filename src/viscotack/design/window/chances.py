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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import exp, inf, sqrt
from statistics import NormalDist
from typing import Annotated, Any

import numpy as np

from viscotack.cards import Quantity
from viscotack.errors import InputError
from viscotack.model.problem import Problem
from viscotack.model.protocol import AtForce
from viscotack.simulate.in_series import SeriesOpening, opening_by_cracks

from .opening import check_pair, posed
from .picking import DONOR, RECEIVER

# Tolerance of a critical work, relative, and standard deviations to which it is searched.
_CLOSE, _FAR = 2e-3, 4.0
# Part of a standard deviation by which work and preload are moved for the slopes.
_PART = 0.5
# Largest slope of the critical work that is expected, for the range of the search.
_STEEP = 1.5


@dataclass(frozen=True)
class ContactScatter:
    """Relative standard deviations of the works of two contacts in series and of the preload.

    Parameters
    ----------
    first, second : float
        Of the works of adhesion, from 0 to 0.5.
    preload : float
        Of the preload, from 0 to 0.5.

    Examples
    --------
    >>> ContactScatter(first=0.1).preload
    0.0
    """

    first: float = 0.0
    second: float = 0.0
    preload: float = 0.0

    def __post_init__(self) -> None:
        deviations = (self.first, self.second, self.preload)
        if not all(0 <= x <= 0.5 for x in deviations) or not any(deviations):
            raise InputError(
                "relative standard deviations of works and preload must lie between 0 and 0.5, and "
                f"one of them above 0, got {deviations}"
            )


@dataclass(frozen=True)
class OpeningChance:
    """Probability that the first of two contacts in series opens.

    Attributes
    ----------
    first : float
        Probability that the first contact opens.
    interval : tuple of float
        The same with the bands of the strengths of both contacts.
    critical_work : float
        Factor on the work of the first contact above which the second opens; 0 or inf if it lies
        outside the scatter.
    """

    first: float
    interval: tuple[float, float]
    critical_work: float

    @property
    def reverse(self) -> tuple[float, tuple[float, float]]:
        """Probability that the second contact opens, with its interval."""
        return 1 - self.first, (1 - self.interval[1], 1 - self.interval[0])


def opening_chance(first: Problem, second: Problem, scatter: ContactScatter) -> OpeningChance:
    """Return the probability that the first of two contacts in series opens, by critical works.

    Parameters
    ----------
    first, second : Problem
        Both contacts, as for :func:`viscotack.which_opens`.
    scatter : ContactScatter
        Scatter of works and preload.

    Raises
    ------
    OutOfRange
        If steady cracks do not cover a contact.
    ValueError
        As for :func:`viscotack.which_opens`.
    """
    check_pair(first, second)
    opens = partial(_opens, first, second)
    preload = scatter.preload
    reach = _FAR * sqrt(scatter.first**2 + _STEEP**2 * scatter.second**2 + preload**2)
    middle = opens(0.0, 0.0, 0.0)
    center = _critical(opens, reach)
    if center in (-inf, inf):
        chance = float(center > 0)
        return OpeningChance(chance, (chance, chance), exp(center) if center < 0 else inf)
    variance = scatter.first**2
    for place, deviation in ((0, scatter.second), (1, preload)):
        if deviation > 0:
            step = _PART * deviation
            ends = [_critical(opens, reach, **{"yp"[place]: sign * step}) for sign in (-1.0, 1.0)]
            known = [each if np.isfinite(each) else center for each in ends]
            variance += ((known[1] - known[0]) / (2 * step) * deviation) ** 2
    band = sum(middle.bands or ())
    at = [
        center / sqrt(variance),
        (center - band) / sqrt(variance),
        (center + band) / sqrt(variance),
    ]
    chance, low, high = (NormalDist().cdf(z) for z in at)
    return OpeningChance(chance, (low, high), exp(center))


_Share = Annotated[float, Quantity("1", "s", "relative standard deviation", least=0, example="0.1")]


@dataclass(frozen=True)
class WindowScatter:
    """Relative standard deviations of the works of stamp, donor and receiver, and of the preload.

    Examples
    --------
    >>> WindowScatter(stamp=0.1).of("donor")
    ContactScatter(first=0.0, second=0.1, preload=0.0)
    """

    stamp: _Share = 0.0
    donor: _Share = 0.0
    receiver: _Share = 0.0
    preload: _Share = 0.0

    def of(self, base: str) -> ContactScatter:
        """Return the scatter of the pair of a base, "donor" or "receiver", and the stamp."""
        return ContactScatter(getattr(self, base), self.stamp, self.preload)


@dataclass(frozen=True)
class CellYield:
    """Yield of one speed and preload of a map.

    Attributes
    ----------
    speed, preload : float
        Speed of the drive [m/s] and common force of the relaxed start [N].
    pick, print : float or None
        Probability that the stamp picks from the donor, and that it prints on the receiver; None
        without a donor or a receiver, or if steady cracks do not cover the contacts.
    pick_interval, print_interval : tuple of float, or None
        The same with the bands of the strengths.
    why : str
        Reason for None.
    """

    speed: float
    preload: float
    pick: float | None
    pick_interval: tuple[float, float] | None
    print: float | None
    print_interval: tuple[float, float] | None
    why: str

    @property
    def transfer(self) -> float | None:
        """Probability of both, of independent contacts; None if one is unknown."""
        return None if self.pick is None or self.print is None else self.pick * self.print


def window_yield(
    stamp: Problem,
    *,
    donor: Problem | None = None,
    receiver: Problem | None = None,
    speeds: Sequence[float],
    preloads: Sequence[float],
    stiffness: float | None = None,
    scatter: WindowScatter,
    progress: Callable[[float], None] = lambda share: None,
) -> tuple[CellYield, ...]:
    """Return the probabilities to pick and to print at speeds and preloads.

    Parameters
    ----------
    stamp, donor, receiver, speeds, preloads, stiffness
        As for :func:`viscotack.window`.
    scatter : WindowScatter
        Scatter of works and preload.
    progress : callable
        Called with the completed share.

    Returns
    -------
    tuple of CellYield
        All speeds of the first preload, then of the next.
    """
    places = [(F, V) for F in preloads for V in speeds]
    cells = []
    for number, (preload, speed) in enumerate(places):
        how = {"preload": preload, "speed": speed, "stiffness": stiffness}
        chances, reasons = {}, []
        for name, base in ((DONOR, donor), (RECEIVER, receiver)):
            if base is None:
                continue
            try:
                pair = posed(base, **how), posed(stamp, **how)
                chances[name] = opening_chance(*pair, scatter.of(name))
            except InputError as reason:
                reasons.append(f"{name}: {reason}")
        pick, receives = chances.get(DONOR), chances.get(RECEIVER)
        prints = None if receives is None else receives.reverse
        cells.append(
            CellYield(
                speed,
                preload,
                None if pick is None else pick.first,
                None if pick is None else pick.interval,
                None if prints is None else prints[0],
                None if prints is None else prints[1],
                "; ".join(reasons),
            )
        )
        progress((number + 1) / len(places))
    return tuple(cells)


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
