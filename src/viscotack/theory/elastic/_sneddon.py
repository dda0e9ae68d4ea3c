"""Integrals of the slope of a profile, by Gauss-Legendre nodes in the angle (Sneddon)."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.theory._checks import Values

# Exact to round-off for smooth profiles.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
ANGLE, WEIGHT = np.pi / 4 * (_NODES + 1), np.pi / 4 * _WEIGHTS


class Flank(Protocol):
    """A profile that says how steep it is."""

    def gap(self, position: Values) -> Array: ...  # noqa: D102
    def flank(self, position: Values) -> Array: ...  # noqa: D102


def mean_slope(shape: Flank, a: npt.NDArray, weight: Array) -> npt.NDArray:
    """Return the integral of the slope over the angle, with a weight."""
    return (np.asarray(shape.flank(np.multiply.outer(a, np.sin(ANGLE)))) * weight) @ WEIGHT


def half_space_depth(a: npt.NDArray, shape: Flank) -> npt.NDArray:
    """Return the depth [m] of a contact of this radius [m] on a half-space without adhesion."""
    return a * mean_slope(shape, a, np.ones_like(ANGLE))
