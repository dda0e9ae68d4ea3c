"""What a surrogate answers: numbers of many rows at once, and between what they are."""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array

from .physics import LEAST_WAY


@dataclass(frozen=True, eq=False)
class Answers:
    """Predicted numbers of some rows, dimensionless; arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0], positive.
    work_to_pull_off : ndarray
        [1.5 pi R dg0 h0], from zero force or from a start in tension.
    force_spread, work_spread : ndarray
        Standard deviation of log10 among the networks.
    way, share : ndarray
        From the slow limit of the force to the fast one, log10, and the part of it that is covered.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    force_spread: Array
    work_spread: Array
    way: Array
    share: Array


def answered(forces: Array, works: Array, slow: Array, fast: Array) -> Answers:
    """Return what several networks answer together.

    Parameters
    ----------
    forces, works : ndarray, shape (m, n)
        log10 of the force and of the work, as each network says it.
    slow, fast : ndarray, shape (n,)
        log10 of the limits of the force.
    """
    force, way = forces.mean(axis=0), np.maximum(fast - slow, LEAST_WAY)
    return Answers(
        pull_off_force=10**force,
        work_to_pull_off=10 ** works.mean(axis=0),
        force_spread=forces.std(axis=0),
        work_spread=works.std(axis=0),
        way=way,
        share=(force - slow) / way,
    )


@dataclass(frozen=True, eq=False)
class Intervals:
    """Between what the simulated numbers are.

    Attributes
    ----------
    pull_off_force, work_to_pull_off : ndarray, shape (n, 2)
        As in :class:`Answers`.
    curve : ndarray, shape (n,)
        How far forces in tension are off at worst, over the pull-off force, at the same travel from
        zero force or from a start in tension.
    travel : ndarray, shape (n, 2)
        From a pressed start to zero force, over what a curve has.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    curve: Array
    travel: Array
