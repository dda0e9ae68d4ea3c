r"""What a JKR contact does to the surface: pressure, displacement and gap at a distance.

A JKR contact is a Hertz contact of the same radius lifted by a flat punch, by
:math:`\delta_1 = \sqrt{2 \pi a \Delta\gamma_0 / E^*}`. The functions are reached as
``jkr.pressure`` and so on. ``position`` is the distance r from the axis [m], ``contact_radius``
the radius a [m] of an equilibrium state; other parameters, signs, range and source as in
:mod:`viscotack.theory.elastic.jkr`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.theory._checks import Number, at_least, plain, positive

from . import hertz

_SIGN = "a distance from the axis is not negative"


def pressure(
    position: npt.ArrayLike,
    *,
    contact_radius: npt.ArrayLike,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the pressure [Pa], positive in compression; zero outside the contact (Eq. 2.9).

    .. math:: p(r) = \frac{2 E^*}{\pi R} \sqrt{a^2 - r^2}
              - \sqrt{\frac{2 E^* a \Delta\gamma_0}{\pi (a^2 - r^2)}}

    The pressure has no value at the edge itself, where the tension is infinite.

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
    position: npt.ArrayLike,
    *,
    contact_radius: npt.ArrayLike,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the displacement of the surface [m], positive into the solid.

    Inside the contact :math:`u = \delta - r^2/2R`, outside the displacement of Hertz minus
    :math:`\delta_1 \frac{2}{\pi} \arcsin(a/r)`.

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
    position: npt.ArrayLike,
    *,
    contact_radius: npt.ArrayLike,
    radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> Number:
    r"""Return the gap [m] between sphere and surface; zero inside the contact.

    The gap of Hertz plus :math:`\delta_1 \frac{2}{\pi} \arccos(a/r)`; next to the edge it opens
    as a crack, with :math:`\sqrt{r - a}`, and all digits are kept.

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
    position: npt.ArrayLike,
    contact_radius: npt.ArrayLike,
    contact_modulus: npt.ArrayLike,
    work_of_adhesion: npt.ArrayLike,
) -> tuple[Any, Any, Any]:
    """Return contact radius [m], distance [m] and the lift of the flat punch [m]."""
    a, E, w = positive(
        contact_radius=contact_radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    r = at_least(0, _SIGN, position=position)
    return a, r, np.sqrt(2 * np.pi * a * w / E)
