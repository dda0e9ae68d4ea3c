"""Travels between forces of a retraction curve, in addition to its pull-off force.

The travels are measured from the start of the retraction to zero force, and from there to fractions
of the largest tension. They need no zero of depth and no force other than the pull-off; machine
compliance is subtracted. Where an edge accelerates during one test, they contain its rate
dependence.
"""

import numpy as np

from viscotack.arrays import Array
from viscotack.lab.tack import Cycle, Measured

# Fractions of the largest tension at which the travel is read, in addition to zero.
PARTS = (0.3, 0.6, 0.85)
# window relative to the pull-off around such a force, and smallest number of points in it
_WINDOW, _FEWEST = 0.06, 6


def travels(cycle: Cycle) -> tuple[Measured, ...] | None:
    """Return the travels of a cycle [m]: the first to zero force, the others from there.

    None if the retraction begins in tension, or has too few points.
    """
    back = slice(cycle.segments.retract, cycle.pull_off_at + 1)
    force, depth = cycle.force[back], cycle.depth[back]
    size = cycle.pull_off_force.value
    if force.size == 0 or force[0] <= 3 * cycle.noise:
        return None
    places = []
    for part in (0.0, *PARTS):
        near = np.abs(force + part * size) < _WINDOW * size
        if np.count_nonzero(near) < _FEWEST or np.ptp(force[near]) == 0:
            return None
        # a parabola, because fast retractions are curved
        _, slope, level = np.polyfit(force[near] + part * size, depth[near], 2)
        noise = abs(slope) * cycle.noise / np.sqrt(np.count_nonzero(near))
        # the uncertainty of the pull-off moves the level of the tension
        noise = float(np.hypot(noise, abs(slope) * part * cycle.pull_off_force.uncertainty))
        places.append((float(level), noise))
    (zero, doubt), start = places[0], float(depth[0])
    found = [Measured(start - zero, doubt)]
    found += [Measured(zero - level, float(np.hypot(doubt, noise))) for level, noise in places[1:]]
    return None if any(one.value <= 0 for one in found) else tuple(found)


def travels_of(travel: Array, force: Array, tension: Array) -> Array:
    """Return the travels of computed curves.

    Parameters
    ----------
    travel, force : ndarray, shape (points, cases)
        Travel, ascending, and force, compression positive.
    tension : ndarray, shape (cases,)
        Largest tension.

    Returns
    -------
    ndarray, shape (cases, 1 + parts)
        nan where a curve does not begin in compression.
    """
    cases = np.arange(tension.size)
    places = []
    for part in (0.0, *PARTS):
        level = -part * tension
        at = np.argmax(force <= level, axis=0)
        before = np.maximum(at - 1, 0)
        f0, f1 = force[before, cases], force[at, cases]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(at > 0, (f0 - level) / (f0 - f1), np.nan)
        places.append(travel[before, cases] * (1 - share) + travel[at, cases] * share)
    zero = places[0]
    return np.stack([zero, *(place - zero for place in places[1:])], axis=1)
