r"""Greenwood: the effective surface energy of a viscoelastic crack with a cohesive zone.

A constant tension, the strength, bridges the crack over a moving zone; the creep
of the solid under it determines the opening of the faces. For one retardation time (Eq. 3.32)

.. math:: \frac1\Gamma = k + (1 - k) \, g(\alpha), \quad
          g(\alpha) = \frac\alpha2 \int_0^1 H(\xi) e^{-\alpha (1 - \xi)} d\xi, \quad
          \alpha = \frac{l \, \Gamma}{v \tau_0},

with the retardation modes of any solid :math:`1/\Gamma = c_\infty + \sum_j w_j
g(l \Gamma / v \tau_j)`, because creep adds up. Speeds are dimensionless,
:math:`\hat v = v \tau_0 / l` with the material's ``time_unit`` (a retardation time) for tau_0
and :func:`cohesive_zone_length` for l: multiply by l/tau_0 for m/s. Range: steady opening crack
in a half-space much larger than l Gamma, linear viscoelastic solid.

Source: Greenwood (2004), J. Phys. D 37, 2557 (no DOI known to this package), in the form of
Maghami, PhD thesis (2025), chapter 3, published as doi:10.1016/j.engfracmech.2024.109898.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import scipy

from viscotack.theory._checks import Number, Values, at_least, plain, positive

from . import _crack


def amplification(speed: Values, *, material: _crack.Material) -> Number:
    r"""Return effective over rubbery surface energy at a dimensionless speed.

    The speed is :math:`v \tau_0 / l`, with the time unit tau_0 of the material. Eq. 3.32,
    after Greenwood (2004), for a steady opening crack; see the module.

    Relative error 1e-12 or better; 1e5 speeds take a fraction of a second.

    Parameters
    ----------
    speed : array_like
        Dimensionless speed, not negative.
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Raises
    ------
    InputError
        If a speed is negative or not finite.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{amplification(1.0, material=solid):.3f}"
    '2.056'
    """
    return _theory.amplification(speed, material=material)


def speed(amplification: Values, *, material: _crack.Material) -> Number:
    r"""Return the dimensionless speed at which an amplification is reached.

    Parameters
    ----------
    amplification : array_like
        Effective over rubbery surface energy, at least 1 and below glassy over rubbery modulus.
    material : Material
        Viscoelastic solid of :mod:`viscotack.model.materials`.

    Raises
    ------
    InputError
        If an amplification is outside its range.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{speed(2.0, material=solid):.3f}"
    '0.918'
    """
    return _theory.speed(amplification, material=material)


def cohesive_zone_length(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the length l [m] of the cohesive zone of a slow crack against a rigid body.

    .. math:: l = \frac{\pi E_0^* \Delta\gamma_0}{4 \sigma_0^2}

    Parameters
    ----------
    contact_modulus : float
        Rubbery E0* [Pa], positive.
    work_of_adhesion : float
        :math:`\Delta\gamma_0` [J/m^2], positive.
    strength : float
        Traction in the zone :math:`\sigma_0` [Pa], positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Notes
    -----
    Half of the fracture length a0 of Eq. 3.3; not the length of
    :func:`viscotack.theory.crack.persson_brener.crack_tip_length`.

    Examples
    --------
    >>> l = cohesive_zone_length(contact_modulus=1.9e6, work_of_adhesion=0.2, strength=5e6)
    >>> f"{l * 1e9:.1f} nm"
    '11.9 nm'
    """
    E, w, s = positive(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    return plain(np.pi * E * w / (4 * s**2))


def zone_response(ratio: Values) -> Number:
    r"""Return the ratio g of effective to full creep of a mode in the zone, dimensionless.

    .. math:: g(\alpha) = \frac\alpha2 \int_0^1 H(\xi) e^{-\alpha (1 - \xi)} d\xi
              = 1 - \frac2\alpha \int_0^{\sqrt\alpha} D(x) dx,

    :math:`H = 2 \sqrt\xi - (1 - \xi) \ln \frac{1 + \sqrt\xi}{1 - \sqrt\xi}` (Eq. 3.33), D
    Dawson's integral. It rises from alpha/3 to 1 - [ln(4 alpha) + 0.5772]/(2 alpha).

    Parameters
    ----------
    ratio : array_like
        :math:`\alpha = l \Gamma / (v \tau)`, not negative.

    Raises
    ------
    InputError
        If a ratio is negative or not finite.

    Examples
    --------
    >>> f"{zone_response(3.0):.4f}"
    '0.5284'
    """
    alpha = np.asarray(at_least(0, "it is a ratio of lengths", ratio=ratio))
    done, _ = _response(alpha)
    return plain(done)


_EULER = 0.5772156649015329
# Between these values of alpha the integral of Dawson's function is a Chebyshev polynomial.
_SMALL, _LARGE = 1.0, 50.0
# g = -sum (-alpha)^m / [(3/2)_m (m + 1)]
_SERIES = np.array(
    [0.0, *(-((-1.0) ** m) / ((m + 1) * np.prod(np.arange(1.5, m + 1))) for m in range(1, 21))]
)
# (2k - 1)!! / (k 2^(k+2)), of the asymptotic series in 1/alpha
_TAIL = np.array(
    [0.0, *(np.prod(np.arange(1.0, 2 * k, 2)) / (k * 2.0 ** (k + 2)) for k in range(1, 22))]
)


def _dawson_integral(z: Any) -> Any:
    """Return the integral of Dawson's function from 0 to z by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(48)
    return z / 2 * (scipy.special.dawsn(z[..., None] / 2 * (nodes + 1)) @ weights)


@lru_cache(maxsize=1)
def _middle() -> Any:
    """Return the polynomial of the integral; made at its first use, for it loads scipy.special."""
    ends = [np.sqrt(_SMALL), np.sqrt(_LARGE)]
    return np.polynomial.Chebyshev.interpolate(_dawson_integral, 60, domain=ends)


def _response(alpha: Any) -> tuple[Any, Any]:
    """Return g and 1 - g; the branch determines which of the two is the difference."""
    small, large = alpha < _SMALL, alpha > _LARGE
    middle = ~(small | large)
    done, rest = np.empty_like(alpha), np.empty_like(alpha)
    done[small] = np.polynomial.polynomial.polyval(alpha[small], _SERIES)
    rest[small] = 1 - done[small]
    a = alpha[middle]
    rest[middle] = 2 / a * _middle()(np.sqrt(a))
    a = alpha[large]
    tail = np.polynomial.polynomial.polyval(1 / a, _TAIL)
    rest[large] = 2 / a * ((np.log(4 * a) + _EULER) / 4 - tail)
    done[~small] = 1 - rest[~small]
    return done, rest


_theory = _crack.Theory(_response, factor=1.0)
# Cracks with given passage times of the tip, for CrackLaw.
passage, amplification_of_passage = _theory.passage, _theory.amplification_of_passage
