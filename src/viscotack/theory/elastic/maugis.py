r"""Maugis-Dugdale: a rigid sphere on an elastic half-space, from long to short range of adhesion.

A constant tension, the ``strength`` :math:`\sigma_0`, acts where the gap is below
:math:`\Delta\gamma_0 / \sigma_0`: in the ring a < r < c around the contact (c the cohesive
radius). The only dimensionless group is :func:`maugis_parameter`; DMT is its small, JKR its large
limit. Range: elastic solid, c small compared with the radius R of the sphere. A smooth traction
of the same strength and work gives nearly the same curve: the pull-off force of a Lennard-Jones
contact differs by up to 6 %.

With m = c/a everything is explicit, so a curve is parametrised by m from near 1 (large load) to
infinity, where the contact is a point; :func:`curve_without_contact` continues it.

Source: Maugis (1992), doi:10.1016/0021-9797(92)90285-T, rederived for a rigid sphere.

**Dimensionless Maugis-Dugdale equations, explicit in c/a and without cancellation.** Contact radius
and cohesive radius in :math:`(\pi R^2 \Delta\gamma_0 / K)^{1/3}`, depth in :math:`(\pi^2
\Delta\gamma_0^2 R / K^2)^{1/3}`, force in :math:`\pi R \Delta\gamma_0`, :math:`K = \frac43 E^*`.
The independent variable is the excess :math:`\varepsilon = c/a - 1`, which is accurate for thin
cohesive zones; :math:`t = \tan\varphi = \sqrt{c^2/a^2 - 1}`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.theory._checks import (
    ROUND_OFF,
    Number,
    Values,
    at_least,
    contact_scales,
    plain,
    positive,
)
from viscotack.theory._roots import halved
from viscotack.theory.elastic import hertz


def angle(excess: Any) -> tuple[Any, Any, Any]:
    """Return m = c/a, t = sqrt(m^2 - 1) and phi = arcsec(m)."""
    t = np.sqrt(excess * (2 + excess))
    return 1 + excess, t, np.arctan(t)


def contact_radius(excess: Any, lam: Any) -> Any:
    r"""Return the contact radius, the positive root of :math:`A a^2 + B a = 1`.

    .. math:: A = \tfrac{\lambda}{2} [t + (m^2 - 2) \varphi], \quad
              B = \tfrac{4 \lambda^2}{3} [t \varphi - m + 1]
    """
    m, t, phi = angle(excess)
    A = lam / 2 * (_tan_excess(t, phi) + t**2 * phi)
    B = 4 * lam**2 / 3 * (t * phi - t**2 / (m + 1))
    return 2 / (B + np.sqrt(B**2 + 4 * A))


def force_and_depth(excess: Any, lam: Any, a: Any) -> tuple[Any, Any]:
    """Return force and depth at a contact radius that satisfies the equation of the gap."""
    m, t, phi = angle(excess)
    return a**3 - lam * a**2 * (t + m**2 * phi), a**2 - 4 / 3 * lam * a * t


def force_slope(excess: Any, lam: Any) -> Any:
    """Return dP/da divided by a along the curve; it changes sign at the force minimum."""
    m, t, phi = angle(excess)
    a = contact_radius(excess, lam)
    q = _shrinkage(excess, lam, a)
    return 3 * a - 2 * lam / t * (q * (1 + t * phi) + t * phi)


def depth_slope(excess: Any, lam: Any) -> Any:
    """Return d(depth)/d(excess) along the curve."""
    m, t, phi = angle(excess)
    a = contact_radius(excess, lam)
    q = _shrinkage(excess, lam, a)
    # c = m a, so that dc = m da + a dm
    da_dm = -a * m / (t**2 - q)
    return (2 * a - 4 / 3 * lam * q / t) * da_dm


def _shrinkage(excess: Any, lam: Any, a: Any) -> Any:
    """Return m dc/da - 1 along the curve, without cancellation for a thin zone."""
    m, t, phi = angle(excess)
    ring = lam * a * (t**2 * phi - _tan_excess(t, phi)) + 4 * lam**2 / 3 * excess
    by_zone = lam * a * (m * phi + t / m) + 4 * lam**2 / 3 * (m * phi / t + 1 / m - 1)
    return ring / (m * by_zone)


def _tan_excess(t: Any, phi: Any) -> Any:
    """Return t - arctan(t), by its series where the difference would cancel."""
    u = np.minimum(t, 0.2)
    series = u**3 * np.polynomial.polynomial.polyval(-(u**2), 1 / np.arange(3.0, 29.0, 2.0))
    return np.where(t < 0.2, series, t - phi)


# Range of the Maugis parameter in which pull-off lies between the bounds of the search below.
_RANGE = (1e-6, 1e6)
_LOG_EXCESS = (-45.0, 30.0)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)


class Point(NamedTuple):
    """A point of the curve: ``contact_radius`` [m], ``cohesive_radius`` [m], depth [m], force [N].

    Returned by :func:`curve`, :func:`curve_without_contact` and :func:`pull_off`.
    """

    contact_radius: Number
    cohesive_radius: Number
    depth: Number
    force: Number


def curve(
    ratio: Values,
    *,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    strength: Values,
) -> Point:
    r"""Return the equilibrium state at a ratio of cohesive to contact radius.

    With :math:`t = \sqrt{m^2 - 1}`, :math:`\varphi = \sec^{-1} m` and the scales of
    :math:`K = \frac43 E^*`: :math:`\bar a` is the positive root of

    .. math:: \tfrac{\lambda}{2} \bar a^2 [t + (m^2 - 2) \varphi]
              + \tfrac{4 \lambda^2}{3} \bar a [t \varphi - m + 1] = 1

    and :math:`\bar P = \bar a^3 - \lambda \bar a^2 (t + m^2 \varphi)`,
    :math:`\bar\delta = \bar a^2 - \frac43 \lambda \bar a t`.

    Parameters
    ----------
    ratio : array_like
        Cohesive over contact radius m = c/a, above 1.
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> state = curve(2.0, **case)
    >>> f"{state.contact_radius * 1e9:.1f} nm, {state.force * 1e9:.1f} nN"
    '37.6 nm, -263.8 nN'
    """
    m = np.asarray(ratio, dtype=float)
    if not np.all(np.isfinite(m) & (m > 1)):
        raise InputError(
            f"ratio must be above 1 (a cohesive ring of no width) and finite, got {np.min(m)}; "
            "for a contact that is a point use curve_without_contact"
        )
    lam = _parameter(radius, contact_modulus, work_of_adhesion, strength)
    return _point(m - 1, lam, radius, contact_modulus, work_of_adhesion)


def touching_radius(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the cohesive radius [m] of the state in which the sphere touches at one point.

    The limit of :func:`curve` for a large ratio, the positive root of

    .. math:: \frac{c^2}{2 R} + \frac{2 \sigma_0 c}{E^*} \left( 1 - \frac2\pi \right)
              = \frac{\Delta\gamma_0}{\sigma_0}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{touching_radius(**case) * 1e9:.1f} nm"
    '57.7 nm'
    """
    R, E, w, s = positive(
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
    )
    b = 2 * s / E * (1 - 2 / np.pi)
    return plain(2 * w / s / (b + np.sqrt(b**2 + 2 * w / (s * R))))


