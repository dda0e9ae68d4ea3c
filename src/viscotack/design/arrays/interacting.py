r"""Elastic interaction of pads through a common base: point loads on a half-space.

A force :math:`F_j` moves the surface of an elastic half-space at a distance r by

.. math:: c_{ij} F_j, \quad c_{ij} = \frac{1}{\pi E^* r_{ij}}

(Boussinesq's solution; Johnson, Contact Mechanics (1985), Eq. 3.22a). The deformation by a pad's
own force is part of its curve, so :math:`c_{ii} = 0`. The correction takes each pad as a point and
the displacement as even over its contact. The forces of
two and seven flat discs at a distance of four radii are those of a direct solution to 1 %, and the
middle one of seven at three radii to 1.6 % (`tests/test_pads_interaction.py`). The tension along an
edge varies with the gradient of the displacement, of second order in radius over distance, which is
not in the correction. Distances below :data:`LEAST_SPACING` radii are refused.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.simulate.curve_family import Curve

# Smallest distance of two pads over the contact radius at the start.
LEAST_SPACING = 4.0
# Steps of the plate over the travel and most of them, iterations of Newton's method and of the flow
# to equilibrium, and their tolerances over the travel.
_STEPS, _MOST_STEPS, _ROUNDS, _CLOSE = 2000, 40_000, 12, 1e-11
_FLOWS, _SETTLED = 5_000, 1e-7
# Points at which the work of a jump is summed.
_POINTS = 300
# Largest change of a pad in a step that stays on its branch, over that of the plate.
_NEAR = 20.0
# Step of the flow over its stability limit.
_SLOW = 0.5


def interactions(places: Array, modulus: float, *, radius: float) -> Array:
    """Return the compliances c of pads at places [m] on a half-space of a contact modulus [m/N].

    Parameters
    ----------
    places : ndarray, shape (n, 2)
        Places of the pads [m].
    modulus : float
        Contact modulus E* of the base [Pa].
    radius : float
        Largest contact radius of a pad [m].

    Raises
    ------
    OutOfRange
        If two pads are closer than four contact radii.

    Examples
    --------
    >>> c = interactions(np.array([[0.0, 0.0], [1e-3, 0.0]]), 1e6, radius=1e-4)
    >>> f"{c[0, 1]:.4e} m/N"
    '3.1831e-04 m/N'
    """
    distance = np.linalg.norm(places[:, None] - places[None], axis=-1)
    np.fill_diagonal(distance, np.inf)
    if distance.min() < LEAST_SPACING * radius:
        raise InputError(
            f"pads at a distance of {distance.min():.4g} m with a contact radius of "
            f"{radius:.4g} m stand too close for interaction by point loads, which holds from "
            f"{LEAST_SPACING:g} radii on"
        )
    return 1 / (pi * modulus * distance)


def coupled(curves: Sequence[Curve], heights: Array, c: Array) -> tuple[Curve, Array]:
    """Return the curve of pads on a rigid plate that interact through compliances c [m/N].

    With it are the positions of the plate at which each pad has detached [m]. At each position z of
    the plate pads of heights h are at x with x + c F(x) = z + h. Equilibrium is followed by
    Newton's method. Where its branch ends, pads flow to the next equilibrium against the unbalanced
    displacement, as overdamped pads would.
    """
    pads = _Pads(curves)
    x: Array = pads.starts.copy()
    held: Any = np.ones(len(curves), dtype=bool)
    first, _ = pads.at(x, held)
    z = float(np.mean(x + c @ first - heights))
    travel = float(np.max(pads.starts - pads.ends) + np.ptp(heights))
    travel += float(np.max(c.sum(axis=1))) * max(each.pull_off_force for each in curves)
    dz = travel / _STEPS
    ends = np.full(len(curves), np.nan)
    positions, forces, lost = [z], [float(first.sum())], 0.0
    while held.any():
        z -= dz
        went = _balanced(pads, c, x, z + heights, held, dz)
        if went is None:
            before, (F0, _) = x, pads.at(x, held)
            went, still = _flowed(pads, c, x, z + heights, held)
            F1, _ = pads.at(went, still)
            lost += 0.5 * float(F0 @ c @ F0 - F1 @ c @ F1) - pads.absorbed(before, went, held)
        x = went
        over = held & (x <= pads.ends)
        ends[over], held = z, held & ~over
        positions.append(z)
        forces.append(float(pads.at(x, held)[0].sum()))
        if len(positions) > _MOST_STEPS:
            raise InputError("the pads of this array do not detach; their base is too soft")
    total = sum(each.lost for each in curves) + max(lost, 0.0)
    return Curve(np.array(positions), np.array(forces), total), ends


class _Pads:
    """Curves of several pads, evaluated together; each is followed by a force of 0."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        self._curves = curves
        self.starts = np.array([each.start for each in curves])
        self.ends = np.array([each.end for each in curves])
        self._first = np.cumsum([0, *(each.position.size for each in curves)])
        self._x = np.concatenate([each.position[::-1] for each in curves])
        self._F = np.concatenate([each.force[::-1] for each in curves])
        own = np.repeat(np.arange(len(curves)), np.diff(self._first))
        share = (self._x - self.ends[own]) / (self.starts - self.ends)[own]
        # ascending over all pads: twice the number of the pad, and the share of its travel left
        self._keys = 2 * own + np.clip(share, 0.0, 1.0)
        steps, width = np.diff(self._F), np.diff(self._x)
        inside = (width > 0) & (own[1:] == own[:-1])
        self._slope = np.append(np.where(inside, steps / np.where(inside, width, 1.0), 0.0), 0.0)

    def at(self, x: Array, held: Any) -> tuple[Array, Array]:
        """Return forces [N] and slopes [N/m] of pads at positions [m]; 0 for those not held."""
        share = (x - self.ends) / (self.starts - self.ends)
        keys = 2 * np.arange(x.size) + np.clip(share, 0.0, 1.0)
        place = np.searchsorted(self._keys, keys, side="right") - 1
        place = np.clip(place, self._first[:-1], self._first[1:] - 2)
        force = self._F[place] + self._slope[place] * (x - self._x[place])
        on = held & (x > self.ends)
        return np.where(on, force, 0.0), np.where(on, self._slope[place], 0.0)

    def absorbed(self, before: Array, after: Array, held: Any) -> float:
        """Return the work that pads take between positions, until their ends [J]."""
        share = np.linspace(0.0, 1.0, _POINTS)[:, None]
        x = before + share * (np.maximum(after, self.ends) - before)
        forces = np.array([self.at(each, held)[0] for each in x])
        return float(np.sum((forces[1:] + forces[:-1]) / 2 * np.diff(x, axis=0)))


