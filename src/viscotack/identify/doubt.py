"""What a material that is not known exactly does to pull-off forces, at all speeds together.

A passport keeps solids that its measurement allows as well. Each gives its forces; their scatter is
a covariance of ln(force) over the speeds, of few directions: a stiffer solid raises them all, a
slower one those of one flank. It is found at one interface near the best, where it hardly changes
with the interface, and joins the noise of the forces in the fit and in a forecast.
"""

from collections.abc import Sequence
from dataclasses import fields, replace
from math import inf, log
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.materials import Passport

from .forward import Forward, Growth

_DRAWN = 24
_RADII = 40  # of a curve: solids are compared with each other
# Speeds a factor of e apart err together by exp(-1/2.3): a theory is off by decades.
_TOGETHER = log(10.0)


def allowed(passport: Passport) -> tuple[Any, ...]:
    """Return solids that the measurement behind a passport allows as well.

    Those it keeps; else, of one written by hand, solids drawn from the intervals of its constants,
    each alone, which is more than the measurement allows. None where it says nothing.
    """
    if passport.allowed or passport.evidence is None:
        return passport.allowed
    known = {field.name for field in fields(passport.material)}
    quantile = NormalDist().inv_cdf((1 + passport.evidence.level) / 2)
    widths = {
        name: _width(getattr(passport.material, name), low, high) / quantile
        for name, low, high in passport.evidence.intervals
        if name in known
    }
    widths = {name: width for name, width in widths.items() if width > 0}
    if not widths:
        return ()
    rng = np.random.default_rng(20)
    solids = []
    while len(solids) < _DRAWN:
        drawn = {
            name: getattr(passport.material, name) * float(np.exp(width * rng.standard_normal()))
            for name, width in widths.items()
        }
        try:
            solids.append(replace(passport.material, **drawn))
        except InputError:  # softer at once than after long, or an exponent out of its range
            continue
    return tuple(solids)


def _width(value: float, low: float, high: float) -> float:
    """Return the half-width of an interval of ln(value), of the sides that are bounded."""
    sides = [log(value / low)] if low > 0 else []
    sides += [log(high / value)] if high < inf else []
    return float(np.mean(sides)) if sides else 0.0


def log_forces(
    known: Forward,
    solids: Sequence[Any],
    work: float,
    gap: float,
    speed: Array,
    preload: Array,
    growth: Growth | None = None,
) -> Array:
    """Return ln of the pull-off forces of solids beside a known one, shape (solids, speeds)."""
    pulled = (
        known.beside(solid).pulled(work, gap, speed, preload, _RADII, growth) for solid in solids
    )
    return np.log([one.force for one in pulled])


def covariance(rows: Array) -> Array:
    """Return the covariance of ln(force) over the speeds of rows of solids."""
    away = rows - rows.mean(axis=0)
    return away.T @ away / (len(rows) - 1)


def theory_covariance(speed: Array, theory: float) -> Array:
    """Return that of a theory with a relative standard error: together where speeds are near."""
    apart = np.abs(np.subtract.outer(np.log(speed), np.log(speed)))
    return theory**2 * np.exp(-apart / _TOGETHER)
