"""Propagate the uncertainty of a material to pull-off forces, as a covariance over all speeds.

A passport contains solids sampled from the uncertainty of its measurement. Each gives pull-off
forces; their scatter is a low-rank covariance of ln(force) over the speeds: a stiffer solid
raises all forces, a slower one those of one flank. It is computed at one interface near the best
one, because it hardly depends on the interface, and is added to the noise in fit and prediction.
The uncertainty of the temperature of the tests, by which all times of the solid are multiplied, is
added in the same way.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from math import exp, inf, log
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.grouping import GAP
from viscotack.materials import Passport
from viscotack.materials.conversion import slowed

from .forward import Forward, Growth

_DRAWN = 24
_RADII = 40  # points of a curve; sufficient for differences between solids
# Errors of the theory at speeds a factor of e apart correlate by exp(-1/2.3).
_TOGETHER = log(10.0)


def allowed(passport: Passport) -> tuple[Any, ...]:
    """Return solids sampled from the uncertainty of a passport's material.

    These are the solids stored in the passport. For a passport without them, each constant is
    sampled independently from its interval, which overestimates the uncertainty. Empty if unknown.
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
        except InputError:  # glassy softer than rubbery modulus, or an exponent out of range
            continue
    return tuple(solids)


def _width(value: float, low: float, high: float) -> float:
    """Return the half-width of an interval of ln(value), from its bounded sides."""
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
    """Return ln of the pull-off forces of neighbouring solids, shape (solids, speeds)."""
    pulled = (
        known.beside(solid).pulled(work, gap, speed, preload, _RADII, growth) for solid in solids
    )
    return np.log([one.force for one in pulled])


def covariance(rows: Array) -> Array:
    """Return the covariance of ln(force) over the speeds, from rows of solids."""
    away = rows - rows.mean(axis=0)
    return away.T @ away / (len(rows) - 1)


def shift_error(passport: Passport, uncertainty: float, temperature: float | None = None) -> float:
    """Return the relative standard error of the times of a solid by its temperature.

    Parameters
    ----------
    passport : Passport
        Solid with its shift law.
    uncertainty : float
        Standard uncertainty of the temperature of the tests [K].
    temperature : float, optional
        This temperature [K]; by default that of the passport.

    Returns
    -------
    float
        In ln of the times; 0 without a shift law.
    """
    law, middle = passport.shift, passport.temperature if temperature is None else temperature
    if law is None or middle is None or not uncertainty:
        return 0.0
    found = {middle: float(law.log10_shift(middle))}
    for beside in (middle - uncertainty, middle + uncertainty):
        # a table may end here, or a law have its pole
        with suppress(InputError):
            found[beside] = float(law.log10_shift(beside))
    span = max(found) - min(found)
    decades = found[min(found)] - found[max(found)]
    return abs(decades) / span * uncertainty * log(10.0) if span else 0.0


def temperature_effect(
    known: Forward,
    error: float,
    work: float,
    gap: float,
    speed: Array,
    preload: Array,
    growth: Growth | None = None,
) -> Array:
    """Return the change of ln(force) by a relative error of all times, shape (speeds,)."""
    if not error:
        return np.zeros(speed.size)
    solids = [slowed(known.material, exp(sign * error)) for sign in (1, -1)]
    slow, fast = log_forces(known, solids, work, gap, speed, preload, growth)
    return (slow - fast) / 2


def shift_covariance(
    known: Forward,
    deviation: Array,
    temperature: Array,
    work: float,
    gap: float,
    speed: Array,
    preload: Array,
) -> Array:
    """Return the covariance of ln(force) by the errors of a measured table of shifts.

    Parameters
    ----------
    deviation : ndarray, shape (S,)
        Standard deviation of ln(a_T) at the temperature of each test.
    temperature : ndarray, shape (S,)
        These temperatures [K]; errors at different temperatures are independent.
    """
    if not deviation.any():
        return np.zeros((speed.size, speed.size))
    step = float(deviation.max())
    change = temperature_effect(known, step, work, gap, speed, preload) * deviation / step
    same = np.abs(np.subtract.outer(temperature, temperature)) <= GAP
    return np.outer(change, change) * same


def theory_covariance(speed: Array, theory: float | Array) -> Array:
    """Return the covariance of the theory's relative error, correlated between near speeds.

    The error is one number, or one for each speed.
    """
    apart = np.abs(np.subtract.outer(np.log(speed), np.log(speed)))
    error = np.broadcast_to(theory, speed.shape)
    return np.multiply.outer(error, error) * np.exp(-apart / _TOGETHER)


@dataclass(frozen=True, eq=False)
class ModelError:
    """Relative standard errors of the forces of tests, by theory or by simulation.

    Parameters
    ----------
    theory, simulation : ndarray, shape (S,)
        Error by the tier that gives the force of a test; 0 for the other.
    """

    theory: Array
    simulation: Array

    def covariance(self, speed: Array) -> Array:
        """Return the covariance of the errors; theory and simulation are independent."""
        return theory_covariance(speed, self.theory) + theory_covariance(speed, self.simulation)

    def joined(self, other: "ModelError") -> "ModelError":
        """Return the errors of these tests and of others."""
        return ModelError(
            np.concatenate([self.theory, other.theory]),
            np.concatenate([self.simulation, other.simulation]),
        )
