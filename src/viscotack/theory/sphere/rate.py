r"""Crack speed at pull-off from the unloading rate: the fit of the thesis.

.. math:: \hat v = 2.887 \, \hat r^{1.171}, \quad \hat v = v \tau_0 / l_0 \quad \text{(Eq. 4.24)}

was fitted to simulations of a sphere. The definition of :math:`\hat r` has three interpretations:

- as printed, :func:`rate_in_tip_lengths`, :math:`r \tau_0 / l_0`;
- as in the authors' published script, :func:`rate_as_published`,
  :math:`\hat r_u / (3.24 \pi^{2/3})` with :math:`\hat r_u = r \tau_0/h_0`, for every row;
- the same with the Tabor number of the case, :func:`rate_in_contact_heights`,
  :math:`r \tau_0 / (\pi^2 \Delta\gamma_0^2 R / E_0^{*2})^{1/3}`, the scale of depth of Eq. 4.16.

The last two agree at mu = 3.24, the only Tabor number of the fit; the first agrees with neither
unless :math:`l_0` equals the depth scale. Range of the fit: mu = 3.24, modulus ratios 0.01
to 0.1, exponents 0.4 to 1.6, preload above the threshold, crack speeds over some 10 decades. The
simulated speed of a standard solid (k = 0.1, mu = 3.24) is 0.9 to 3 times the fitted one.

For simulations over Tabor numbers 0.3 to 8, modulus ratios 1e-3 to 0.3 and rates 0.1 to 1e8, nine
of ten cases differ by up to a factor of 7, and by 40 with the Tabor number of the case; in the
range of the fit by 5. The fit reproduces the authors' tables. For
predictions use :mod:`viscotack.theory.sphere.detachment`, which differs by 1.25 in speed.

Source: Maghami, PhD thesis (2025), Eq. 4.24, published as doi:10.1016/j.jmps.2024.105844.
"""

from __future__ import annotations

import warnings

import numpy as np

from viscotack.theory._checks import Number, Values, at_least, contact_scales, plain, positive

COEFFICIENT, EXPONENT = 2.887, 1.171
FITTED_TABOR = 3.24
# Ratio to the Tabor number of the fit above which a warning is issued.
_NEAR = 1.25


def crack_speed(rate: Values, *, tabor: Values) -> Number:
    r"""Return the dimensionless crack speed at pull-off from a dimensionless rate (Eq. 4.24).

    Parameters
    ----------
    rate : array_like
        :math:`\hat r` by one of the three functions below, not negative.
    tabor : array_like
        Tabor number of the case. It has no effect; a ``UserWarning`` is issued if it differs from
        the 3.24 of the fit by more than a quarter.

    Raises
    ------
    InputError
        If the rate is negative, the Tabor number is not positive, or one of them is not finite.

    Examples
    --------
    >>> f"{crack_speed(10.0, tabor=3.24):.2f}"
    '42.80'
    """
    mu = positive(tabor=tabor)
    r = at_least(0, "a rate of unloading is not negative", rate=rate)
    far = np.abs(np.log(mu / FITTED_TABOR)) > np.log(_NEAR)
    if np.any(far):
        warnings.warn(
            f"the fit of crack speed to rate was made only at a Tabor number of {FITTED_TABOR}; "
            f"this one is {np.ravel(mu)[np.argmax(np.ravel(far))]:.3g}; use theory.unloading "
            "instead",
            UserWarning,
            stacklevel=2,
        )
    return plain(COEFFICIENT * r**EXPONENT)


def rate_in_tip_lengths(speed: Values, *, time_unit: Values, tip_length: Values) -> Number:
    r"""Return :math:`r \tau_0 / l_0`, the rate of Eq. 4.24 as printed, from a speed [m/s].

    Parameters
    ----------
    speed : array_like
        Retraction speed r [m/s], not negative.
    time_unit, tip_length : array_like
        :math:`\tau_0` [s] and :math:`l_0` [m] of
        :func:`viscotack.theory.crack.persson_brener.crack_tip_length`; positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    The thesis's 31.4 m/s, at which a silicone would reach a crack speed of 1e9:

    >>> rate = rate_in_tip_lengths(31.36, time_unit=0.01876, tip_length=30.03e-9)
    >>> f"{crack_speed(rate, tabor=3.24):.2e}"
    '9.99e+08'
    """
    r = at_least(0, "a retraction speed is positive", speed=speed)
    t, l0 = positive(time_unit=time_unit, tip_length=tip_length)
    return plain(r * t / l0)


def rate_as_published(rate: Values) -> Number:
    r"""Return :math:`\hat r_u / (3.24 \pi^{2/3})` from a rate over :math:`h_0/\tau_0`.

    This is the rate in the authors' published tables and models, at every Tabor number.

    Parameters
    ----------
    rate : array_like
        :math:`\hat r_u`, retraction speed [h0/tau0], not negative.

    Raises
    ------
    InputError
        If the rate is negative or not finite.

    Examples
    --------
    >>> f"{rate_as_published(100.0):.3f}"
    '14.389'
    """
    r = at_least(0, "a rate of unloading is not negative", rate=rate)
    return plain(r / (FITTED_TABOR * np.pi ** (2 / 3)))


def rate_in_contact_heights(
    speed: Values,
    *,
    time_unit: Values,
    radius: Values,
    contact_modulus: Values,
    work_of_adhesion: Values,
) -> Number:
    r"""Return :math:`r \tau_0 / (\pi^2 \Delta\gamma_0^2 R / E_0^{*2})^{1/3}` from a speed [m/s].

    Parameters
    ----------
    speed : array_like
        Retraction speed r [m/s], not negative.
    time_unit : array_like
        :math:`\tau_0` [s], positive.
    radius, contact_modulus, work_of_adhesion : array_like
        R of the sphere [m], rubbery :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2];
        positive.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> case = dict(radius=5e-3, contact_modulus=1.9e6, work_of_adhesion=0.15)
    >>> f"{rate_in_contact_heights(1e-4, time_unit=0.02, **case):.3f}"
    '0.296'
    """
    r = at_least(0, "a retraction speed is positive", speed=speed)
    t = positive(time_unit=time_unit)
    _, height, _ = contact_scales(radius, contact_modulus, work_of_adhesion)
    return plain(r * t / height)
