r"""How thick must the pad be: design answers for a flat punch on a viscoelastic layer.

The pull-off stress at a crack speed, or at a retraction speed, falls with the thickness, from the
strength :math:`\sigma_0` to the half-plane; these functions turn that round. Which way a pad comes
off, over thickness and speed, is :mod:`viscotack.theory.punch.punch_map`.

Parameters as in :mod:`viscotack.theory.punch.punch_unloading`, whose range and errors hold here:
the stress comes out up to 19 % high, and so does the thickness, by up to twice as much on thin
layers.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from viscotack.geometry import Base
from viscotack.theory._checks import Number, plain, positive
from viscotack.theory.crack import _crack

from . import punch_crossover, punch_rate, punch_unloading

# Thickest layer, in half widths, of an answer at a crack speed (a half-plane to 1e-4) and of one
# at a retraction speed.
_HALF_PLANE, _THICKEST = 100.0, 5.0
_TOLERANCE = 1e-12


def pull_off_stress(
    thickness: npt.ArrayLike,
    *,
    crack_speed: npt.ArrayLike,
    half_width: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
    material: _crack.Material,
    theory: ModuleType,
    base: Base,
) -> Number:
    r"""Return the mean stress [Pa] at which edges move at a crack speed [m/s], contact still whole.

    .. math:: \bar\sigma = \bar\sigma_{el} \sqrt{\Gamma(v)}, \quad
              \Gamma < (\sigma_0/\bar\sigma_{el})^2

    with the exact elastic stress. From the elastic one of a slow crack to the smaller of
    :math:`1/\sqrt k` times that and the strength. A ligament narrower than the punch carries less
    in proportion.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.theory import greenwood
    >>> from viscotack.theory.punch.punch import Frictionless
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = dict(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     material=solid, theory=greenwood, base=Frictionless(),
    ... )
    >>> stress = pull_off_stress(3e-4, crack_speed=[0, 1e-2, 1], **pad)
    >>> [f"{s / 1e3:.1f} kPa" for s in stress]
    ['19.2 kPa', '25.3 kPa', '46.2 kPa']
    """
    case: dict[str, Any] = dict(contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion)
    elastic = np.asarray(
        punch_crossover.pull_off_stress(thickness, half_width=half_width, **case, base=base)
    )
    gamma = punch_rate.amplification(
        crack_speed,
        theory=theory,
        largest=(positive(strength=strength) / elastic) ** 2,
        **case,
        strength=strength,
        material=material,
    )
    return plain(elastic * np.sqrt(gamma))


def thickness_at_crack_speed(
    stress: npt.ArrayLike,
    *,
    crack_speed: float,
    half_width: float,
    contact_modulus: float,
    work_of_adhesion: float,
    strength: float,
    material: _crack.Material,
    theory: ModuleType,
    base: Base,
) -> Number:
    """Return the thickness [m] with a wanted pull-off stress [Pa] at a crack speed [m/s].

    The inverse of :func:`pull_off_stress`, for a wanted stress below the strength and above that
    of a layer of 100 a. Some 20 ms each.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.theory import greenwood
    >>> from viscotack.theory.punch.punch import Frictionless
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = dict(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     material=solid, theory=greenwood, base=Frictionless(),
    ... )
    >>> f"{thickness_at_crack_speed(3e4, crack_speed=0.01, **pad) * 1e6:.0f} um"
    '198 um'
    """
    layer: dict[str, Any] = dict(
        half_width=half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        base=base,
    )
    law: dict[str, Any] = dict(strength=strength, material=material, theory=theory)
    return _thickness(
        stress,
        lambda b: pull_off_stress(b, crack_speed=crack_speed, **layer, **law),
        strength,
        layer,
        _HALF_PLANE,
    )


def thickness_at_speed(
    stress: npt.ArrayLike,
    *,
    speed: float,
    half_width: float,
    contact_modulus: float,
    work_of_adhesion: float,
    strength: float,
    material: _crack.Material,
    theory: ModuleType,
    base: Base,
) -> Number:
    """Return the thickness [m] with a wanted pull-off stress [Pa] at a retraction speed [m/s].

    The inverse of :func:`viscotack.theory.punch.punch_unloading.pull_off`, for a wanted stress
    below the strength and above that of a layer of 5 a. Some 50 ms each.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> from viscotack.theory import greenwood
    >>> from viscotack.theory.punch.punch import Frictionless
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = dict(
    ...     half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4,
    ...     material=solid, theory=greenwood, base=Frictionless(),
    ... )
    >>> f"{thickness_at_speed(3e4, speed=1e-4, **pad) * 1e6:.0f} um"
    '183 um'
    """
    layer: dict[str, Any] = dict(
        half_width=half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        base=base,
    )
    law: dict[str, Any] = dict(strength=strength, material=material, theory=theory)
    return _thickness(
        stress,
        lambda b: punch_unloading.pull_off(speed, thickness=b, **layer, **law).stress,
        strength,
        layer,
        _THICKEST,
    )


def _thickness(
    wanted: npt.ArrayLike,
    stress: Callable[[float], Any],
    strength: float,
    layer: dict[str, Any],
    thickest: float,
) -> Number:
    """Return where a stress that falls with the thickness takes the wanted values."""
    sigma, s0 = positive(stress=wanted, strength=strength)
    a = layer["half_width"]
    if np.any(sigma >= s0):
        raise ValueError(
            f"stress must be below the strength of the interface, {s0:.6g} Pa, got "
            f"{np.max(sigma):.6g} Pa"
        )
    lowest = float(stress(thickest * a))
    if np.any(sigma <= lowest):
        raise ValueError(
            f"stress must be above that of a layer {thickest:g} times as thick as the half width, "
            f"{lowest:.6g} Pa, got {np.min(sigma):.6g} Pa"
        )
    # up to here the elastic layer comes off at the strength
    thin = np.log(punch_crossover.thickness(s0, **layer)) - 1e-6
    thick = np.log(thickest * a)

    def solved(value: float) -> float:
        def miss(log_b: float) -> float:
            return float(np.log(stress(float(np.exp(log_b))) / value))

        root: Any = brentq(miss, thin, thick, xtol=_TOLERANCE)
        return float(np.exp(root))

    return plain(np.vectorize(solved, otypes=[float])(sigma))
