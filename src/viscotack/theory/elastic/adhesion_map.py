r"""Adhesion map of Johnson and Greenwood: which elastic theory holds at a load.

The map's axes are the Tabor number mu (``tabor``) and the load in :math:`\pi R \Delta\gamma_0`,
compression positive. Its boundaries are conventions of 5 % and of a factor 20; here each is
computed from the Maugis-Dugdale contact with the strength of the Lennard-Jones traction, so that
they join:

- Hertz: the tension contributes less than 5 % of the load,
- JKR: it lifts the surface, by :math:`\delta_a = a^2/R - \delta`, by more than 20 h0,
- DMT: it lifts the surface by less than h0/20,
- rigid (Bradley): the indentation of the DMT contact is below h0/20,
- Maugis: all other cases.

Source: Johnson & Greenwood (1997), doi:10.1006/jcis.1997.4984.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory._roots import halved
from viscotack.theory.elastic import maugis as equations

from .lennard_jones import tabor_number
from .maugis import parameter_from_tabor

SMALL, LARGE = 0.05, 20.0
_RANGE = (1e-3, 1e3)
_LOG_EXCESS = (-45.0, 30.0)
# h0 in the depth unit of Maugis' equations, times mu
_GAP = (0.75 * np.pi) ** (-2 / 3)


def hertz_load(tabor: Values) -> Number:
    r"""Return the load [:math:`\pi R \Delta\gamma_0`] above which adhesion adds less than 5 %.

    The value ranges from 40 (DMT) to 2520 (JKR).

    Parameters
    ----------
    tabor : array_like
        Tabor number, from 0.001 to 1000.

    Raises
    ------
    InputError
        If the Tabor number is outside its range.

    Examples
    --------
    >>> f"{hertz_load(1.0):.0f}"
    '955'
    """
    lam = _parameter(tabor)

    def excess_of_tension(x: Any) -> Any:
        a, P, _ = _state(x, lam)
        return P - (a**3 - P) / SMALL

    return plain(_state(_zero(excess_of_tension, lam), lam)[1])


def jkr_load(tabor: Values) -> Number:
    r"""Return the load [:math:`\pi R \Delta\gamma_0`] above which JKR holds.

    The adhesive lift there is 20 h0. Equal to minus the pull-off force if the lift is larger along
    the whole stable curve; never above :func:`hertz_load`.

    Parameters
    ----------
    tabor : array_like
        Tabor number, from 0.001 to 1000.

    Raises
    ------
    InputError
        If the Tabor number is outside its range.

    Examples
    --------
    >>> f"{jkr_load(5.0):.1f}"
    '1.1'
    """
    return _load_at_lift(tabor, LARGE)


def dmt_load(tabor: Values) -> Number:
    r"""Return the load [:math:`\pi R \Delta\gamma_0`] below which DMT holds.

    The adhesive lift there is h0/20. Equal to minus the pull-off force if the lift is larger along
    the whole stable curve, so that DMT holds nowhere; never above :func:`hertz_load`.

    Parameters
    ----------
    tabor : array_like
        Tabor number, from 0.001 to 1000.

    Raises
    ------
    InputError
        If the Tabor number is outside its range.

    Examples
    --------
    >>> f"{dmt_load(0.01):.1f}"
    '47.8'
    """
    return _load_at_lift(tabor, SMALL)


def rigid_load(tabor: Values) -> Number:
    r"""Return the load [:math:`\pi R \Delta\gamma_0`] below which the sphere is effectively rigid.

    .. math:: \frac{P}{\pi R \Delta\gamma_0} = \frac{4}{3 \pi} (0.05/\mu)^{3/2} - 2

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
    >>> f"{rigid_load(0.01):.2f}"
    '2.75'
    """
    mu = positive(tabor=tabor)
    return plain(4 / (3 * np.pi) * (SMALL / mu) ** 1.5 - 2)


def regime(
    force: float,
    *,
    radius: float,
    contact_modulus: float,
    work_of_adhesion: float,
    equilibrium_gap: float,
) -> str:
    r"""Return "hertz", "jkr", "maugis", "dmt" or "rigid" at a force [N].

    Parameters
    ----------
    force : float
        Force [N], compression positive; a tension above the pull-off force counts as pull-off.
    radius, contact_modulus, work_of_adhesion, equilibrium_gap : float
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive, with
        a Tabor number from 0.001 to 1000.

    Raises
    ------
    InputError
        If a value is outside its range or not finite.

    Examples
    --------
    >>> tip = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, equilibrium_gap=1e-9)
    >>> regime(1e-7, **tip)
    'maugis'
    """
    case = dict(radius=radius, work_of_adhesion=work_of_adhesion)
    mu = tabor_number(**case, contact_modulus=contact_modulus, equilibrium_gap=equilibrium_gap)
    if not np.isfinite(force):
        raise InputError(f"force must be finite, got {force} N")
    load = force / (np.pi * radius * work_of_adhesion)
    if load > hertz_load(mu):
        return "hertz"
    if load < rigid_load(mu):
        return "rigid"
    if load <= dmt_load(mu):
        return "dmt"
    return "jkr" if load >= jkr_load(mu) else "maugis"


def _parameter(tabor: Values) -> Any:
    mu = positive(tabor=tabor)
    low, high = _RANGE
    if np.any((mu < low) | (mu > high)):
        raise InputError(
            f"tabor must lie between {low:g} and {high:g} on the map, got {np.min(mu):.3g} to "
            f"{np.max(mu):.3g}; below it is rigid or DMT, above JKR or Hertz"
        )
    return np.asarray(parameter_from_tabor(mu))


def _state(x: Any, lam: Any) -> tuple[Any, Any, Any]:
    """Return contact radius, force and adhesive lift at x = ln(c/a - 1), in Maugis' units."""
    a = equations.contact_radius(np.exp(x), lam)
    P, d = equations.force_and_depth(np.exp(x), lam, a)
    # 4/3 lambda a t itself, not the difference of the large a^2 and the depth
    return a, P, 4 / 3 * lam * a * equations.angle(np.exp(x))[1]


def _load_at_lift(tabor: Values, lift: float) -> Any:
    lam = _parameter(tabor)
    unit = _GAP / np.asarray(tabor, dtype=float)
    end = _zero(lambda x: equations.force_slope(np.exp(x), lam), lam)
    place = _zero(lambda x: _state(x, lam)[2] - lift * unit, lam)
    return plain(np.minimum(_state(np.minimum(place, end), lam)[1], hertz_load(tabor)))


def _zero(function: Callable[[Any], Any], lam: Any) -> Any:
    """Return the zero of a function that decreases with ln(c/a - 1), or an end."""
    return halved(function, *(np.full(np.shape(lam), bound) for bound in _LOG_EXCESS))
