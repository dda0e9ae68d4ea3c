"""Fit laws of time-temperature shift (WLF, Arrhenius) to tables of shift factors."""

import math

import numpy as np
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.shift import WLF, Arrhenius, FittedShift, TabulatedShift, wlf_decades

_MISSED = 0.1  # decades: deviation from a row that is always tolerated
_UNCERTAIN = 0.01  # decades: scatter of a shift in addition to its stated uncertainty


def fit_wlf(table: TabulatedShift, *, reference_temperature: float) -> FittedShift:
    """Fit the WLF law to a table of shifts by weighted least squares.

    Parameters
    ----------
    table : TabulatedShift
        Three or more temperatures; shifts relative to any temperature.
    reference_temperature : float
        T0 of the law [K], not necessarily a row; c1 and c2 refer to it.

    Returns
    -------
    FittedShift
        Standard errors from the curvature and the larger of the stated and the fitted scatter.

    Raises
    ------
    InputError
        If there are fewer than three rows, or the shifts have the wrong curvature; then fit
        Arrhenius, or a part of the table.

    Examples
    --------
    >>> wlf = WLF(reference_temperature=293.15, c1=8.86, c2=101.6)
    >>> rows = np.array([273.15, 293.15, 313.15, 343.15])
    >>> table = TabulatedShift(293.15, rows, wlf.log10_shift(rows))
    >>> found = fit_wlf(table, reference_temperature=293.15)
    >>> round(found.law.c1, 4), round(found.law.c2, 3)
    (8.86, 101.6)
    """
    if len(table) < 3:
        raise InputError(f"a WLF law needs three or more temperatures, got {len(table)}")
    above = np.array(table.temperature) - reference_temperature
    weight = 1 / _deviation(table)
    coldest = min(float(np.min(above)), 0.0)

    def residual(q: Array) -> Array:
        # fit the zero as well: the table may have another reference temperature
        decades = wlf_decades(above, math.exp(q[0]), math.exp(q[1]) - coldest)
        return weight * (q[2] + decades - np.array(table.values))

    offset = float(np.interp(reference_temperature, table.temperature, np.array(table.values)))
    starts = [
        [math.log(c1), math.log(c2), offset] for c1 in (5.0, 17.0, 50.0) for c2 in (20.0, 100.0)
    ]
    limits = ([-3.0, -5.0, -np.inf], [math.log(1e4), math.log(1e5), np.inf])
    best = min((least_squares(residual, s, bounds=limits) for s in starts), key=lambda f: f.cost)
    c1, c2 = math.exp(best.x[0]), math.exp(best.x[1]) - coldest
    if c2 > 1e4 or c1 > 5e3 or c1 < 0.06:
        raise InputError("the shifts curve against a WLF law; fit Arrhenius, or part of the table")
    # chain rule from ln c1 and ln(c2 + coldest)
    law = WLF(reference_temperature=reference_temperature, c1=c1, c2=c2)
    return _fit(table, law, best.jac, np.array([c1, c2 + coldest]))


def fit_arrhenius(table: TabulatedShift, *, reference_temperature: float) -> FittedShift:
    """Fit the Arrhenius law to a table of shifts by weighted least squares.

    Parameters
    ----------
    table : TabulatedShift
        Two or more temperatures; shifts relative to any temperature.
    reference_temperature : float
        T0 of the law [K]; the activation energy does not depend on it.

    Returns
    -------
    FittedShift
        Law, standard errors and misfit.

    Raises
    ------
    InputError
        If there are fewer than two rows, or the shift rises with temperature.

    Examples
    --------
    >>> rows = np.array([273.15, 293.15, 313.15])
    >>> table = TabulatedShift(293.15, rows, Arrhenius(293.15, 80e3).log10_shift(rows))
    >>> round(fit_arrhenius(table, reference_temperature=293.15).law.activation_energy)
    80000
    """
    if len(table) < 2:
        raise InputError(f"an Arrhenius law needs two or more temperatures, got {len(table)}")
    unit = np.asarray(Arrhenius(reference_temperature, 1.0).log10_shift(table.temperature))
    weight = 1 / _deviation(table)
    columns = np.column_stack((unit, np.ones(len(table))))
    columns *= weight[:, None]
    found, *_ = np.linalg.lstsq(columns, np.array(table.values) * weight, rcond=None)
    if found[0] <= 0:
        raise InputError(f"the shift rises with temperature ({found[0]:.3g} J/mol); give 1/a_T")
    law = Arrhenius(reference_temperature, float(found[0]))
    return _fit(table, law, columns, np.ones(1))


def nearest_law(table: TabulatedShift, *, reference_temperature: float) -> FittedShift | None:
    """Return the WLF or Arrhenius law that fits a table better; None if neither fits.

    Schwarz's criterion decides between the three constants of WLF (including the zero) and the two
    of Arrhenius. A law is rejected if it deviates from a row by more than three standard deviations
    and by more than 0.1 decades.

    Parameters
    ----------
    table : TabulatedShift
        Temperatures [K] and log10 a_T, with or without their uncertainty; 0.01 decades of
        scatter are added to it.
    reference_temperature : float
        T0 of the law [K], not necessarily a row.

    Returns
    -------
    FittedShift or None
        Law, standard errors and misfit.

    Examples
    --------
    >>> rows = np.array([273.15, 283.15, 293.15, 303.15, 313.15])
    >>> values = Arrhenius(293.15, 80e3).log10_shift(rows)
    >>> table = TabulatedShift(293.15, rows, values, np.full(5, 0.02))
    >>> type(nearest_law(table, reference_temperature=293.15).law).__name__
    'Arrhenius'
    """
    fits = []
    for kind, constants in ((fit_arrhenius, 2), (fit_wlf, 3)):
        try:
            found = kind(table, reference_temperature=reference_temperature)
        except ValueError:
            continue  # try the other law
        off = _off(table, found.law) / _deviation(table)
        if np.all(np.abs(off) < 3) or abs(found.worst[1]) < _MISSED:
            fits.append((float(off @ off) + constants * math.log(len(table)), found))
    return min(fits, key=lambda pair: pair[0])[1] if fits else None


def _off(table: TabulatedShift, law: WLF | Arrhenius) -> Array:
    """Return log10 a_T of the table minus the law, with the fitted zero subtracted."""
    difference = np.array(table.values) - np.asarray(law.log10_shift(table.temperature))
    weight = _deviation(table) ** -2.0
    return difference - float(weight @ difference / np.sum(weight))


def _deviation(table: TabulatedShift) -> Array:
    return np.hypot(table.uncertainty or np.zeros(len(table)), _UNCERTAIN)


def _fit(table: TabulatedShift, law: WLF | Arrhenius, jacobian: Array, scale: Array) -> FittedShift:
    """Return a law with errors, widened if the scatter exceeds the stated uncertainty.

    `jacobian` is that of the weighted residuals, `scale` the constants over its variables.
    """
    off = _off(table, law)
    freedom = off.size - jacobian.shape[1]
    excess = np.sum((off / _deviation(table)) ** 2) / freedom if freedom > 0 else 1.0
    covariance = max(1.0, excess) * np.linalg.pinv(jacobian.T @ jacobian)
    error = scale * np.sqrt(np.diag(covariance)[: scale.size])
    worst = int(np.argmax(np.abs(off)))
    misfit = float(np.sqrt(np.mean(off**2)))
    return FittedShift(
        law, tuple(error.tolist()), misfit, (table.temperature[worst], float(off[worst]))
    )
