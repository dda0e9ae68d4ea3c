r"""Elastic pull-off of a sphere with the Lennard-Jones 3-9 traction: a table from the solver.

Between Bradley's rigid sphere and JKR no closed form exists for this traction. The pull-off force
in units of JKR's, :math:`f(\mu) = P_{po} / (\tfrac32 \pi R \Delta\gamma_0)`, falls from 4/3 to 1
with the Tabor number (``tabor``) :math:`\mu = (R \Delta\gamma_0^2 / E^{*2} h_0^3)^{1/3}`;
Maugis-Dugdale of the same strength is up to 6 % lower. It is the slow limit of every viscoelastic
sphere of :func:`viscotack.solve`, and its fast limit with the Tabor number of the glassy solid, see
:mod:`viscotack.theory.sphere.bounds`.

Range: computed for 0.01 <= mu <= 10; polynomials in ln mu represent the table with the relative
errors 1e-4 (force) and 5e-4 (work). Outside, the limits are continued with their powers of
mu, :math:`\tfrac43 - f \sim \mu^{3/2}` and :math:`f - 1 \sim \mu^{-2} (c + \ln\mu)`, through the
last value of the table: errors below 1e-3 of the force and 1 % of the work.

Source: this package; the table is computed by ``research/elastic_table.py``; limits of Bradley
(1932), Philosophical Magazine 13, 853 (no DOI known to this package), and Johnson, Kendall &
Roberts (1971), doi:10.1098/rspa.1971.0141.

The table, `ROWS`, has the Tabor number, the pull-off force [1.5 pi R w] and the work to pull-off
from zero force [1.5 pi R w h0] at the Chebyshev points of ln mu. Estimated solver errors: 5e-5 of
the force, 3e-4 of the work.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from viscotack.theory._checks import Number, Values, plain, positive

ROWS = (
    (0.01, 1.33268753, 0.2108915),
    (0.0106861700137193, 1.33261569, 0.2114413),
    (0.0130071066510647, 1.33235583, 0.2134238),
    (0.0178976323050524, 1.33173242, 0.2181550),
    (0.027500451761057, 1.33025716, 0.2292061),
    (0.0464135353810727, 1.32659724, 0.2558843),
    (0.0843285924469905, 1.31715512, 0.3213851),
    (0.161199806805135, 1.29323321, 0.4769435),
    (0.316227766016838, 1.24167728, 0.8064168),
    (0.620348138015353, 1.16656591, 1.3989537),
    (1.1858374140759, 1.09708572, 2.3974223),
    (2.15454391006766, 1.05109348, 4.0415683),
    (3.63630390034568, 1.02648444, 6.5455115),
    (5.58733123440973, 1.01466522, 9.8569604),
    (7.68810487087184, 1.00922597, 13.4370772),
    (9.35788967156767, 1.00687468, 16.2896417),
    (10, 1.00621610, 17.3826771),
)


_TABOR, _FORCE, _WORK = np.array(ROWS).T
_LOWEST, _HIGHEST = _TABOR[0], _TABOR[-1]
_RIGID_WORK = 2 * (8 * 2 ** (1 / 3) - 9) / 10.5
_JKR_WORK = 2 / 3 * 1.125 ** (2 / 3) * (0.6 * 4 ** (2 / 3) - 0.4) * np.pi ** (2 / 3)


def _position(tabor: Any) -> Any:
    """Map ln mu to the interval from -1 to 1."""
    return 2 * np.log(tabor / _LOWEST) / np.log(_HIGHEST / _LOWEST) - 1


def _coefficients(values: Any) -> Any:
    degree = len(values) - 1
    return np.linalg.solve(np.polynomial.chebyshev.chebvander(_position(_TABOR), degree), values)


# The odds of f between its limits, nearly straight in ln mu; the work spans decades.
_FORCE_SERIES = _coefficients(np.log((4 / 3 - _FORCE) / (_FORCE - 1)))
_WORK_SERIES = _coefficients(np.log(_WORK))


def pull_off_ratio(tabor: Values) -> Number:
    r"""Return the pull-off force over that of JKR, f(mu), between 4/3 and 1.

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
    >>> f"{pull_off_ratio(3.24):.4f}"
    '1.0308'
    """
    # traced arrays (used to export formulas) have no values to check
    mu: Any = tabor if isinstance(tabor, NDArrayOperatorsMixin) else positive(tabor=tabor)
    odds = np.exp(_series(mu, _FORCE_SERIES))
    inside = (4 / 3 + odds) / (1 + odds)
    rigid = 4 / 3 - (4 / 3 - _FORCE[0]) * (np.minimum(mu, _LOWEST) / _LOWEST) ** 1.5
    high = np.maximum(mu, _HIGHEST)
    return plain(np.where(mu < _LOWEST, rigid, np.where(mu > _HIGHEST, _soft(high), inside)))


def work_ratio(tabor: Values) -> Number:
    r"""Return the work from zero force to pull-off [1.5 pi R w h0].

    It increases from Bradley's 0.2056 for a rigid sphere to JKR's :math:`0.8018 \pi^{2/3} \mu`.

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
    >>> f"{work_ratio(3.24):.2f}"
    '5.87'
    """
    mu = positive(tabor=tabor)
    inside = np.exp(_series(mu, _WORK_SERIES))
    rigid = _RIGID_WORK + (_WORK[0] - _RIGID_WORK) * (np.minimum(mu, _LOWEST) / _LOWEST) ** 1.5
    # the excess over JKR relative to JKR falls there with mu^-1.5
    high = np.maximum(mu, _HIGHEST)
    excess = (_WORK[-1] / (_JKR_WORK * _HIGHEST) - 1) * (_HIGHEST / high) ** 1.5
    soft = _JKR_WORK * high * (1 + excess)
    return plain(np.where(mu < _LOWEST, rigid, np.where(mu > _HIGHEST, soft, inside)))


def pull_off_force(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, equilibrium_gap: Values
) -> Number:
    r"""Return the pull-off force [N], a positive number, :math:`\tfrac32 \pi R w f(\mu)`.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, equilibrium_gap : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> tip = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, equilibrium_gap=1e-9)
    >>> f"{pull_off_force(**tip) * 1e9:.1f} nN"
    '255.6 nN'
    """
    mu, load, _ = _scales(radius, contact_modulus, work_of_adhesion, equilibrium_gap)
    return plain(load * pull_off_ratio(mu))


def work_to_pull_off(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, equilibrium_gap: Values
) -> Number:
    r"""Return the work [J] of the drive from zero force to the force minimum.

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, equilibrium_gap : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> tip = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, equilibrium_gap=1e-9)
    >>> f"{work_to_pull_off(**tip) * 1e18:.0f} aJ"
    '634 aJ'
    """
    mu, load, h0 = _scales(radius, contact_modulus, work_of_adhesion, equilibrium_gap)
    return plain(load * h0 * work_ratio(mu))


def tabor_number(
    *, radius: Values, contact_modulus: Values, work_of_adhesion: Values, equilibrium_gap: Values
) -> Number:
    r"""Return the Tabor number, dimensionless.

    .. math:: \mu = (R \Delta\gamma_0^2 / E^{*2} h_0^3)^{1/3} \quad \text{(Eq. 2.2 as in Eq. 31)}

    Parameters
    ----------
    radius, contact_modulus, work_of_adhesion, equilibrium_gap : array_like
        R of the sphere [m], E* [Pa], :math:`\Delta\gamma_0` [J/m^2] and h0 [m]; positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> tip = dict(radius=1e-6, contact_modulus=1e9, work_of_adhesion=0.05, equilibrium_gap=1e-9)
    >>> f"{tabor_number(**tip):.3f}"
    '1.357'
    """
    return plain(_scales(radius, contact_modulus, work_of_adhesion, equilibrium_gap)[0])


def _scales(radius: Any, contact_modulus: Any, work: Any, gap: Any) -> tuple[Any, Any, Any]:
    """Return Tabor number, JKR pull-off force [N] and equilibrium gap [m]."""
    R, E, w, h0 = positive(
        radius=radius,
        contact_modulus=contact_modulus,
        work_of_adhesion=work,
        equilibrium_gap=gap,
    )
    return np.cbrt(R * (w / E) ** 2) / h0, 1.5 * np.pi * R * w, h0


def _series(mu: Any, series: Any) -> Any:
    x = _position(np.clip(mu, _LOWEST, _HIGHEST))
    return np.polynomial.chebyshev.chebval(x, series)


def _soft(mu: Any) -> Any:
    """Return f beyond the table, from its last value and slope."""
    e = 1e-3
    edge = _FORCE[-1] - 1
    before = np.exp(_series(_HIGHEST * np.exp(-e), _FORCE_SERIES))
    # g = (f - 1) mu^2 is straight in ln mu
    g, g_before = edge * _HIGHEST**2, (1 / 3) / (1 + before) * (_HIGHEST * np.exp(-e)) ** 2
    return 1 + (g + (g - g_before) / e * np.log(mu / _HIGHEST)) / mu**2
