r"""The flat punch on a viscoelastic layer: the energy a crack takes, and how size limits it.

A fast crack takes :math:`\Gamma = \Delta\gamma_{eff}/\Delta\gamma_0` times the work of adhesion,
on a half-space up to glassy over rubbery modulus, 1/k. On a layer the mean stress cannot exceed
the strength of the interface, so that :math:`\Gamma` stays below :math:`(\pi/4) \, b/a_0`. The
theories of Greenwood and of Persson and Brener are corrected for it by their glassy end: the
larger of k and the inverse of that limit, :math:`k_b`, takes the place of k. For any spectrum the
delayed part of the creep is made smaller in proportion, :math:`1/\Gamma = k_b + (1 - k_b) \,
(1/\Gamma_\infty - k)/(1 - k)` at the same passage of the zone; for one retardation time this is
Eq. 3.35 and, for Persson and Brener, Eq. 4 of appendix II. Below the thickness b0 the limit is
under 1 and holds at every speed.

Speeds are those of the crack [m/s], opening. Parameters as in :mod:`viscotack.theory.punch.punch`,
with the rubbery ``contact_modulus``; ``material`` is any of :mod:`viscotack.materials`, for the law
of the crack alone: its rubbery modulus is not used.

Source: Maghami, PhD thesis (2025), Eq. 3.31 to 3.35 and appendix II.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.geometry import Base
from viscotack.materials import Modes
from viscotack.theory._checks import Number, at_least, plain, positive
from viscotack.theory.crack import _crack, greenwood, persson_brener

from .punch import fracture_length, regime_thicknesses


def largest_amplification(
    thickness: npt.ArrayLike,
    *,
    half_width: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
    base: Base,
) -> Number:
    r"""Return the effective over the rubbery surface energy that the size of the pad allows.

    .. math:: \Gamma_{max} = \frac{\min(b, b_1)}{b_0}
              = \frac\pi4 \frac{b}{\zeta a_0} \;(b < b_1), \quad \frac{a}{a_0} \;(b > b_1)

    where the mean stress is the strength (Eq. 3.31, which is for b < b1). The material sets
    another limit, 1/k. Below 1 the pad comes off at its strength at any speed.

    Examples
    --------
    >>> from viscotack.theory.punch.punch import Frictionless
    >>> pad = dict(half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4)
    >>> f"{largest_amplification(1e-4, **pad, base=Frictionless()):.2f}"
    '2.50'
    """
    b = positive(thickness=thickness)
    b0, _, b1 = regime_thicknesses(
        half_width=half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
        modulus_ratio=1.0,
        base=base,
    )
    return plain(np.minimum(b, b1) / b0)


def amplification(
    crack_speed: npt.ArrayLike,
    *,
    theory: ModuleType,
    largest: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
    material: _crack.Material,
) -> Number:
    r"""Return effective over rubbery surface energy at a crack speed, corrected for finite size.

    Parameters
    ----------
    crack_speed : array_like
        Speed [m/s] at which each edge recedes, not negative.
    theory : module
        :mod:`viscotack.theory.crack.greenwood` (Eq. 3.35) or
        :mod:`viscotack.theory.crack.persson_brener` (appendix II).
    largest : array_like
        What the size allows: :func:`largest_amplification`, or infinity for a half-space.
    contact_modulus, work_of_adhesion, strength : array_like
        Rubbery E0* [Pa], work of adhesion [J/m^2] and strength [Pa], for the length of the crack
        tip: :func:`viscotack.theory.crack.greenwood.cohesive_zone_length`; for Persson and Brener
        twice that, the fracture length a0.
    material : viscoelastic material of :mod:`viscotack.materials`
        For the law of the crack.

    Notes
    -----
    1e5 speeds take 0.1 s; every different ``largest`` below 1/k costs 1 to 5 ms.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = dict(contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4, material=solid)
    >>> found = amplification(0.1, theory=greenwood, largest=[0.5, 2.5, np.inf], **pad)
    >>> [f"{x:.3f}" for x in found]
    ['0.500', '2.163', '3.891']
    """
    v = at_least(0, "a crack that closes is another problem", crack_speed=crack_speed)
    unit = _speed_unit(theory, contact_modulus, work_of_adhesion, strength, material)
    v, limit = np.broadcast_arrays(v / unit, _positive_limit(largest))
    # below b0 the strength decides at every speed
    found = np.array(np.minimum(limit, 1.0))
    for solid, here in _solids(material, limit):
        found[here] = theory.amplification(v[here], material=solid)
    return plain(found)


def crack_speed(
    amplification: npt.ArrayLike,
    *,
    theory: ModuleType,
    largest: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
    material: _crack.Material,
) -> Number:
    """Return the crack speed [m/s] at which an amplification is reached.

    Parameters as :func:`amplification`, which must be at least 1 and below both ``largest`` and
    glassy over rubbery modulus.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> pad = dict(contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4, material=solid)
    >>> f"{crack_speed(2.0, theory=greenwood, largest=2.5, **pad) * 1e3:.1f} mm/s"
    '54.2 mm/s'
    """
    unit = _speed_unit(theory, contact_modulus, work_of_adhesion, strength, material)
    gamma, limit, unit = np.broadcast_arrays(
        at_least(1, "the slowest crack takes the work of adhesion", amplification=amplification),
        _positive_limit(largest),
        unit,
    )
    most = np.minimum(limit, 1 / material.modulus_ratio)
    if np.any((gamma >= most) & (gamma > 1)):
        raise ValueError(
            "amplification must stay below what size and material allow, reached at infinite "
            f"speed: got {np.max(gamma):.6g} of at most {np.min(most):.6g}"
        )
    found = np.zeros(gamma.shape)
    for solid, here in _solids(material, limit):
        found[here] = theory.speed(gamma[here], material=solid)
    return plain(found * unit)


@dataclass(frozen=True)
class Limited:
    """A material as a crack feels it whose amplification the size of the pad limits.

    Parameters
    ----------
    material : viscoelastic material of :mod:`viscotack.materials`
        The layer.
    modulus_ratio : float
        The inverse of the limit: from the material's own to 1.
    """

    material: _crack.Material
    modulus_ratio: float

    @property
    def time_unit(self) -> float:
        """Return the time [s] of dimensionless speeds, that of the material."""
        return self.material.time_unit

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        """Return the modes of the material, in proportion less."""
        modes = self.material.retardation_modes(
            shortest=shortest, longest=longest, tolerance=tolerance
        )
        k = self.material.modulus_ratio
        part = (1 - self.modulus_ratio) / (1 - k)
        return Modes(
            instantaneous=self.modulus_ratio + part * max(modes.instantaneous - k, 0.0),
            weights=tuple(part * w for w in modes.weights),
            times=modes.times,
            error=part * modes.error,
        )


def _speed_unit(
    theory: ModuleType,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
    material: _crack.Material,
) -> Any:
    """Return the theory's length over the material's time [m/s]."""
    case: dict[str, Any] = dict(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    if theory is greenwood:
        length = greenwood.cohesive_zone_length(**case)
    elif theory is persson_brener:
        length = fracture_length(**case)
    else:
        raise ValueError(f"theory must be theory.greenwood or theory.persson_brener, got {theory}")
    return np.asarray(length) / material.time_unit


def _positive_limit(largest: npt.ArrayLike) -> Any:
    limit = np.asarray(largest, dtype=float)
    if not np.all(limit > 0):
        raise ValueError(f"largest must be a positive amplification, got {np.min(limit)}")
    return limit


def _solids(material: _crack.Material, limit: Any) -> Iterator[tuple[_crack.Material, Any]]:
    """Yield each solid that a crack feels, and where; none where the limit is 1 or below."""
    k = material.modulus_ratio
    ratios = np.maximum(1 / limit, k)
    for ratio in np.unique(ratios[ratios < 1]):
        yield Limited(material, float(ratio)) if ratio > k else material, ratios == ratio
