r"""Flat punch in the limits of thickness: half-plane and thin layer.

Stress is the mean over the punch, tension positive; the depth of a punch in tension is negative.
:mod:`viscotack.theory.punch.regimes` joins the limits.

Source: Maghami, PhD thesis (2025), Eq. 3.1 to 3.9 and appendix I.
"""

from __future__ import annotations

import warnings

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded
from viscotack.theory._checks import Number, Values, plain, positive

# Largest Poisson ratio of the thin-layer law of a bonded layer (appendix I).
_THIN_POISSON = 0.45


def fracture_length(
    *, contact_modulus: Values, work_of_adhesion: Values, strength: Values
) -> Number:
    r"""Return the half width a0 [m] below which a punch on a half-plane detaches at the strength.

    .. math:: a_0 = \frac{\pi E^* \Delta\gamma_0}{2 \sigma_0^2} \quad \text{(Eq. 3.3)}

    Twice :func:`viscotack.theory.crack.greenwood.cohesive_zone_length`.

    Parameters
    ----------
    contact_modulus, work_of_adhesion, strength : array_like
        E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and :math:`\sigma_0` [Pa]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> a0 = fracture_length(contact_modulus=1e6, work_of_adhesion=0.05, strength=5e4)
    >>> f"{a0 * 1e6:.1f} um"
    '31.4 um'
    """
    E, w, s = positive(
        contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion, strength=strength
    )
    return plain(np.pi * E * w / (2 * s**2))


def half_plane_pull_off_stress(
    half_width: Values, *, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the mean pull-off stress [Pa] of a punch on a half-plane.

    .. math:: \bar\sigma_{po} = \sqrt{\frac{\pi E^* \Delta\gamma_0}{2 a}} \quad \text{(Eq. 3.2)}

    Range: a well above :func:`fracture_length`. Times 2a it is the force per length, Eq. 3.1.

    Parameters
    ----------
    half_width : array_like
        a [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> s = half_plane_pull_off_stress(1e-3, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{s / 1e3:.2f} kPa"
    '8.86 kPa'
    """
    a, E, w = positive(
        half_width=half_width, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(np.sqrt(np.pi * E * w / (2 * a)))


def thin_layer_pull_off_stress(
    thickness: Values, *, contact_modulus: Values, work_of_adhesion: Values, base: Base
) -> Number:
    r"""Return the mean pull-off stress [Pa] of a wide punch on a thin layer.

    .. math:: \bar\sigma_{po} = \sqrt{\frac{2 \zeta E^* \Delta\gamma_0}{b}}
              \quad \text{(Eq. 3.9, appendix I)}

    Range: b0 < b << a; too low by a fraction 0.177 b/a on a frictionless base. A bonded layer with
    a Poisson ratio above 0.45 causes a ``UserWarning``.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> layer = dict(contact_modulus=1e6, work_of_adhesion=0.05)
    >>> free = thin_layer_pull_off_stress(1e-4, **layer, base=Frictionless())
    >>> glued = thin_layer_pull_off_stress(1e-4, **layer, base=Bonded(poisson_ratio=0.4))
    >>> f"{free / 1e3:.1f} kPa, glued {glued / 1e3:.1f} kPa"
    '31.6 kPa, glued 42.4 kPa'
    """
    b, E, w = positive(
        thickness=thickness, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(np.sqrt(2 * stiffening(base) * E * w / b))


def thin_layer_depth_at_pull_off(
    thickness: Values, *, contact_modulus: Values, work_of_adhesion: Values, base: Base
) -> Number:
    r"""Return the depth at pull-off [m] of a wide punch on a thin layer, negative.

    .. math:: \delta_{po} = -\sqrt{\frac{2 b \Delta\gamma_0}{\zeta E^*}} \quad \text{(Eq. 3.9)}

    Exact up to terms of the order exp(-2 pi a/b) on a frictionless base. Otherwise as
    :func:`thin_layer_pull_off_stress`.

    Parameters
    ----------
    thickness : array_like
        b [m], positive.
    contact_modulus, work_of_adhesion : array_like
        E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> layer = dict(contact_modulus=1e6, work_of_adhesion=0.05, base=Frictionless())
    >>> f"{thin_layer_depth_at_pull_off(1e-4, **layer) * 1e6:.2f} um"
    '-3.16 um'
    """
    b, E, w = positive(
        thickness=thickness, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    return plain(-np.sqrt(2 * b * w / (stiffening(base) * E)))


def stiffening(base: Base) -> float:
    r"""Return zeta, the ratio of a thin layer's stiffness to that on a frictionless base.

    .. math:: \zeta = \frac{(1 - \nu)^2}{1 - 2 \nu} \quad \text{(bonded, appendix I)}

    Issues a ``UserWarning`` for a Poisson ratio above 0.45, where only extremely thin
    layers obey the thin-layer law.

    Parameters
    ----------
    base : Frictionless or Bonded
        Boundary condition of the layer on its base; the Poisson ratio of a bonded one is below
        0.5.

    Raises
    ------
    InputError
        If a bonded layer has a Poisson ratio of 0.5, for which the thin-layer law does not exist.

    Examples
    --------
    >>> f"{stiffening(Bonded(poisson_ratio=0.3)):.3f}"
    '1.225'
    """
    if base.foundation == 0:
        raise InputError(
            "the thin-layer law does not apply to a bonded layer with a Poisson ratio of 0.5, "
            "which stretches only by sideways flow"
        )
    if isinstance(base, Bonded) and base.poisson_ratio > _THIN_POISSON:
        warnings.warn(
            "the thin-layer law of a bonded layer needs a Poisson ratio of at most "
            f"{_THIN_POISSON}, got {base.poisson_ratio}: use theory.punch.crossover",
            UserWarning,
            stacklevel=3,
        )
    return 1 / base.foundation
