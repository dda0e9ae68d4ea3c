r"""Unloading curve of a prediction, consistent with its force, work and start.

A curve has two parts. From zero force (or from a start in tension) to the pull-off it is a shape g
from 0 to 1 over the fractions :math:`t = 1 - (1 - u)^2` of that travel X, u at sixteen even steps,

.. math:: -F = p + (P - p) g(t) , \qquad W = X \left[ p + (P - p) \int_0^1 g \, dt \right] ,

where p is the tension of the start, 0 for a compressed one. P and W are the predicted pull-off
force and work, which determine X: the smallest force is the predicted one, and the area the
predicted work. Simpson's 3/8 rule in u gives the integral; the trapezoidal rule over the points
would be about 0.3 % lower. From a compressed start to zero force the shape
is :math:`F/F_0` over eight such fractions of the travel :math:`T_0`. A separate network predicts
:math:`T_0 \hat a_0 / F_0`, the inverse of a modulus, because a small relative error of this long
travel is a large fraction of the short travel in tension.
"""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.result.curve import POINTS, PRESSED, TENSILE, gathered

# Outputs of a network per row: inner points of both shapes, and all radii except the first.
SHAPE = slice(0, TENSILE - 2)
PRESSING = slice(SHAPE.stop, SHAPE.stop + PRESSED - 1)
RADII = slice(PRESSING.stop, PRESSING.stop + POINTS - 1)
OUTPUTS = RADII.stop


def _weights() -> Array:
    """Return the weights of the shape's values in its integral over t."""
    rule = np.tile([2.0, 3.0, 3.0], TENSILE // 3 + 1)[:TENSILE]
    rule[[0, -1]] = 1.0
    u = np.linspace(0.0, 1.0, TENSILE)
    # dt = 2 (1 - u) du
    return rule * 3 / 8 / (TENSILE - 1) * 2 * (1 - u)


def _refining() -> Array:
    """Return the matrix from values at 16 even steps to those at 24, by cubic interpolation."""
    new = np.linspace(0.0, 1.0, POINTS) * (TENSILE - 1)
    first = np.clip(np.floor(new).astype(int) - 1, 0, TENSILE - 4)
    matrix = np.zeros((POINTS, TENSILE))
    for row, (x, i) in enumerate(zip(new, first, strict=True)):
        near = np.arange(i, i + 4)
        for j in near:
            others = near[near != j]
            matrix[row, j] = np.prod((x - others) / (j - others))
    return matrix


AREA, REFINE = _weights(), _refining()


@dataclass(frozen=True, eq=False)
class Curves:
    """Unloading curves from the start to the pull-off, dimensionless, with 24 points each.

    For a compressed start eight points lead to zero force and sixteen from there to the pull-off;
    for a start in tension all 24 do. The smallest force is the pull-off force, and the area below
    zero the work.

    Attributes
    ----------
    depth : ndarray, shape (n, 24)
        [h0], positive into the solid.
    force : ndarray, shape (n, 24)
        [1.5 pi R dg0], compression positive.
    contact_radius : ndarray, shape (n, 24)
        [(pi R^2 dg0/E0*)^(1/3)]
    """

    depth: Array
    force: Array
    contact_radius: Array


def curves(
    said: Array,
    *,
    give: Array,
    preload: Array,
    force: Array,
    radius: Array,
    pull_off: Array,
    work: Array,
) -> Curves:
    """Compute the unloading curves from network outputs, start, pull-off force and work.

    Parameters
    ----------
    said : ndarray, shape (n, OUTPUTS)
        Network outputs in the order of this module's slices.
    give : ndarray, shape (n,)
        (Travel to zero force) * radius / force of the start; ignored for starts in tension.
    preload, force, radius : ndarray, shape (n,)
        Depth, force and contact radius of the relaxed start.
    pull_off, work : ndarray, shape (n,)
        Pull-off force and work to pull-off.
    """
    n = len(said)
    shape = np.column_stack([np.zeros(n), np.clip(said[:, SHAPE], 0.0, 1.0), np.ones(n)])
    shape = np.maximum.accumulate(shape, axis=1)
    pulled = np.minimum(np.maximum(-force, 0.0), 0.999 * pull_off)
    rise = pull_off - pulled
    travel = work / (pulled + rise * (shape @ AREA))
    pressed = (force > 0)[:, None]

    fine = np.minimum(shape @ REFINE.T, 1.0)
    fine = np.maximum.accumulate(fine, axis=1)
    tension_only = -(pulled[:, None] + rise[:, None] * fine)
    descent = np.clip(said[:, PRESSING], 0.0, 1.0)
    descent = np.minimum.accumulate(np.column_stack([np.ones(n), descent]), axis=1)
    both = np.hstack([force[:, None] * descent, -pull_off[:, None] * shape])

    to_zero = np.where(force > 0, give * np.abs(force) / radius, 0.0)
    early = to_zero[:, None] * gathered(PRESSED + 1)[:-1]
    late = to_zero[:, None] + travel[:, None] * gathered(TENSILE)
    moved = np.where(pressed, np.hstack([early, late]), travel[:, None] * gathered(POINTS))

    left = np.clip(said[:, RADII], 0.0, None)
    radii = np.column_stack([np.ones(n), left])
    # in tension only the radii of the sixteen points of the second part are predicted
    tensile = np.column_stack([np.ones(n), left[:, PRESSED:]]) @ REFINE.T
    radii = np.where(pressed, radii, np.maximum(tensile, 0.0))
    return Curves(
        depth=preload[:, None] - moved,
        force=np.where(pressed, both, tension_only),
        contact_radius=radius[:, None] * radii,
    )
