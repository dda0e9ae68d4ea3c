r"""Hertz: a rigid sphere pressed into an elastic half-space without adhesion.

Range: contact radius small compared with R (parabolic profile), no adhesion. With short-range
adhesion use :mod:`viscotack.theory.elastic.jkr`, with long-range adhesion
:mod:`viscotack.theory.elastic.dmt`.

Source: Hertz (1882), doi:10.1515/crll.1882.92.156.
"""

from __future__ import annotations

import numpy as np
import scipy

from viscotack.theory._checks import Number, Values, at_least, plain, positive

_SIGN = "a length from the axis is not negative"


def force(contact_radius: Values, *, radius: Values, contact_modulus: Values) -> Number:
    r"""Return the force [N] at a contact radius [m].

    .. math:: P = \frac{4 E^* a^3}{3 R}

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius, contact_modulus : array_like
        R of the sphere [m] and E* [Pa]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{force(1e-4, radius=1e-3, contact_modulus=1e6) * 1e3:.3f} mN"
    '1.333 mN'
    """
    R, E = positive(radius=radius, contact_modulus=contact_modulus)
    a = at_least(0, _SIGN, contact_radius=contact_radius)
    return plain(4 * E * a**3 / (3 * R))


def depth(contact_radius: Values, *, radius: Values) -> Number:
    r"""Return the depth [m] at a contact radius [m], :math:`\delta = a^2 / R`.

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{depth(1e-4, radius=1e-3) * 1e6:.1f} um"
    '10.0 um'
    """
    R = positive(radius=radius)
    a = at_least(0, _SIGN, contact_radius=contact_radius)
    return plain(a**2 / R)


def contact_radius_at_depth(depth: Values, *, radius: Values) -> Number:
    r"""Return the contact radius [m] at a depth [m], :math:`\sqrt{R \delta}`.

    Parameters
    ----------
    depth : array_like
        Depth [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{contact_radius_at_depth(1e-5, radius=1e-3) * 1e6:.1f} um"
    '100.0 um'
    """
    R = positive(radius=radius)
    d = at_least(0, "without adhesion there is no contact above the surface", depth=depth)
    return plain(np.sqrt(R * d))


def contact_radius_at_force(force: Values, *, radius: Values, contact_modulus: Values) -> Number:
    r"""Return the contact radius [m] under a force [N].

    .. math:: a = \left( \frac{3 P R}{4 E^*} \right)^{1/3}

    Parameters
    ----------
    force : array_like
        Force [N], compression positive; not negative.
    radius, contact_modulus : array_like
        R of the sphere [m] and E* [Pa]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{contact_radius_at_force(1e-3, radius=1e-3, contact_modulus=1e6) * 1e6:.1f} um"
    '90.9 um'
    """
    R, E = positive(radius=radius, contact_modulus=contact_modulus)
    P = at_least(0, "without adhesion a contact carries no tension", force=force)
    return plain(np.cbrt(3 * P * R / (4 * E)))


def pressure(
    position: Values, *, contact_radius: Values, radius: Values, contact_modulus: Values
) -> Number:
    r"""Return the pressure [Pa], positive in compression; zero outside the contact.

    .. math:: p(r) = \frac{2 E^*}{\pi R} \sqrt{a^2 - r^2}

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        a [m], not negative.
    radius, contact_modulus : array_like
        R of the sphere [m] and E* [Pa]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{pressure(0.0, contact_radius=1e-4, radius=1e-3, contact_modulus=1e6) / 1e3:.1f} kPa"
    '63.7 kPa'
    """
    R, E = positive(radius=radius, contact_modulus=contact_modulus)
    a = at_least(0, _SIGN, contact_radius=contact_radius)
    r = at_least(0, _SIGN, position=position)
    return plain(2 * E / (np.pi * R) * np.sqrt(np.maximum((a - r) * (a + r), 0)))


def surface_displacement(position: Values, *, contact_radius: Values, radius: Values) -> Number:
    r"""Return the displacement of the surface [m], positive into the solid.

    Inside the contact :math:`u = a^2/R - r^2/2R`, outside

    .. math:: u = \frac{1}{\pi R} \left[ (2 a^2 - r^2) \arcsin\frac{a}{r}
              + a \sqrt{r^2 - a^2} \right]

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        a [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    Far away the contact acts like a point force, P / (pi E* r):

    >>> f"{surface_displacement(1e-2, contact_radius=1e-4, radius=1e-3) * 1e9:.2f} nm"
    '42.44 nm'
    """
    R = positive(radius=radius)
    a = at_least(0, _SIGN, contact_radius=contact_radius)
    r = at_least(0, _SIGN, position=position)
    s = a / np.where(r > a, r, np.where(a > 0, a, 1.0))
    # The incomplete beta function is asin(s) - s sqrt(1 - s^2) without its cancellation far away.
    outside = a**2 * 2 * np.arcsin(s) - r**2 * (np.pi / 2) * scipy.special.betainc(1.5, 0.5, s**2)
    return plain(np.where(r <= a, (2 * a**2 - r**2) / (2 * R), outside / (np.pi * R)))


def gap(position: Values, *, contact_radius: Values, radius: Values) -> Number:
    r"""Return the gap [m] between sphere and surface; zero inside the contact.

    With :math:`\varphi = \arccos(a/r)` outside the contact

    .. math:: g = \frac{r^2}{2 \pi R} \left( \sin 2\varphi - 2 \varphi \cos 2\varphi \right),

    which is accurate next to the edge, where the gap grows as :math:`(r - a)^{3/2}`.

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        a [m], not negative.
    radius : array_like
        R of the sphere [m], positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> f"{gap(1.1e-4, contact_radius=1e-4, radius=1e-3) * 1e9:.1f} nm"
    '378.1 nm'
    """
    R = positive(radius=radius)
    a = at_least(0, _SIGN, contact_radius=contact_radius)
    r = at_least(0, _SIGN, position=position)
    x = 2 * np.arctan2(np.sqrt(np.maximum((r - a) * (r + a), 0)), a)
    # sin x - x cos x = x^2 j1(x), with the spherical Bessel function
    return plain(r**2 / (2 * np.pi * R) * x**2 * scipy.special.spherical_jn(1, x))
