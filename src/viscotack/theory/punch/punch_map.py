"""Which way a flat punch comes off a viscoelastic layer: a map over thickness and speed.

Parameters as in :mod:`viscotack.theory.punch.punch_unloading`, and its range.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.geometry import Base
from viscotack.theory._checks import positive
from viscotack.theory.crack import _crack

from . import punch, punch_crossover, punch_rate, punch_unloading


class RegimeMap(NamedTuple):
    """How a pad comes off over thickness (rows) and retraction speed (columns), SI.

    Attributes
    ----------
    thickness : ndarray, shape (N,)
        Of the layer [m].
    speed : ndarray, shape (M,)
        Of retraction [m/s].
    regime : ndarray of str, shape (N, M)
        One of :data:`viscotack.theory.punch.punch.REGIMES`.
    stress : ndarray, shape (N, M)
        Mean pull-off stress [Pa].
    crack_speed : ndarray, shape (N, M)
        Of each edge at pull-off [m/s]; infinite where the contact opens at once.
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
    boundaries: punch.Thicknesses


def regime_map(
    thickness: npt.ArrayLike,
    speed: npt.ArrayLike,
    *,
    half_width: float,
    contact_modulus: float,
    work_of_adhesion: float,
    strength: float,
    material: _crack.Material,
    theory: ModuleType,
    base: Base,
) -> RegimeMap:
    """Return how a pad comes off, over lists of thicknesses [m] and retraction speeds [m/s].

    Cohesive where the crack at pull-off is so fast that on a half-space it would take more than
    the size allows; elsewhere a thin layer below b1 and a half-plane above. 40 by 40 in half a
    second.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.theory import greenwood
    >>> from viscotack.theory.punch.punch import Frictionless
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> found = regime_map(
    ...     [1e-4, 2e-3], [1e-6, 1.0], half_width=1e-3, contact_modulus=1e6,
    ...     work_of_adhesion=0.05, strength=5e4, material=solid, theory=greenwood,
    ...     base=Frictionless(),
    ... )
    >>> found.regime.tolist()
    [['thin layer', 'cohesive'], ['half-plane', 'half-plane']]
    """
    b, r = (np.atleast_1d(x) for x in positive(thickness=thickness, speed=speed))
    if b.ndim > 1 or r.ndim > 1:
        raise ValueError(
            f"thickness and speed must be lists, the axes of the map, got shapes {b.shape} and "
            f"{r.shape}"
        )
    layer: dict[str, Any] = dict(half_width=half_width, contact_modulus=contact_modulus, base=base)
    energy: dict[str, Any] = dict(work_of_adhesion=work_of_adhesion, strength=strength)
    law: dict[str, Any] = dict(material=material, theory=theory)
    state = punch_unloading.pull_off(r, thickness=b[:, None], **layer, **energy, **law)
    crack = np.asarray(state.crack_speed)
    running = np.isfinite(crack)
    unlimited = np.ones(crack.shape)
    unlimited[running] = punch_rate.amplification(
        crack[running], largest=np.inf, contact_modulus=contact_modulus, **energy, **law
    )
    elastic = np.asarray(
        punch_crossover.pull_off_stress(b, **layer, work_of_adhesion=work_of_adhesion)
    )
    boundaries = punch.regime_thicknesses(**layer, **energy, modulus_ratio=material.modulus_ratio)
    cohesive = np.sqrt(unlimited) * elastic[:, None] >= strength
    thick = np.where(b > boundaries.half_plane, 2, 1)[:, None]
    return RegimeMap(
        thickness=b,
        speed=r,
        regime=np.array(punch.REGIMES)[np.where(cohesive, 0, thick)],
        stress=np.asarray(state.stress),
        crack_speed=crack,
        amplification=np.asarray(state.amplification),
        boundaries=boundaries,
    )
