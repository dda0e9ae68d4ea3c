r"""JKR: a rigid sphere on an elastic half-space with adhesion of vanishing range.

Range: large Tabor number, elastic solid; for a viscoelastic solid this is the infinitely slow
limit. For a finite range use :mod:`viscotack.theory.elastic.maugis`, without adhesion
:mod:`viscotack.theory.elastic.hertz`.

Along the equilibrium curve the contact radius decreases from the loaded state through the force
minimum (:func:`pull_off`, where a dead load detaches) to the depth minimum
(:func:`instability`, where a rigid drive detaches) and further to zero on an unstable
branch. With the radius R of the sphere, the contact modulus E* and the work of adhesion
:math:`\Delta\gamma_0`, formulas use (Eq. 4.16)

.. math:: \hat a = \frac{a}{(\pi R^2 \Delta\gamma_0 / E^*)^{1/3}}, \quad
          \hat\delta = \frac{\delta}{(\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}}, \quad
          \hat P = \frac{P}{\pi R \Delta\gamma_0}.

A JKR contact is a Hertz contact of the same radius superposed with a flat punch displaced by
:math:`\delta_1 = \sqrt{2 \pi a \Delta\gamma_0 / E^*}`; this gives the pressure, displacement and
gap of its surface.

Source: Johnson, Kendall & Roberts (1971), doi:10.1098/rspa.1971.0141; Eq. 2.3 and 2.4.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, contact_scales, plain, positive

from . import hertz

_LENGTH = "a contact radius is a length"
_SIGN = "a distance from the axis is not negative"
_NO_DEPTH = "below it the contact detaches even from a rigid drive, see instability"
_FAR = 1e30
_NO_FORCE = "a stronger pull detaches, see pull_off_force"


class Point(NamedTuple):
    """A point of the equilibrium curve: ``contact_radius`` [m], ``depth`` [m], ``force`` [N].

    Returned by :func:`pull_off` and :func:`instability`.
    """

    contact_radius: Number
    depth: Number
    force: Number


def force(
    contact_radius: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the force [N], positive in compression, at a contact radius [m] (Eq. 2.3).

    .. math:: P = \frac{4 E^* a^3}{3 R} - \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> P = force(1e-4, radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{P * 1e3:.3f} mN"
    '0.212 mN'
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(4 * E * a**3 / (3 * R) - np.sqrt(8 * np.pi * E * a**3 * w))


def depth(
    contact_radius: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the depth [m], positive into the solid, at a contact radius [m] (Eq. 2.4).

    .. math:: \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi a \Delta\gamma_0}{E^*}}

    Parameters
    ----------
    contact_radius : array_like
        a [m], not negative.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> d = depth(1e-4, radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{d * 1e6:.2f} um"
    '4.40 um'
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    return plain(a**2 / R - np.sqrt(2 * np.pi * a * w / E))


def contact_radius_at_depth(
    depth: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the stable contact radius [m] at a depth [m], for a rigid drive.

    The larger root of :math:`\hat a^2 - \sqrt{2 \hat a} = \hat\delta`, in closed form.

    Parameters
    ----------
    depth : array_like
        Depth [m], not below that of :func:`instability`.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{contact_radius_at_depth(0.0, **case) * 1e6:.1f} um"
    '68.0 um'
    """
    length, height, _ = contact_scales(radius, contact_modulus, work_of_adhesion)
    d = at_least(-0.75 * height, _NO_DEPTH, depth=depth) / height
    # the larger root s = sqrt(a) of s^4 - sqrt(2) s - d = 0 by Ferrari, with the positive root m of
    # the resolvent m^3 + d m - 1/4 = 0; beyond `far` it grows with d^(1/4), to round-off
    far = np.maximum(d, _FAR) / _FAR
    d = np.minimum(d, _FAR)
    C = np.cbrt(1 / 8 + np.sqrt(np.maximum(1 / 64 + d**3 / 27, 0)))
    t = np.sqrt(2 / (4 * (C**2 + d / 3 + (d / (3 * C)) ** 2)))
    # at d = -3/4 round-off may cause a small negative number under the root
    larger = far**0.25 * (t + np.sqrt(np.maximum(2 * np.sqrt(2) / t - t**2, 0))) / 2
    return plain(length * larger**2)