def curve_without_contact(
    cohesive_radius: Values,
    *,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
    strength: Values,
) -> Point:
    r"""Return the equilibrium state with attraction over a cohesive radius [m], without contact.

    A uniform tension over r < c lifts the surface by :math:`2 \sigma_0 c / E^*` at the centre
    and :math:`4 \sigma_0 c / \pi E^*` at c, where the gap is :math:`\Delta\gamma_0/\sigma_0`:

    .. math:: \delta = \frac{c^2}{2R} - \frac{4 \sigma_0 c}{\pi E^*}
              - \frac{\Delta\gamma_0}{\sigma_0}, \quad P = -\pi c^2 \sigma_0

    It is stable with a rigid drive for :math:`c > 4 \sigma_0 R/\pi E^*`.

    Parameters
    ----------
    cohesive_radius : array_like
        c [m], from 0, where the sphere leaves the range of adhesion, to
        :func:`touching_radius`, where the states join :func:`curve`.
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{curve_without_contact(3e-8, **case).force * 1e9:.1f} nN"
    '-56.5 nN'
    """
    R, E, w, s = positive(
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
        strength=strength,
    )
    c = at_least(0, "a cohesive radius is a length", cohesive_radius=cohesive_radius)
    limit = np.asarray(touching_radius(radius=R, contact_modulus=E, work_of_adhesion=w, strength=s))
    if np.any(c > limit * (1 + ROUND_OFF)):
        raise InputError(
            f"cohesive_radius must not exceed the touching radius {np.min(limit):.6g} m, got "
            f"{np.max(c)} m; where the sphere touches use curve"
        )
    d = c**2 / (2 * R) - 4 * s * c / (np.pi * E) - w / s
    return Point(plain(0.0 * d), plain(c + 0.0 * d), plain(d), plain(-np.pi * c**2 * s))


def pressure(
    position: Values,
    *,
    contact_radius: Values,
    cohesive_radius: Values,
    radius: Values,
    contact_modulus: Values,
    strength: Values,
) -> Number:
    r"""Return the pressure [Pa], positive in compression.

    Inside the contact

    .. math:: p = \frac{2 E^*}{\pi R} \sqrt{a^2 - r^2}
              - \frac{2 \sigma_0}{\pi} \arctan \sqrt{\frac{c^2 - a^2}{a^2 - r^2}},

    minus the strength up to c, zero beyond.

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        a [m], not negative.
    cohesive_radius : array_like
        c [m], at least a.
    radius, contact_modulus, strength : array_like
        R of the sphere [m], E* [Pa] and :math:`\sigma_0` [Pa]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> state = dict(contact_radius=4e-8, cohesive_radius=8e-8, radius=1e-6)
    >>> f"{pressure(0.0, contact_modulus=1e9, strength=2e7, **state) / 1e6:.1f} MPa"
    '12.1 MPa'
    """
    s = positive(strength=strength)
    a = at_least(0, "a contact radius is a length", contact_radius=contact_radius)
    c = at_least(a, "it is the outer radius of the ring", cohesive_radius=cohesive_radius)
    p = hertz.pressure(position, contact_radius=a, radius=radius, contact_modulus=contact_modulus)
    r = np.asarray(position, dtype=float)
    inner = np.sqrt(np.maximum((a - r) * (a + r), 0))
    tension = 2 * s / np.pi * np.arctan2(np.sqrt((c - a) * (c + a)), inner)
    return plain(p - np.where(r < a, tension, np.where(r <= c, s, 0.0)))


