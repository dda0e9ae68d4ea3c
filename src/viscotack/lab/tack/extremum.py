"""Smallest force of a noisy curve, which may end with a jump behind it.

Parabolas are fitted to windows around the smallest point. A window is valid if its scatter is that
of the noise and polynomials of higher degree contribute no more than the noise. The answer is the
mean over the valid windows whose uncertainty is at most twice the smallest one. No window contains
a jump; if the force falls until the jump, it continues to fall up to the next point.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from viscotack.arrays import Array

_REACH = (0, 1, 2, 3, 4, 6, 8, 11, 16, 22, 30, 42, 60)  # points on either side
_ASYMMETRY = 4  # largest ratio of the points on both sides
_SCATTER = 2.0  # standard deviations of chi-square up to which a window is valid
_SHAPE = 0.5  # the same for the terms of higher degree
_WORSE = 2.0  # largest ratio of uncertainties in the mean
_JUMP = (10.0, 0.1)  # smallest step of a jump, relative to the noise and to the smallest force
_HIGHEST = 6  # degree of the polynomials that test a parabola


@dataclass(frozen=True)
class Extremum:
    """Smallest force [N] and its place (an index, not a whole number), with uncertainties."""

    value: float
    uncertainty: float
    at: float
    at_uncertainty: float


def extremum(force: Array, at: int, noise: float) -> Extremum:
    """Estimate the smallest force.

    Parameters
    ----------
    force : ndarray
        Force, corrected for the baseline [N].
    at : int
        Index of its smallest point.
    noise : float
        Standard deviation of single points [N].
    """
    near = min(float(force[at - 1]), float(force[min(at + 1, force.size - 1)]))
    between = max(near - float(force[at]), 0.0) / 2
    point = Extremum(float(force[at]), float(np.hypot(noise, between)), at, 0.5)
    jumps = np.diff(force[at:]) > max(_JUMP[0] * noise, _JUMP[1] * abs(float(force[at])))
    last = int(np.argmax(jumps)) if jumps.any() else force.size - at
    windows = [
        (before, behind)
        for before in _REACH
        for behind in {*_REACH, last}
        if before <= at and behind <= min(last, force.size - at - 1) and before + behind >= 4
        if behind == last or max(before, behind) <= _ASYMMETRY * (min(before, behind) + 1)
    ]
    found = [_parabola(force, at, window, noise, window[1] == last) for window in windows]
    valid = [one for one in found if one is not None]
    least = min((one.uncertainty for one in valid), default=np.inf)
    if least >= point.uncertainty:
        return point
    rows = np.array(
        [
            (one.value, one.uncertainty, one.at, one.at_uncertainty)
            for one in valid
            if one.uncertainty <= _WORSE * least
        ]
    )
    weights = rows[:, 1] ** -2 / np.sum(rows[:, 1] ** -2)
    mean = weights @ rows
    spread = np.sqrt(weights @ (rows - mean) ** 2)
    return Extremum(
        float(mean[0]),
        float(np.hypot(mean[1], spread[0])),
        float(mean[2]),
        # no curve is resolved between its points
        float(np.sqrt(mean[3] ** 2 + spread[2] ** 2 + 1 / 12)),
    )


@cache
def _polynomials(count: int) -> tuple[Any, ...]:
    """Orthonormal polynomials at the points of a window, and on a fine grid with slopes."""
    degree = min(_HIGHEST, count - 2)
    x, fine = np.linspace(-1, 1, count), np.linspace(-1, 1, 8 * count - 7)
    Q, R = np.linalg.qr(np.polynomial.legendre.legvander(x, degree))
    on_grid = np.linalg.solve(R.T, np.polynomial.legendre.legvander(fine, degree).T).T
    return Q, on_grid, 8 * np.gradient(on_grid, axis=0)


def _parabola(
    force: Array, at: int, window: tuple[int, int], noise: float, jump: bool
) -> Extremum | None:
    """Fit a parabola to a window of points before and behind; None if it is not valid.

    At a jump behind the window the force may fall until any place up to the next point.
    """
    F = force[at - window[0] : at + window[1] + 1]
    Q, on_grid, slopes = _polynomials(F.size)
    c = Q.T @ F
    free, more = F.size - 3, c.size - 3
    scatter = (F @ F - c[:3] @ c[:3]) / noise**2
    if scatter > free + _SCATTER * np.sqrt(2 * free):
        return None
    if c[3:] @ c[3:] > noise**2 * (more + _SHAPE * np.sqrt(2 * more)):
        return None
    course = on_grid[:, :3] @ c[:3]
    i = int(np.argmin(course))
    other = on_grid[:, :5] @ c[:5]
    bias = float(other.min() - course[i])
    value = float(np.hypot(noise * np.linalg.norm(on_grid[i, :3]), bias))
    slope = noise * np.linalg.norm(slopes[i, :3])
    bend = abs(slopes[-1, :3] @ c[:3] - slopes[0, :3] @ c[:3]) / F.size
    place = min(float(slope / max(bend, 1e-300)), F.size / 2)
    place = float(np.hypot(place, (np.argmin(other) - i) / 8))
    first = at - window[0] + i / 8
    if jump and i == course.size - 1:
        further = float(slopes[-1, :3] @ c[:3])
        value, place = np.hypot(value, further / np.sqrt(12)), np.hypot(place, np.sqrt(1 / 12))
        return Extremum(float(course[i]) + further / 2, float(value), first + 0.5, float(place))
    return Extremum(float(course[i]), value, first, place)
