r"""Rigid wavy sphere on an elastic half-space (Guduru): waves can increase the pull-off force.

The profile :math:`f = r^2/2R + A (1 - \cos k r)` with :math:`k = 2\pi/\lambda`
(:class:`viscotack.model.geometry.WavySphere`), in full contact inside the radius a, has with
Struve's functions H the depth and the force

.. math:: \delta = \frac{a^2}{R} + \frac{\pi}{2} A k a\, H_0(k a)
                   - \sqrt{2 \pi a \Delta\gamma_0/E^*},

.. math:: P = \frac{4 E^* a^3}{3 R} + \pi E^* A a \left[k a\, H_0(k a) - H_1(k a)\right]
              - \sqrt{8 \pi E^* a^3 \Delta\gamma_0}

Depth and force oscillate with a. During separation the edge is held at each crest and snaps to the
next; the energy released by a snap is lost. The pull-off force is the largest of all maxima of the
tension. It may be several times that of the smooth sphere.

Range: short-range adhesion and a contact without holes, as after a firm preload on waves that are
not too steep. The solid is elastic and separation slow; in a viscoelastic solid the gain in force
decreases with the speed.

Source: Guduru (2007), J. Mech. Phys. Solids 55, 445, doi:10.1016/j.jmps.2006.09.002.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy

from viscotack.errors import OutOfRange
from viscotack.theory._checks import Number, Values, at_least, plain, positive

from .jkr import Point

_LENGTH = "a contact radius is a length"
# Number of radii per wave at which the force is evaluated in the search for its minima.
_PER_WAVE = 32
# Most radii of that search; they take half a minute and 200 MB.
_MOST_RADII = 3e6


def depth(
    contact_radius: Values,
    *,
    radius: Values,
    amplitude: Values,
    wavelength: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the depth [m] of the tip at a contact radius [m].

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], not negative.
    radius, amplitude, wavelength : float or array_like
        Radius R of the sphere, amplitude A and wavelength of the waves [m]; positive.
    contact_modulus : float or array_like
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float or array_like
        Work of adhesion [J/m^2], positive.

    Returns
    -------
    float or ndarray
        Depth [m], positive into the body.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> waves = dict(radius=0.2, amplitude=1e-6, wavelength=1e-3)
    >>> solid = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{depth(3e-3, **waves, **solid) * 1e6:.2f} um"
    '11.43 um'
    """
    R, A, wave, E, w = _checked(radius, amplitude, wavelength, contact_modulus, work_of_adhesion)
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    k = 2 * np.pi / wave
    waves = np.pi / 2 * A * k * a * scipy.special.struve(0, k * a)
    return plain(a**2 / R + waves - np.sqrt(2 * np.pi * a * w / E))


def force(
    contact_radius: Values,
    *,
    radius: Values,
    amplitude: Values,
    wavelength: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return the force [N] at a contact radius [m], positive in compression.

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], not negative.
    radius, amplitude, wavelength : float or array_like
        Radius R of the sphere, amplitude A and wavelength of the waves [m]; positive.
    contact_modulus : float or array_like
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float or array_like
        Work of adhesion [J/m^2], positive.

    Returns
    -------
    float or ndarray
        Force [N], negative in tension.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> waves = dict(radius=0.2, amplitude=1e-6, wavelength=1e-3)
    >>> solid = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{force(3e-3, **waves, **solid) * 1e3:.1f} mN"
    '-26.2 mN'
    """
    R, A, wave, E, w = _checked(radius, amplitude, wavelength, contact_modulus, work_of_adhesion)
    a = at_least(0, _LENGTH, contact_radius=contact_radius)
    k = 2 * np.pi / wave
    waves = (
        np.pi
        * E
        * A
        * a
        * (k * a * scipy.special.struve(0, k * a) - scipy.special.struve(1, k * a))
    )
    return plain(4 / 3 * E * a**3 / R + waves - np.sqrt(8 * np.pi * E * a**3 * w))


def pull_off(
    *,
    radius: float,
    amplitude: float,
    wavelength: float,
    contact_modulus: float,
    work_of_adhesion: float,
) -> Point:
    r"""Return the point of smallest force, at which a dead load detaches a contact without holes.

    The arguments are numbers, not arrays.

    Parameters
    ----------
    radius, amplitude, wavelength : float
        Radius R of the sphere, amplitude A and wavelength of the waves [m]; positive.
    contact_modulus : float
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float
        Work of adhesion [J/m^2], positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N] at pull-off; the force is negative.

    Raises
    ------
    InputError
        If a value is not positive and finite, or the radii of the search hold 90,000 waves.

    Examples
    --------
    >>> waves = dict(radius=0.2, amplitude=1e-6, wavelength=1e-3)
    >>> solid = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> end = pull_off(**waves, **solid)
    >>> f"{end.force * 1e3:.1f} mN, {-end.force / (1.5 * np.pi * 0.2 * 0.05):.2f} of a sphere's"
    "-63.2 mN, 1.34 of a sphere's"
    """
    R, A, wave, E, w = _checked(radius, amplitude, wavelength, contact_modulus, work_of_adhesion)
    case: dict[str, Any] = {
        "radius": R,
        "amplitude": A,
        "wavelength": wave,
        "contact_modulus": E,
        "work_of_adhesion": w,
    }
    # Beyond these radii half of the sphere force exceeds adhesion, and the other half the waves.
    adhesion = np.cbrt(18 * np.pi * R**2 * w / E)
    most = max(float(adhesion), float(1.5 * np.pi * 2 * np.pi / wave * A * R), float(wave))
    many = _PER_WAVE * most / wave
    if not many < _MOST_RADII:
        raise OutOfRange(f"pull-off is searched for over {most / wave:.2g} waves; check the units")
    a = np.linspace(0.0, most, max(int(many), 256))
    least = int(np.argmin(force(a, **case)))
    found: Any = scipy.optimize.minimize_scalar(
        lambda x: force(x, **case),
        bounds=(a[max(least - 1, 0)], a[least + 1]),
        method="bounded",
        options={"xatol": 1e-9 * a[least + 1]},
    )
    at = float(found.x)
    return Point(at, float(depth(at, **case)), float(force(at, **case)))


def _checked(radius: Any, amplitude: Any, wavelength: Any, modulus: Any, work: Any) -> Any:
    return positive(
        radius=radius,
        amplitude=amplitude,
        wavelength=wavelength,
        contact_modulus=modulus,
        work_of_adhesion=work,
    )
