"""Propagate the uncertainty of a material to pull-off forces, as a covariance over all speeds.

A passport contains solids sampled from the uncertainty of its measurement. Each gives pull-off
forces; their scatter is a low-rank covariance of ln(force) over the speeds: a stiffer solid
raises all forces, a slower one those of one flank. It is computed at one interface near the best
one, because it hardly depends on the interface, and is added to the noise in fit and prediction.
The uncertainty of the temperature of the tests, by which all times of the solid are multiplied, is
added in the same way.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.lab.grouping import GAP
from viscotack.materials.conversion import slowed

from .forward import Forward, Growth

# Part of the variance between speeds that is a power of the speed, where there is a trend.
TREND = 0.8
_RADII = 40  # points of a curve; sufficient for differences between solids
# Errors of the theory at speeds a factor of e apart correlate by exp(-1/2.3).
_TOGETHER = log(10.0)


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


def trend_covariance(speed: Array, measured: Array, between: float) -> Array:
    """Return the covariance of a relative error that follows a power of the speed.

    It is the part TREND of a variance between speeds, in the mean over the measured ones. Beyond
    them it grows, and the power may change by twice itself.
    """
    logs, wanted = np.log(measured), np.log(speed)
    at = between * (wanted - logs.mean()) / logs.std()
    beyond = np.abs(wanted - np.clip(wanted, logs.min(), logs.max()))
    change = 2 * between * beyond / logs.std()
    return TREND * np.outer(at, at) + np.diag(change**2)


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
