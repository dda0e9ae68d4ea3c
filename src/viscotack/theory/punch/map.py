"""Detachment regimes of a flat punch on a viscoelastic layer, over thickness and speed.

Pad, crack law of its edges and range are those of :mod:`viscotack.theory.punch.unloading`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.theory._checks import Values, positive
from viscotack.theory.crack import CrackLaw

from . import rate, regimes, unloading
from .pad import Pad


class RegimeMap(NamedTuple):
    """Detachment of a pad over thickness (rows) and speed (columns), from :func:`regime_map`.

    Attributes
    ----------
    thickness : ndarray, shape (N,)
        Thickness of the layer [m].
    speed : ndarray, shape (M,)
        Retraction speed [m/s].
    regime : ndarray of str, shape (N, M)
        One of :data:`viscotack.theory.punch.regimes.REGIMES`.
    stress : ndarray, shape (N, M)
        Mean pull-off stress [Pa].
    crack_speed : ndarray, shape (N, M)
        Speed of each edge at pull-off [m/s]; infinite if the whole contact opens simultaneously.
    amplification : ndarray, shape (N, M)
        Effective over rubbery surface energy at pull-off.
    boundaries : Thicknesses
        b0 of the slowest and of the fastest retraction, and b1 [m].
    """

    thickness: npt.NDArray[np.float64]
    speed: npt.NDArray[np.float64]
    regime: npt.NDArray[np.str_]
    stress: npt.NDArray[np.float64]
    crack_speed: npt.NDArray[np.float64]
    amplification: npt.NDArray[np.float64]
    boundaries: regimes.Thicknesses


def regime_map(thickness: Values, speed: Values, pad: Pad, law: CrackLaw) -> RegimeMap:
    """Compute the detachment regimes over thicknesses and retraction speeds.

    Cohesive if the energy of the crack at pull-off on a half-space would exceed the limit of the
    finite size; otherwise a thin layer below b1 and a half-plane above. A 40 by 40 map takes half a
    second.

    Parameters
    ----------
    thickness : array_like, shape (N,)
        b [m], positive.
    speed : array_like, shape (M,)
        Retraction speed [m/s], positive.
    pad : Pad
        Punch, layer and interface; the Poisson ratio of a bonded layer is at most 0.49.
    law : CrackLaw
        Crack law of the edges, :meth:`viscotack.theory.punch.pad.Pad.crack_law`.

    Raises
    ------
    InputError
        If a value is outside its range or not finite, or an axis is not one-dimensional.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.theory.punch import Frictionless, Pad
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = Pad(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     base=Frictionless(),
    ... )
    >>> law = pad.crack_law("greenwood", material=solid)
    >>> found = regime_map([1e-4, 2e-3], [1e-6, 1.0], pad, law)
    >>> found.regime.tolist()
    [['thin layer', 'cohesive'], ['half-plane', 'half-plane']]
    """
    b, r = (np.atleast_1d(x) for x in positive(thickness=thickness, speed=speed))
    if b.ndim > 1 or r.ndim > 1:
        raise InputError(
            f"thickness and speed must be one-dimensional arrays, got shapes {b.shape} and "
            f"{r.shape}"
        )
    state = unloading.pull_off(r, pad, law, thickness=b[:, None])
    crack = np.asarray(state.crack_speed)
    running = np.isfinite(crack)
    unlimited = np.ones(crack.shape)
    unlimited[running] = rate.amplification(crack[running], law, largest=np.inf)
    boundaries = regimes.regime_thicknesses(pad, modulus_ratio=law.material.modulus_ratio)
    elastic = np.asarray(pad.elastic_stress(b))
    cohesive = np.sqrt(unlimited) * elastic[:, None] >= pad.strength
    thick = np.where(b > boundaries.half_plane, 2, 1)[:, None]
    return RegimeMap(
        thickness=b,
        speed=r,
        regime=np.array(regimes.REGIMES)[np.where(cohesive, 0, thick)],
        stress=np.asarray(state.stress),
        crack_speed=crack,
        amplification=np.asarray(state.amplification),
        boundaries=boundaries,
    )
