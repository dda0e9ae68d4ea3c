r"""Shift factors from the overlap of neighbouring sweeps, and laws fitted to tables of them.

Moduli may also move vertically between temperatures. The theory of rubber elasticity gives, from
density and temperature,

.. math:: b_T = \frac{\rho_0 T_0}{\rho T}, \qquad \rho \propto e^{-\alpha T}

which is a few per cent per ten kelvin. A clamp or a gap that changes with temperature has an effect
of the same size. By default moduli do not move: in sweeps that need no vertical shift a fitted one
takes up noise and moves the horizontal shift. "auto" determines the vertical shift by both moduli
together: the vertical shifts of all steps have a common size, fitted with them, which is the prior
where curves are too straight to determine a shift. It also contributes to the uncertainty of
horizontal shifts computed without vertical ones.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import GAP, FrequencySweeps, levels
from viscotack.model.materials.shift import WLF, Arrhenius, FittedShift, TabulatedShift, wlf_decades

from .overlap import LAW, Curve, Hold, Step, free_vertical, step_between, vertical_at

FEWEST = 4  # smallest number of points per temperature
MOST = 200  # largest number of points per temperature; more are averaged without loss of accuracy
BY = ("both", "storage", "loss", "tan")
BEST = ("both", "auto")  # by, vertical: what shifts are compared with; uses most of the data
THERMOMETER = 0.2  # K: standard uncertainty of a chamber's temperature


def shift_factors(
    sweeps: FrequencySweeps,
    *,
    reference_temperature: float,
    by: str = "both",
    vertical: str | float = "none",
) -> TabulatedShift:
    """Compute the shift of each temperature from the overlap of neighbouring sweeps.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Two or more temperatures, each with four or more frequencies.
    reference_temperature : float
        T0 [K], within the temperatures of the sweeps. Between two sweeps the shift is
        interpolated, and the table has no row at zero shift.
    by : {"both", "storage", "loss", "tan"}
        Which moduli must superpose. Both moduli carry most information: storage alone is flat on a
        plateau, where an error of a few per cent appears as a shift by decades. The loss tangent is
        independent of vertical shifts, which are then fitted afterwards.
    vertical : {"auto", "none", "free"} or float
        Allowed vertical shift, one factor for storage and loss: "none"; "auto", as far as
        the data determine it, with a common size of all steps as prior; "free", each step
        independently; or a coefficient of volume expansion [1/K], which gives the shift by density
        and temperature of rubber elasticity.

    Returns
    -------
    TabulatedShift
        With the standard deviation of each shift relative to the reference. It includes the scatter
        of points and of blocks of points about the common curve, vertical shifts of the size seen
        in the data, even where none was allowed, and 0.2 K of the thermometer; with two moduli also
        the difference to the shifts by both moduli with vertical shifts. It does not include the
        error for a solid that does not superpose; see :func:`viscotack.lab.superposition`.

    Raises
    ------
    ValueError
        If there are fewer than two temperatures, one of them has too few points, two neighbours
        do not overlap, or the reference is outside the measured range.

    Notes
    -----
    Points within 1 K have one temperature, their mean. More than 200 points of one temperature are
    averaged over equal intervals of the logarithm of frequency.

    Examples
    --------
    >>> omega = np.geomspace(1, 100, 10)
    >>> hot = omega / 10
    >>> sweeps = FrequencySweeps(
    ...     np.repeat([293.15, 303.15], 10),
    ...     np.tile(omega, 2),
    ...     np.concatenate([1e6 * (1 + omega**0.5), 1e6 * (1 + hot**0.5)]),
    ...     np.concatenate([4e5 * omega**0.5, 4e5 * hot**0.5]),
    ...     "E",
    ...     np.repeat([0, 1], 10),
    ... )
    >>> shifts = shift_factors(sweeps, reference_temperature=293.15)
    >>> [round(value, 2) for value in shifts.values]
    [0.0, -1.0]
    """
    temperature, each = temperature_levels(sweeps)
    curves = level_curves(temperature, each)
    return shifts_between(temperature, curves, reference_temperature, by, vertical)


def shifts_between(
    temperature: Array,
    curves: Sequence[Curve],
    reference: float,
    by: str,
    vertical: str | float,
) -> TabulatedShift:
    """Compute the shift of each curve, in frequency or in time; see :func:`shift_factors`.

    Parameters
    ----------
    temperature : ndarray, shape (M,)
        [K], ascending.
    curves : sequence of Curve, M
        All measured moduli, over log10 of frequency or minus log10 of time.
    """
    if vertical not in _VERTICAL:
        if isinstance(vertical, bool | str) or not 0 <= float(vertical) < 0.01:
            known = f"{', '.join(_VERTICAL)} or a volume expansion from 0 to 0.01 1/K"
            raise InputError(f"vertical must be {known}, got {vertical!r}")
        vertical = float(vertical)
    if by not in BY:
        raise InputError(f"by must be one of {', '.join(BY)}, got {by!r}")
    if len(curves) < 2:
        raise InputError(f"a shift needs two or more temperatures; {LAW}")
    if not temperature[0] - GAP <= reference <= temperature[-1] + GAP:
        ends = f"{temperature[0]:.2f} and {temperature[-1]:.2f} K, got {reference:g} K"
        raise InputError(f"`reference_temperature` must lie between {ends}; beyond, {LAW}")
    steps = steps_between(temperature, curves, by, vertical)
    shift, up, deviation = _summed(steps, temperature, reference)
    # change of each shift for an error of 1 K in its or the reference temperature
    slope = np.gradient(shift, temperature)
    inside = float(np.clip(reference, temperature[0], temperature[-1]))
    kelvin = np.hypot(slope, np.interp(inside, temperature, slope))
    kelvin = np.where(np.abs(temperature - inside) <= GAP, 0.0, kelvin)
    uncertainty = np.hypot(deviation, THERMOMETER * kelvin)
    if (by, vertical) != BEST and len(curves[0].y) > 1:
        # the uncertainty includes the difference to the shifts from all moduli
        try:
            most = steps_between(temperature, curves, *BEST)
        except ValueError:
            most = steps
        other = _summed(most, temperature, reference)[0]
        uncertainty = np.hypot(uncertainty, shift - other)
    columns = (shift, uncertainty, () if vertical == "none" else up)
    return TabulatedShift(reference, tuple(temperature), *map(tuple, columns))


def steps_between(
    temperature: Array, curves: Sequence[Curve], by: str, vertical: str | float
) -> list[Step]:
    """Fit the displacement of each curve relative to its colder neighbour."""
    holds = _holds(vertical, temperature, list(pairwise(curves)))
    steps = []
    for i, (colder, hotter) in enumerate(pairwise(curves)):
        hold = Hold() if by == "tan" else holds[i]
        try:
            step = step_between(part(colder, by), part(hotter, by), hold)
            if by == "tan":  # independent of vertical shifts, which are fitted afterwards
                step = replace(step, vertical=vertical_at(colder, hotter, step.shift, holds[i]))
        except ValueError as error:
            between = f"{temperature[i]:.2f} and {temperature[i + 1]:.2f} K"
            raise InputError(f"sweeps at {between}: {error}") from None
        steps.append(step)
    return steps


def part(curve: Curve, by: str) -> Curve:
    """Return the part of a curve that must superpose."""
    if by == "both":
        return curve
    storage, loss = curve.y
    return Curve(curve.x, ({"storage": storage, "loss": loss, "tan": loss - storage}[by],))


def _summed(
    steps: Sequence[Step], temperature: Array, reference: float
) -> tuple[Array, Array, Array]:
    """Return shifts, vertical shifts and standard deviations relative to the reference."""
    columns = np.array([[s.shift, s.vertical, s.variance, s.common] for s in steps])
    sums = np.vstack((np.zeros(4), np.cumsum(columns, axis=0)))
    inside = float(np.clip(reference, temperature[0], temperature[-1]))
    shift, up = (
        np.asarray(
            TabulatedShift(inside, tuple(temperature), tuple(column)).log10_shift(temperature)
        )
        for column in sums[:, :2].T
    )
    variance, common = (
        np.abs(column - np.interp(inside, temperature, column)) for column in sums[:, 2:].T
    )
    deviation = np.sqrt(variance + common**2)
    # the reference itself, apart from round-off
    return shift, up, np.where(deviation < 1e-6, 0.0, deviation)


def temperature_levels(sweeps: FrequencySweeps) -> tuple[Array, list[FrequencySweeps]]:
    """Return each temperature [K] and its points, from cold to hot."""
    if np.any(np.isnan(sweeps.temperature)):
        raise InputError("the temperature of some points is unknown; set `temperature`")
    each = [sweeps.chosen(points) for points in levels(sweeps.temperature)]
    return np.array([float(np.mean(level.temperature)) for level in each]), each


def level_curves(temperature: Array, levels: Sequence[FrequencySweeps]) -> list[Curve]:
    """Return the points of each temperature as a curve in decades: storage and loss."""
    curves = []
    for T, level in zip(temperature, levels, strict=True):
        order = np.argsort(level.angular_frequency, kind="stable")
        columns = (level.angular_frequency, level.storage, level.loss)
        curves.append(curve(T, *(np.log10(column[order]) for column in columns)))
    return curves


def curve(temperature: float, x: Array, *y: Array) -> Curve:
    """Return moduli over frequency, in decades, averaged to at most MOST points."""
    if x.size < FEWEST or np.ptp(x) < 0.1:
        few = f"{x.size} points at {temperature:.2f} K over {np.ptp(x):.1g} decades are too few"
        raise InputError(f"{few}; {LAW}, or `leave_out` this temperature")
    if x.size <= MOST:
        return Curve(x, y)
    stretch = (MOST * (x - x[0]) / (np.ptp(x) * (1 + 1e-12))).astype(int)
    _, stretch, count = np.unique(stretch, return_inverse=True, return_counts=True)
    means = tuple(np.bincount(stretch, column) / count for column in (x, *y))
    return Curve(means[0], means[1:])


_VERTICAL = ("none", "auto", "free")
_USUAL = 0.02  # decades, 5 %: usual effect of gap, clamp and rubber elasticity between sweeps
_SPREADS = np.geomspace(1e-4, 0.3, 80)  # decades


def _holds(
    vertical: str | float, temperature: Array, pairs: Sequence[tuple[Curve, Curve]]
) -> list[Hold]:
    """Return the prior of the vertical shift of each step.

    Parameters
    ----------
    vertical : str or float
        A word of :func:`shift_factors`, or a coefficient of volume expansion [1/K].
    temperature : ndarray, shape (n + 1,)
        Of the curves [K], ascending.
    pairs : sequence of (Curve, Curve), n
        Neighbouring curves, with all measured moduli.
    """
    if vertical == "free":
        return [Hold(0.0, np.inf) for _ in pairs]
    law = np.zeros(len(pairs))
    if not isinstance(vertical, str):  # by density and temperature, log10(rho T)
        law = -np.diff(np.log10(temperature) - vertical * temperature / np.log(10))
    spread = _spread(law, pairs)
    moves = vertical == "auto"
    return [Hold(float(expected), spread, moves) for expected in law]


def _spread(law: Array, pairs: Sequence[tuple[Curve, Curve]]) -> float:
    """Return the standard deviation of vertical shifts about their expected values.

    Root mean square under the likelihood of the steps' free fits and a half-normal
    prior of the usual size.
    """
    cost = (_SPREADS / _USUAL) ** 2
    for expected, (colder, hotter) in zip(law, pairs, strict=True):
        try:
            found, variance = free_vertical(colder, hotter)
        except ValueError:
            continue  # too straight to determine the vertical shift
        total = variance + _SPREADS**2
        cost += np.log(total) + (found - expected) ** 2 / total
    # uniform in the spread, not in its logarithm
    weight = np.exp(-(cost - np.min(cost)) / 2) * _SPREADS
    return float(np.sqrt(np.sum(weight * _SPREADS**2) / np.sum(weight)))


# ---- laws of shift fitted to a table -------------------------------------------------------------

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
