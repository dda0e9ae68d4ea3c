r"""Surface energy and work from the retraction curve of a flat punch on a layer.

The curve may be simulated or measured. Stress is the force over the area of the punch, tension
positive.

Source: Maghami, PhD thesis (2025), Eq. 3.29, 3.30 and 3.36.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import Base
from viscotack.theory._checks import Number, Values, plain, positive

from .crossover import curve


def surface_energy(
    pull_off_stress: Values,
    *,
    thickness: Values,
    half_width: Values,
    ligament: Values,
    contact_modulus: Values,
    base: Base,
) -> Number:
    r"""Compute the surface energy [J/m^2] from a measured pull-off stress.

    Eq. 3.29 without its restriction to thin layers: an elastic contact with the width of the
    ligament at pull-off carries the force :math:`2 a \bar\sigma_{po}`.

    Parameters
    ----------
    pull_off_stress : array_like
        Largest tensile force over the area of the punch [Pa], positive.
    thickness, half_width : array_like
        b and a [m], positive.
    ligament : array_like
        Half width :math:`a_c` [m] still in contact at pull-off, positive, at most a.
    contact_modulus : array_like
        Rubbery E0* [Pa], positive.
    base : Frictionless or Bonded
        Boundary condition of the layer; the Poisson ratio of a bonded one is at most 0.49.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(thickness=5e-3, half_width=1e-3, contact_modulus=1e6, base=Frictionless())
    >>> f"{surface_energy(2e4, ligament=0.9e-3, **pad):.3f} J/m^2"
    '0.274 J/m^2'
    """
    on_ligament, b, _, c, E = _checked(
        pull_off_stress, thickness, half_width, ligament, contact_modulus
    )
    _, stress = curve(base)(c / b)
    return plain((on_ligament / stress) ** 2 * c / E)


def thin_layer_surface_energy(
    pull_off_stress: Values,
    *,
    thickness: Values,
    half_width: Values,
    ligament: Values,
    contact_modulus: Values,
    base: Base,
) -> Number:
    r"""Compute the surface energy [J/m^2] from a measured pull-off stress, for a thin layer.

    .. math:: \Delta\gamma_{eff} = \frac{\bar\sigma_{po}^2 b}{2 \zeta E_0^*}
              \left( \frac{a}{a_c} \right)^2

    Eq. 3.29, and 3.30 over the work of adhesion. :func:`surface_energy` holds for every
    thickness. Issues a ``UserWarning`` for a layer thicker than :math:`b_1 = 4
    \zeta a/\pi`, where this formula overestimates the energy.

    Parameters
    ----------
    pull_off_stress : array_like
        Largest tensile force over the area of the punch [Pa], positive.
    thickness, half_width : array_like
        b and a [m], positive.
    ligament : array_like
        Half width :math:`a_c` [m] still in contact at pull-off, positive, at most a.
    contact_modulus : array_like
        Rubbery E0* [Pa], positive.
    base : Frictionless or Bonded
        Boundary condition of the layer; the Poisson ratio of a bonded one is below 0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> pad = dict(thickness=1e-4, half_width=1e-3, contact_modulus=1e6, base=Frictionless())
    >>> f"{thin_layer_surface_energy(4e4, ligament=0.9e-3, **pad):.4f} J/m^2"
    '0.0988 J/m^2'
    """
    on_ligament, b, a, _, E = _checked(
        pull_off_stress, thickness, half_width, ligament, contact_modulus
    )
    if base.foundation == 0:
        raise InputError(
            "the thin-layer formula does not apply to a bonded layer with a Poisson ratio of 0.5, "
            "which stretches only by sideways flow"
        )
    if np.any(b * base.foundation > 4 / np.pi * a):
        warnings.warn(
            "the layer is thicker than b1 = 4 zeta a/pi, where the thin-layer formula "
            "overestimates the surface energy: use theory.punch.curve.surface_energy",
            UserWarning,
            stacklevel=2,
        )
    return plain(on_ligament**2 * b * base.foundation / (2 * E))


def work_of_separation(depth: Values, stress: Values) -> float:
    r"""Compute the work of separation [J/m^2] of a punch, per area, from a retraction curve.

    .. math:: w_{sep} = \int_{-\infty}^{\delta_P} \bar\sigma \, d\delta

    from the last zero of the force before its maximum, at :math:`\delta_P`, to the end of the
    curve (Eq. 3.36, whose limits and scale are misprinted; over the work of adhesion it is
    :math:`\hat w_{sep}`), or from a start in tension.

    Parameters
    ----------
    depth : array_like, shape (N,)
        Depth [m], positive into the layer, in order of time; decreasing in retraction.
    stress : array_like, shape (N,)
        Mean stress [Pa], tension positive.

    Raises
    ------
    InputError
        If depth and stress have different shapes, are not finite, or there is no tension.

    Notes
    -----
    Trapezoidal rule, second order in the step. For the elastic layer see
    :func:`viscotack.theory.punch.crossover.work_of_separation`.

    Examples
    --------
    An elastic layer, 10 kPa/um, that detaches at 3 um:

    >>> w = work_of_separation([1e-6, -1e-6, -3e-6, -3e-6], [-1e4, 1e4, 3e4, 0.0])
    >>> f"{w:.3f} J/m^2"
    '0.045 J/m^2'
    """
    d, s = np.asarray(depth, dtype=float), np.asarray(stress, dtype=float)
    if d.ndim != 1 or d.shape != s.shape or d.size < 2:
        raise InputError(
            f"depth and stress must be two lists of one length, got shapes {d.shape} and {s.shape}"
        )
    if not (np.all(np.isfinite(d)) and np.all(np.isfinite(s))):
        raise InputError("depth and stress must be finite; remove missing values")
    top = int(np.argmax(s))
    if s[top] <= 0:
        raise InputError(f"the curve has no tension; its largest stress is {s[top]:.6g} Pa")
    pressed = np.flatnonzero(s[:top] <= 0)
    if pressed.size:
        i = int(pressed[-1])
        zero = d[i] + (d[i + 1] - d[i]) * s[i] / (s[i] - s[i + 1])
        d, s = np.append(zero, d[i + 1 :]), np.append(0.0, s[i + 1 :])
    return -float(np.sum((s[1:] + s[:-1]) / 2 * np.diff(d)))


def _checked(
    pull_off_stress: Values,
    thickness: Values,
    half_width: Values,
    ligament: Values,
    contact_modulus: Values,
) -> Any:
    """Return the mean stress on the ligament, b, a, the ligament and E*."""
    s, b, a, c, E = positive(
        pull_off_stress=pull_off_stress,
        thickness=thickness,
        half_width=half_width,
        ligament=ligament,
        contact_modulus=contact_modulus,
    )
    if np.any(c > a):
        raise InputError(
            "ligament (the half width still in contact) must not exceed the half width of the punch"
        )
    return s * a / c, b, a, c, E
