r"""Where a Maugis-Dugdale contact ends under load, and the work up to it.

The functions are reached as ``maugis.pull_off`` and so on; parameters, units, signs, range and
source as in :mod:`viscotack.theory.elastic.maugis`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.theory._checks import Number, plain, positive
from viscotack.theory._scales import contact_scales

from . import _maugis_equations as equations

# Range of the Maugis parameter in which pull-off lies between the bounds of the search below.
_RANGE = (1e-6, 1e6)
_LOG_EXCESS = (-45.0, 30.0)
# Bisections that bring the bounds together to round-off.
_HALVINGS = 60
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


class Point(NamedTuple):
    """A point of the curve: contact radius [m], cohesive radius [m], depth [m], force [N]."""

    contact_radius: Number
    cohesive_radius: Number
    depth: Number
    force: Number


def maugis_parameter(
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
) -> Number:
    r"""Return :math:`\lambda = \sigma_0 (9 R / 2 \pi \Delta\gamma_0 E^{*2})^{1/3}`.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{maugis_parameter(**case):.3f}"
    '0.612'
    """
    R, E, w, s = positive(
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
    )
    return plain(s * np.cbrt(9 * R / (2 * np.pi * w * E**2)))


def parameter_from_tabor(tabor: npt.ArrayLike) -> Number:
    r"""Return the Maugis parameter of a Lennard-Jones contact with a Tabor number.

    Peak tension and work of adhesion are those of the 3-9 traction (Eq. 2.1),
    :math:`\sigma_0 = 16 \Delta\gamma_0 / 9 \sqrt3 h_0`:

    .. math:: \lambda = \frac{16}{9 \sqrt 3} \left( \frac{9}{2 \pi} \right)^{1/3} \mu
              = 1.15701\ldots \mu

    Examples
    --------
    >>> f"{parameter_from_tabor(3.24):.4f}"
    '3.7487'
    """
    mu = positive(tabor=tabor)
    return plain(16 / (9 * np.sqrt(3)) * np.cbrt(4.5 / np.pi) * mu)


def pull_off_force(
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
) -> Number:
    r"""Return the pull-off force [N], a positive number between 3/2 and 2 :math:`\pi R w`.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{pull_off_force(**case) * 1e9:.1f} nN"
    '263.9 nN'
    """
    end = pull_off(
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
    )
    return -end.force


def pull_off(
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
) -> Point:
    r"""Return the force minimum, for a Maugis parameter from 1e-6 to 1e6.

    It always lies on the part of the curve with contact: where the contact shrinks to a point
    the force still rises with a^2.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{pull_off(**case).contact_radius * 1e9:.1f} nm"
    '36.8 nm'
    """
    length, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    lam = _parameter_in_range(radius, contact_modulus, work_of_adhesion, strength)
    excess = np.exp(_pull_off_log_excess(lam))
    a = equations.contact_radius(excess, lam)
    P, d = equations.force_and_depth(excess, lam, a)
    length, height = 0.75 ** (1 / 3) * length, 0.75 ** (2 / 3) * height
    c = (1 + excess) * a
    return Point(plain(a * length), plain(c * length), plain(d * height), plain(P * load))


def work_to_pull_off(
    *,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
) -> Number:
    r"""Return the work [J] of the drive from zero force to the force minimum.

    The integral of P over the depth along retraction (both negative steps in tension), by 64-point
    Gauss quadrature in :math:`\ln(c/a - 1)`; range as for :func:`pull_off`.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{work_to_pull_off(**case) * 1e18:.0f} aJ"
    '670 aJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    lam = _parameter_in_range(radius, contact_modulus, work_of_adhesion, strength)

    def force(x: Any) -> Any:
        a = equations.contact_radius(np.exp(x), lam)
        return equations.force_and_depth(np.exp(x), lam, a)[0]

    end = _pull_off_log_excess(lam)
    start = _bisect(force, np.full(lam.shape, _LOG_EXCESS[0]), end)
    x = (start + end)[..., None] / 2 + (end - start)[..., None] / 2 * _NODES
    excess, lam = np.exp(x), lam[..., None]
    P, _ = equations.force_and_depth(excess, lam, equations.contact_radius(excess, lam))
    power = P * equations.depth_slope(excess, lam) * excess
    return plain((power @ _WEIGHTS) * (end - start) / 2 * 0.75 ** (2 / 3) * height * load)


def _parameter_in_range(
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
    strength: npt.ArrayLike,
) -> npt.NDArray[np.float64]:
    lam = np.asarray(
        maugis_parameter(
            radius=radius,
            contact_modulus=contact_modulus,
            work_of_adhesion=work_of_adhesion,
            strength=strength,
        )
    )
    low, high = _RANGE
    if np.any((lam < low) | (lam > high)):
        raise InputError(
            f"the Maugis parameter must lie between {low:g} and {high:g}, got {np.min(lam):.3g} "
            f"to {np.max(lam):.3g}; below use theory.dmt, above theory.jkr"
        )
    return lam


def _pull_off_log_excess(lam: Any) -> Any:
    """Return ln(c/a - 1) at the force minimum."""
    low, high = (np.full(lam.shape, bound) for bound in _LOG_EXCESS)
    return _bisect(lambda x: equations.force_slope(np.exp(x), lam), low, high)


def _bisect(function: Any, low: Any, high: Any) -> Any:
    """Return where a function that falls through zero between the bounds does so."""
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = function(middle) > 0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return (low + high) / 2
