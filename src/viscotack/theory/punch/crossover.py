r"""Flat punch on an elastic layer of any thickness: the exact curve between thin and thick.

A punch of half width a on a layer of thickness b, displaced by delta, carries the force
:math:`P/L = E^* S(a) \, \delta`. It detaches over its whole area when the energy release rate of
its edges equals the work of adhesion:

.. math:: \frac14 E^* \delta^2 S'(a) = \Delta\gamma_0, \quad
          \bar\sigma_{po} = \frac{S}{2a} \sqrt{\frac{4 E^* \Delta\gamma_0}{S'}}.

S depends on a/b and on the boundary condition of the base. For a thin layer it is
:math:`2 \zeta a/b + c` up to exponentially small terms, so the pull-off stress is that of
:func:`viscotack.theory.punch.pad.thin_layer_pull_off_stress` times :math:`1 + (c/2\zeta) \, b/a`,
with c/2 = 0.177131575829 on a frictionless base; for a thick one
:math:`1/S \to (2/\pi) \ln(b/a)` plus a constant. In between it is computed, to 1e-11 on a
frictionless base and 1e-9 on a bonded one: once per base, in 0.1 to 2
seconds, and then interpolated by Chebyshev polynomials in ln(1 + a/b).

Range: forces of short range (a cohesive zone small compared with a and b: no limit by the
strength), linear elastic layer, frictionless punch.

Source: this package; the transfer function of the layer is that of Maghami, PhD thesis (2025),
Eq. 3.19 to 3.22, after Bentall and Johnson.

**Integral equation of a rigid punch on a layer, solved once for all sizes.** Lengths in half widths
a, lambda = a/b. A pressure p = phi(t) / sqrt(1 - t^2) displaces the surface of the layer by

    (2/pi) int p(s) int_0^inf kappa(u)/u cos(u lambda (t - s)) du ds,

with the transfer function kappa of the base; under the punch this equals 1. The logarithm in the
kernel is diagonal in Chebyshev polynomials, the rest is analytic for |Im(lambda t)| < 2, so
Gauss-Chebyshev points converge geometrically. The results are functions of lambda alone,
represented by Chebyshev polynomials in ln(1 + lambda) up to where the two edges no longer interact.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded
from viscotack.model.geometry.panels import gauss
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory._roots import halved


def stiffness(
    thickness: Values, *, half_width: Values, contact_modulus: Values, base: Base
) -> Number:
    r"""Return force per length over depth, :math:`E^* S` [Pa].

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    half_width, contact_modulus : array_like
        a [m] and E* [Pa]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(half_width=1e-3, contact_modulus=1e6, base=Frictionless())
    >>> f"{stiffness(1e-4, **pad) / 1e6:.4f} MPa"
    '20.3543 MPa'
    """
    ratio, _, E = _pad(thickness, half_width, contact_modulus=contact_modulus)
    S, _ = curve(base)(ratio)
    return plain(E * S)


def energy_release_rate(
    depth: Values, *, thickness: Values, half_width: Values, contact_modulus: Values, base: Base
) -> Number:
    r"""Return the energy [J/m^2] that the receding edges release, :math:`E^* \delta^2 S'(a)/4`.

    Per edge and unit length. The punch detaches when it reaches the work of adhesion.

    Parameters
    ----------
    depth : array_like
        :math:`\delta` [m], of either sign.
    thickness, half_width, contact_modulus : array_like
        b [m], a [m] and E* [Pa]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If thickness, half width, modulus or Poisson ratio is outside its range.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(thickness=1e-4, half_width=1e-3, contact_modulus=1e6, base=Frictionless())
    >>> f"{energy_release_rate(-3e-6, **pad):.4f} J/m^2"
    '0.0450 J/m^2'
    """
    ratio, a, E = _pad(thickness, half_width, contact_modulus=contact_modulus)
    S, stress = curve(base)(ratio)
    slope = (S / stress) ** 2 / a
    return plain(E * np.asarray(depth, dtype=float) ** 2 * slope / 4)


def pull_off_stress(
    thickness: Values,
    *,
    half_width: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    base: Base,
) -> Number:
    r"""Return the mean pull-off stress [Pa] of an elastic layer of any thickness.

    It decreases with the thickness, without an upper limit for thin layers, because the strength of
    the interface is not included. 1e5 thicknesses take a few hundredths of a second.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    half_width, contact_modulus, work_of_adhesion : array_like
        a [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    Where the thin-layer and the half-plane formula meet, 23.5 % above both:

    >>> from viscotack.theory.punch import Frictionless, half_plane_pull_off_stress
    >>> pad = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> exact = pull_off_stress(4e-3 / np.pi, half_width=1e-3, **pad, base=Frictionless())
    >>> f"{exact / half_plane_pull_off_stress(1e-3, **pad):.4f}"
    '1.2350'
    """
    ratio, a, E, w = _pad(
        thickness,
        half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    _, stress = curve(base)(ratio)
    return plain(stress * np.sqrt(E * w / a))


def depth_at_pull_off(
    thickness: Values,
    *,
    half_width: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    base: Base,
) -> Number:
    r"""Return the depth [m] of pull-off, negative, :math:`-\sqrt{4 \Delta\gamma_0/(E^* S')}`.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    half_width, contact_modulus, work_of_adhesion : array_like
        a [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{depth_at_pull_off(1e-4, **pad, base=Frictionless()) * 1e6:.2f} um"
    '-3.16 um'
    """
    ratio, a, E, w = _pad(
        thickness,
        half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    S, stress = curve(base)(ratio)
    return plain(-2 * stress / S * np.sqrt(w * a / E))


def work_of_separation(
    thickness: Values, *, half_width: Values, work_of_adhesion: Values, base: Base
) -> Number:
    r"""Return the work [J/m^2] of a rigid machine per area of the punch.

    .. math:: w_{sep} = \Delta\gamma_0 \frac{S}{a S'}

    From zero force to pull-off, where the whole contact opens. It equals the work of adhesion for a
    thin layer; for a thick one it grows with :math:`\ln(b/a)`, because the punch is displaced
    relative to the base. It is the same for a slow and a fast viscoelastic layer.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    half_width, work_of_adhesion : array_like
        a [m] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(half_width=1e-3, work_of_adhesion=0.05, base=Frictionless())
    >>> [f"{work_of_separation(b, **pad) * 1e3:.1f} mJ/m^2" for b in (1e-5, 1e-3, 1e-1)]
    ['50.1 mJ/m^2', '59.1 mJ/m^2', '247.4 mJ/m^2']
    """
    ratio, _, w = _pad(thickness, half_width, work_of_adhesion=work_of_adhesion)
    S, stress = curve(base)(ratio)
    return plain(w * stress**2 / S)


def thickness(
    stress: Values,
    *,
    half_width: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    base: Base,
) -> Number:
    r"""Return the thickness [m] of the elastic layer with a given pull-off stress [Pa].

    Parameters
    ----------
    stress : array_like
        Mean pull-off stress [Pa], above that of the half-plane, the smallest of all layers.
    half_width, contact_modulus, work_of_adhesion : array_like
        a [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is at
        most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(half_width=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{thickness(2e4, **pad, base=Frictionless()) * 1e6:.0f} um"
    '275 um'
    """
    sigma = positive(stress=stress)
    a, E, w = positive(
        half_width=half_width, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    wanted = sigma / np.sqrt(E * w / a)
    least = np.sqrt(np.pi / 2)
    if np.any(wanted <= least):
        lowest = np.min(np.broadcast_to(sigma, wanted.shape)[wanted <= least])
        raise InputError(
            f"stress must exceed that of a half-plane, {lowest:.6g} Pa, because every "
            "layer has a higher pull-off stress"
        )
    state = curve(base)
    # the stress rises with a/b, at least as the thin-layer law of a frictionless base
    log_ratio = halved(
        lambda x: wanted - state(np.exp(x))[1],
        np.full(wanted.shape, -60.0),
        np.log(wanted**2) + 10,
    )
    return plain(a * np.exp(-log_ratio))


def _pad(thickness: Values, half_width: Values, **others: Values) -> Any:
    """Return a/b, a and the others, validated."""
    b, a, *rest = positive(thickness=thickness, half_width=half_width, **others)
    return a / b, a, *rest


# kappa differs from 1 - exp(-2u) by u^2 exp(-2u), negligible above this u.
_CUT = 22.0
# Spacing and degree of the spline of the smooth part of the kernel, for round-off accuracy.
_SPACING, _SPLINE = 0.03, 7
# Gauss-Chebyshev points of a half: the pressure has an edge layer of one thickness.
_POINTS, _PER_THICKNESS = 22, 3
# The table ends where the interaction of the edges is exp(-this).
_FORGOTTEN = 30.0
# For a layer closer to incompressible the table would be too long.
LARGEST_POISSON_RATIO = 0.49


class Curve(NamedTuple):
    """The state of a punch as a function of a/b."""

    longest: float
    foundation: float
    offset: float
    inverse: Any
    stress: Any

    def __call__(self, ratio: Any) -> tuple[Any, Any]:
        """Return S, force per depth and length in E*, and the pull-off stress in sqrt(E* w/a)."""
        x = np.minimum(ratio, self.longest)
        q = np.log1p(x)
        S = 1 / (self.inverse(q) / (1 + x) + _half_plane(x))
        stress = self.stress(q) * np.sqrt(1 + x)
        thin = ratio > self.longest
        # S = 2 zeta a/b + c, and a S' its first term alone
        line = 2 * ratio / self.foundation
        return (
            np.where(thin, line + self.offset, S),
            np.where(thin, (line + self.offset) / np.sqrt(line), stress),
        )


@lru_cache(maxsize=32)
def curve(base: Base) -> Curve:
    """Return the state of a punch on a layer with this base, computed on first use."""
    if isinstance(base, Bonded) and base.poisson_ratio > LARGEST_POISSON_RATIO:
        raise InputError(
            f"poisson_ratio of a bonded layer must be at most {LARGEST_POISSON_RATIO}, got "
            f"{base.poisson_ratio}, because the interaction of the edges decays too slowly near 0.5"
        )
    longest = _FORGOTTEN / _decay(base) + 1
    degree = 40 + 2 * int(longest)
    end = np.log1p(longest)
    nodes = (1 + np.polynomial.chebyshev.chebpts1(degree + 1)) * end / 2
    ratios = np.append(np.expm1(nodes), longest)
    S, edge = states(ratios, base)
    # a S' = 2 pi phi(1)^2, from the stress intensity at the edges
    stress = S / (np.sqrt(2 * np.pi) * edge)
    shapes = (1 / S - _half_plane(ratios)) * (1 + ratios), stress / np.sqrt(1 + ratios)
    inverse, stress = (
        np.polynomial.Chebyshev.fit(nodes, y[:-1], degree, domain=[0, end]) for y in shapes
    )
    offset = float(S[-1] - 2 * longest / base.foundation)
    return Curve(longest, base.foundation, offset, inverse, stress)


def states(ratios: Array, base: Base) -> tuple[Array, Array]:
    """Return S, the force of a punch at unit depth, and phi(1), its edge intensity, per a/b."""
    smooth = _smooth_kernel(2 * float(np.max(ratios)), base)
    force, edge = np.array([_state(float(ratio), smooth) for ratio in ratios]).T
    return force, edge


def _half_plane(ratio: Any) -> Any:
    """Return the logarithmic part of 1/S for a thick layer; zero for a thin one."""
    return np.log1p(ratio**-2.0) / np.pi


def _decay(base: Base) -> float:
    """Return y of the edge interaction exp(-y a/b): the first zero of kappa(iy/2)."""
    if not isinstance(base, Bonded):
        return 2 * np.pi
    # q sin y = y
    q = 3 - 4 * base.poisson_ratio
    return float(halved(lambda y: q * np.sin(y) - y, 1e-3, np.pi))


def _smooth_kernel(longest: float, base: Base) -> Any:
    """Return the kernel without its logarithm as a spline of the distance in thicknesses."""
    panels = int(np.ceil(_CUT * (longest + 4) / 60)) + 2
    u, weights = gauss(np.linspace(0.0, _CUT, panels + 1), 40)
    rest = weights * (base.transfer(u) - 1 + np.exp(-2 * u)) / u
    x = np.arange(-8, int(np.ceil(longest / _SPACING)) + 9) * _SPACING
    values = np.log(x**2 + 4) / 2 + np.cos(np.multiply.outer(x, u)) @ rest
    return scipy.interpolate.make_interp_spline(x, values, k=_SPLINE)


def _state(ratio: float, smooth: Any) -> tuple[float, float]:
    n = _POINTS + int(np.ceil(_PER_THICKNESS * ratio))
    angle = (2 * np.arange(n) + 1) * np.pi / (4 * n)
    t, orders = np.cos(angle), 2 * np.arange(n)
    # the solution is even: fold the other half onto this one
    kernel = smooth(ratio * np.abs(t[:, None] - t)) + smooth(ratio * (t[:, None] + t))
    polynomials = np.cos(np.outer(angle, orders))
    logarithm = np.pi * np.append(np.log(2 / ratio), 1 / orders[1:])
    system = 2 / np.pi * (polynomials * logarithm + np.pi / (2 * n) * kernel @ polynomials)
    coefficients = np.linalg.solve(system, np.ones(n))
    return np.pi * float(coefficients[0]), float(np.sum(coefficients))