def contact_radius_at_force(
    force: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the stable contact radius [m] at a force [N], for a dead load.

    The larger root of :math:`\frac43 \hat a^3 - \sqrt{8 \hat a^3} = \hat P`.

    Parameters
    ----------
    force : array_like
        Force [N], compression positive, not below minus :func:`pull_off_force`.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> case = dict(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{contact_radius_at_force(0.0, **case) * 1e6:.1f} um"
    '89.1 um'
    """
    length, _, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    P = at_least(-1.5 * load, _NO_FORCE, force=force) / load
    # the larger root c = a^(3/2) of 4/3 c^2 - sqrt(8) c - P = 0
    root = 0.75 * (np.sqrt(2) + np.sqrt(np.maximum(2 + 4 * P / 3, 0)))
    return plain(length * np.cbrt(root**2))


def pull_off_force(*, radius: Values, work_of_adhesion: Values) -> Number:
    r"""Return the pull-off force [N], the positive number :math:`\frac32\pi R\Delta\gamma_0`.

    It is independent of the modulus and holds for both load and depth control.

    Parameters
    ----------
    radius, work_of_adhesion : array_like
        R of the sphere [m] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{pull_off_force(radius=1e-3, work_of_adhesion=0.05) * 1e3:.4f} mN"
    '0.2356 mN'
    """
    R, w = positive(radius=radius, work_of_adhesion=work_of_adhesion)
    return plain(1.5 * np.pi * R * w)


def pull_off(*, radius: Values, contact_modulus: Values, work_of_adhesion: Values) -> Point:
    r"""Return the force minimum: :math:`\hat a^3 = 9/8, \hat\delta = -3^{1/3}/4, \hat P = -3/2`.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> end = pull_off(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{end.contact_radius * 1e6:.1f} um, {end.depth * 1e6:.2f} um, {end.force * 1e3:.4f} mN"
    '56.1 um, -1.05 um, -0.2356 mN'
    """
    length, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    a, d, P = 1.125 ** (1 / 3), -(3 ** (1 / 3)) / 4, -1.5
    return Point(plain(a * length), plain(d * height), plain(P * load))


def instability(*, radius: Values, contact_modulus: Values, work_of_adhesion: Values) -> Point:
    r"""Return the depth minimum: :math:`\hat a = 1/2, \hat\delta = -3/4, \hat P = -5/6`.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> end = instability(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{end.contact_radius * 1e6:.1f} um, {end.depth * 1e6:.2f} um, {end.force * 1e3:.4f} mN"
    '27.0 um, -2.18 um, -0.1309 mN'
    """
    length, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return Point(plain(length / 2), plain(-0.75 * height), plain(-5 / 6 * load))


def work_to_pull_off(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the work [J] of the drive from zero force to the force minimum.

    The integral of P over the depth along retraction,

    .. math:: W = \left(\tfrac98\right)^{2/3} \left(\tfrac35 4^{2/3} - \tfrac25\right)
              \pi R \Delta\gamma_0 (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}
              \quad \text{(Eq. 46)}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> W = work_to_pull_off(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{W * 1e12:.0f} pJ"
    '550 pJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain(1.125 ** (2 / 3) * (0.6 * 4 ** (2 / 3) - 0.4) * load * height)


def work_to_instability(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the work [J] of the drive from zero force to the depth minimum.

    The integral of P over the depth along retraction,

    .. math:: W = \left[ \tfrac35 \left(\tfrac92\right)^{2/3} + \tfrac1{10} \right]
              \pi R \Delta\gamma_0 (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> W = work_to_instability(radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{W * 1e12:.0f} pJ"
    '794 pJ'
    """
    _, height, load = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain((0.6 * 4.5 ** (2 / 3) + 0.1) * load * height)


def pressure(
    position: Values,
    *,
    contact_radius: Values,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the pressure [Pa], positive in compression; zero outside the contact (Eq. 2.9).

    .. math:: p(r) = \frac{2 E^*}{\pi R} \sqrt{a^2 - r^2}
              - \sqrt{\frac{2 E^* a \Delta\gamma_0}{\pi (a^2 - r^2)}}

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        Radius a of an equilibrium state [m], positive.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite, or a position is the contact edge, where the
        tension is infinite.

    Examples
    --------
    >>> state = dict(contact_radius=1e-4, radius=1e-3, contact_modulus=1e6)
    >>> f"{pressure(0.0, work_of_adhesion=0.05, **state) / 1e3:.1f} kPa"
    '45.8 kPa'
    """
    E, w = positive(contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion)
    compression = hertz.pressure(
        position, contact_radius=contact_radius, radius=radius, contact_modulus=E
    )
    a, r = positive(contact_radius=contact_radius), np.asarray(position, dtype=float)
    if np.any(r == a):
        raise InputError("position must not be the contact edge, where the JKR tension is infinite")
    inside = np.where(r < a, (a - r) * (a + r), np.inf)
    return plain(compression - np.sqrt(2 * E * a * w / (np.pi * inside)))


def surface_displacement(
    position: Values,
    *,
    contact_radius: Values,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the displacement of the surface [m], positive into the solid.

    Inside the contact :math:`u = \delta - r^2/2R`, outside the displacement of Hertz minus
    :math:`\delta_1 \frac{2}{\pi} \arcsin(a/r)`.

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        Radius a of an equilibrium state [m], positive.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> state = dict(contact_radius=1e-4, radius=1e-3, contact_modulus=1e6)
    >>> f"{surface_displacement(1.1e-4, work_of_adhesion=0.05, **state) * 1e6:.3f} um"
    '0.256 um'
    """
    a, r, lift = _lift(position, contact_radius, contact_modulus, work_of_adhesion)
    hertzian = hertz.surface_displacement(r, contact_radius=a, radius=radius)
    return plain(hertzian - lift * 2 / np.pi * np.arcsin(a / np.maximum(r, a)))


def gap(
    position: Values,
    *,
    contact_radius: Values,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the gap [m] between sphere and surface; zero inside the contact.

    The gap of Hertz plus :math:`\delta_1 \frac{2}{\pi} \arccos(a/r)`; next to the edge it opens
    as a crack, with :math:`\sqrt{r - a}`, without cancellation.

    Parameters
    ----------
    position : array_like
        Distance r from the axis [m], not negative.
    contact_radius : array_like
        Radius a of an equilibrium state [m], positive.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> state = dict(contact_radius=1e-4, radius=1e-3, contact_modulus=1e6)
    >>> f"{gap(1.1e-4, work_of_adhesion=0.05, **state) * 1e6:.3f} um"
    '1.911 um'
    """
    a, r, lift = _lift(position, contact_radius, contact_modulus, work_of_adhesion)
    angle = np.arctan2(np.sqrt(np.maximum((r - a) * (r + a), 0)), a)
    return plain(hertz.gap(r, contact_radius=a, radius=radius) + lift * 2 / np.pi * angle)


def _lift(
    position: Values, contact_radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> tuple[Any, Any, Any]:
    """Return contact radius [m], distance [m] and the lift of the flat punch [m]."""
    a, E, w = positive(
        contact_radius=contact_radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    r = at_least(0, _SIGN, position=position)
    return a, r, np.sqrt(2 * np.pi * a * w / E)
