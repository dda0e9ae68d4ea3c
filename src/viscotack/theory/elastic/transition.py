r"""Carpick's equation: interpolation between DMT and JKR for fits to tip experiments.

Carpick, Ogletree and Salmeron express the contact radius under a load P as

.. math:: \frac{a}{a_0} = \left( \frac{\alpha + \sqrt{1 + P/P_{po}}}{1 + \alpha} \right)^{2/3}

with the contact radius a0 without load, the pull-off force and a ``transition`` number alpha, 0
for DMT and 1 for JKR. With the fits to the Maugis-Dugdale solution below, force and radius are
within 2 % of :mod:`viscotack.theory.elastic.maugis` where the contact is stable under load.

Source: Carpick, Ogletree & Salmeron (1999), doi:10.1006/jcis.1998.6027.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, at_least, contact_scales, plain, positive


def contact_radius(
    force: Values,
    *,
    contact_radius_without_load: Values,
    pull_off_force: Values,
    transition: Values,
) -> Number:
    r"""Return the contact radius [m] under a force [N].

    Parameters
    ----------
    force : array_like
        Force P [N], compression positive, not below minus `pull_off_force`.
    contact_radius_without_load, pull_off_force : array_like
        a0 [m] and :math:`P_{po}` [N]; positive.
    transition : array_like
        alpha, from 0 (DMT) to 1 (JKR).

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> tip = dict(contact_radius_without_load=1e-8, pull_off_force=2e-8, transition=0.5)
    >>> f"{contact_radius(2e-8, **tip) * 1e9:.2f} nm"
    '11.77 nm'
    """
    a0, Pc = positive(
        contact_radius_without_load=contact_radius_without_load, pull_off_force=pull_off_force
    )
    alpha = _transition(transition)
    P = at_least(-Pc, "a stronger pull detaches", force=force)
    root = np.sqrt(np.maximum(1 + P / Pc, 0))
    return plain(a0 * np.cbrt(((alpha + root) / (1 + alpha)) ** 2))


def maugis_parameter(transition: Values) -> Number:
    r"""Return the dimensionless Maugis parameter, :math:`\lambda = -0.924 \ln(1 - 1.02 \alpha)`.

    Parameters
    ----------
    transition : array_like
        alpha, from 0 to below 1/1.02, where :math:`\lambda` is infinite.

    Raises
    ------
    InputError
        If the transition number is outside its range.

    Examples
    --------
    >>> f"{maugis_parameter(0.5):.3f}"
    '0.659'
    """
    alpha = _transition(transition)
    if np.any(1.02 * alpha >= 1):
        raise InputError(
            f"transition must be below 1/1.02 = 0.98, got {np.max(alpha)}: beyond that the fit has "
            "no Maugis parameter; use theory.jkr"
        )
    return plain(-0.924 * np.log1p(-1.02 * alpha))


def transition(maugis_parameter: Values) -> Number:
    r"""Return the transition number (dimensionless), the inverse of :func:`maugis_parameter`.

    At most 1/1.02: the fit does not cover the last 2 % before JKR.

    Parameters
    ----------
    maugis_parameter : array_like
        :math:`\lambda`, positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{transition(0.5):.3f}"
    '0.410'
    """
    lam = positive(maugis_parameter=maugis_parameter)
    return plain(-np.expm1(-lam / 0.924) / 1.02)


def pull_off_force(maugis_parameter: Values, *, radius: Values, work_of_adhesion: Values) -> Number:
    r"""Return the pull-off force [N] by the fit to Maugis-Dugdale, within 2 %.

    .. math:: \frac{P_{po}}{\pi R \Delta\gamma_0} = \frac74
              - \frac14 \, \frac{4.04 \lambda^{1.4} - 1}{4.04 \lambda^{1.4} + 1}

    Parameters
    ----------
    maugis_parameter : array_like
        :math:`\lambda`, positive.
    radius, work_of_adhesion : array_like
        R of the sphere [m] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> f"{pull_off_force(0.5, radius=1e-6, work_of_adhesion=0.05) * 1e9:.1f} nN"
    '266.7 nN'
    """
    lam, R, w = positive(
        maugis_parameter=maugis_parameter, radius=radius, work_of_adhesion=work_of_adhesion
    )
    return plain(np.pi * R * w * (7 / 4 - _step(4.04 * lam**1.4) / 4))


def contact_radius_without_load(
    maugis_parameter: Values, *, radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Number:
    r"""Return the contact radius [m] without load by the fit to Maugis-Dugdale, within 2 %.

    .. math:: \frac{a_0}{(3 \pi R^2 \Delta\gamma_0/4 E^*)^{1/3}} = 1.54 + 0.279 \,
              \frac{2.28 \lambda^{1.3} - 1}{2.28 \lambda^{1.3} + 1}

    Parameters
    ----------
    maugis_parameter : array_like
        :math:`\lambda`, positive.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], E* [Pa] and :math:`\Delta\gamma_0` [J/m^2]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> case = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05)
    >>> f"{contact_radius_without_load(0.5, **case) * 1e9:.1f} nm"
    '75.0 nm'
    """
    lam = positive(maugis_parameter=maugis_parameter)
    length, _, _ = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain(np.cbrt(0.75) * length * (1.54 + 0.279 * _step(2.28 * lam**1.3)))


def _transition(value: Any) -> Any:
    alpha = at_least(0, "0 is DMT and 1 is JKR", transition=value)
    if np.any(alpha > 1):
        raise InputError(f"transition must lie between 0 (DMT) and 1 (JKR), got {np.max(alpha)}")
    return alpha


def _step(x: Any) -> Any:
    return (x - 1) / (x + 1)
