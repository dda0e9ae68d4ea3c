"""Integrals of the slope of a profile, by Gauss-Legendre nodes in the angle (Sneddon)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.model.geometry import Shape, detail
from viscotack.model.geometry.gauss import gauss

# Exact to round-off for smooth profiles.
_NODES = 64
# Details of a profile per Gauss panel, and largest number of panels.
_DETAILS, _MOST_PANELS = 1.0, 64
# Slopes that are looked up at a time.
_AT_ONCE = 1_000_000


def mean_slope(shape: Shape, a: npt.NDArray, power: int) -> npt.NDArray:
    """Return the integral of the slope over the angle, with a power of its sine."""
    angle, weight = angles(shape, float(np.max(a, initial=0.0)))
    sine = np.sin(angle)
    weight = weight * sine**power
    radii = np.ravel(a)
    parts = np.array_split(radii, -(-radii.size * sine.size // _AT_ONCE) or 1)
    means = [np.asarray(shape.flank(np.multiply.outer(part, sine))) @ weight for part in parts]
    return np.reshape(np.concatenate(means), np.shape(a))


def half_space_depth(a: npt.NDArray, shape: Shape) -> npt.NDArray:
    """Return the depth [m] of a contact of this radius [m] on a half-space without adhesion."""
    return a * mean_slope(shape, a, 0)


def angles(shape: Shape, radius: float) -> tuple[Array, Array]:
    """Return angles and weights for a contact of this radius at most."""
    panels = np.ceil(radius / (_DETAILS * detail(shape)))
    return _rule(int(np.clip(panels, 1, _MOST_PANELS)))


@lru_cache(maxsize=_MOST_PANELS)
def _rule(panels: int) -> tuple[Array, Array]:
    """Return the nodes and the weights of `panels` equal panels from 0 to pi/2."""
    return gauss(np.linspace(0.0, np.pi / 2, panels + 1), _NODES)