def _balanced(pads: _Pads, c: Array, x: Array, goal: Array, held: Any, dz: float) -> Array | None:
    """Return the positions in equilibrium by Newton's method; None if their branch has ended."""
    at, scale, unit = x - dz, float(np.max(np.abs(goal)) + abs(dz)), np.eye(x.size)
    for _ in range(_ROUNDS):
        force, slope = pads.at(at, held)
        off, matrix = at + c @ force - goal, unit + c * slope
        if np.max(np.abs(off)) < _CLOSE * scale:
            return at if np.linalg.slogdet(matrix)[0] > 0 else None
        at = at - np.linalg.solve(matrix, off)
        if np.max(np.abs(at - x)[held], initial=0.0) > _NEAR * dz:
            return None
    return None


def _flowed(pads: _Pads, c: Array, x: Array, goal: Array, held: Any) -> tuple[Array, Any]:
    """Return positions after an overdamped motion towards equilibrium, and the pads held there."""
    at, scale = x.copy(), float(np.max(np.abs(goal)))
    largest = float(np.max(c.sum(axis=1)))
    for _ in range(_FLOWS):
        force, slope = pads.at(at, held)
        off = at + c @ force - goal
        if np.max(np.abs(off)[held], initial=0.0) < _SETTLED * scale:
            break
        at = at - _SLOW / (1 + np.abs(slope) * largest) * off
        # a pad that has detached stays apart
        held = held & (at > pads.ends)
    return at, held