def maugis_parameter(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the Maugis parameter, dimensionless.

    .. math:: \lambda = \sigma_0 (9 R / 2 \pi \Delta\gamma_0 E^{*2})^{1/3}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{maugis_parameter(**case):.3f}"
    '0.612'
    """
    return plain(_parameter(radius, contact_modulus, work_of_adhesion, strength))


def parameter_from_tabor(tabor: Values) -> Number:
    r"""Return the Maugis parameter of a Lennard-Jones contact, dimensionless.

    Peak tension and work of adhesion are those of the 3-9 traction (Eq. 2.1),
    :math:`\sigma_0 = 16 \Delta\gamma_0 / 9 \sqrt3 h_0`:

    .. math:: \lambda = \frac{16}{9 \sqrt 3} \left( \frac{9}{2 \pi} \right)^{1/3} \mu
              = 1.15701\ldots \mu

    Parameters
    ----------
    tabor : array_like
        Tabor number, positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{parameter_from_tabor(3.24):.4f}"
    '3.7487'
    """
    mu = positive(tabor=tabor)
    return plain(16 / (9 * np.sqrt(3)) * np.cbrt(4.5 / np.pi) * mu)


def pull_off_force(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the pull-off force [N], a positive number between 3/2 and 2 :math:`\pi R w`.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is not positive and finite, or the Maugis parameter is not between 1e-6 and
        1e6.

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
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Point:
    r"""Return the force minimum.

    It always lies on the part of the curve with contact, because the force still rises with a^2
    where the contact shrinks to a point.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Returns
    -------
    Point
        Contact radius [m], cohesive radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a value is not positive and finite, or the Maugis parameter is not between 1e-6 and
        1e6.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{pull_off(**case).contact_radius * 1e9:.1f} nm"
    '36.8 nm'
    """
    lam = _parameter_in_range(radius, contact_modulus, work_of_adhesion, strength)
    return _point(np.exp(_pull_off_log_excess(lam)), lam, radius, contact_modulus, work_of_adhesion)


def work_to_pull_off(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the work [J] of the drive from zero force to the force minimum.

    The integral of P over the depth along retraction (both negative steps in tension), by 64-point
    Gauss quadrature in :math:`\ln(c/a - 1)`.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, strength : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa];
        positive.

    Raises
    ------
    InputError
        If a value is not positive and finite, or the Maugis parameter is not between 1e-6 and
        1e6.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, strength=2e7)
    >>> f"{work_to_pull_off(**case) * 1e18:.0f} aJ"
    '670 aJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    lam = _parameter_in_range(radius, contact_modulus, work_of_adhesion, strength)

    def force(x: Any) -> Any:
        a = contact_radius(np.exp(x), lam)
        return force_and_depth(np.exp(x), lam, a)[0]

    end = _pull_off_log_excess(lam)
    start = halved(force, np.full(lam.shape, _LOG_EXCESS[0]), end)
    x = (start + end)[..., None] / 2 + (end - start)[..., None] / 2 * _NODES
    excess, lam = np.exp(x), lam[..., None]
    P, _ = force_and_depth(excess, lam, contact_radius(excess, lam))
    power = P * depth_slope(excess, lam) * excess
    return plain((power @ _WEIGHTS) * (end - start) / 2 * 0.75 ** (2 / 3) * height * load)


def _parameter(radius: Values, contact_modulus: Values, work: Values, strength: Values) -> Any:
    R, E, w, s = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work, strength=strength
    )
    return s * np.cbrt(9 * R / (2 * np.pi * w * E**2))


def _point(excess: Any, lam: Any, radius: Values, contact_modulus: Values, work: Values) -> Point:
    """Return the state on the curve at an excess c/a - 1."""
    length, height, load = contact_scales(radius, contact_modulus, work)
    a = contact_radius(excess, lam)
    P, d = force_and_depth(excess, lam, a)
    length, height, c = 0.75 ** (1 / 3) * length, 0.75 ** (2 / 3) * height, (1 + excess) * a
    return Point(plain(a * length), plain(c * length), plain(d * height), plain(P * load))


def _parameter_in_range(
    radius: Values, contact_modulus: Values, work: Values, strength: Values
) -> Array:
    lam = _parameter(radius, contact_modulus, work, strength)
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
    return halved(lambda x: force_slope(np.exp(x), lam), low, high)
