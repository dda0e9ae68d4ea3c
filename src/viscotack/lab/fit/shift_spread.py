"""Propagate the uncertainty of shift factors to a fit by refitting shifted curves."""

from dataclasses import replace
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.lab.sweeps import MasterCurve, ShiftTable
from viscotack.model.materials import Prony

from .observed import observed, only
from .power_law import fitted_constants
from .prony import fit_series
from .report import FitReport, Interval

_DRAWS = 12
_WORTH = 1.05  # ratio of half-widths above which a caution is added


def allow_for_shifts(report: FitReport, data: Any, shifts: Any, *, seed: int = 0) -> FitReport:
    """Widen the intervals of a report by the uncertainty of the shifts.

    Parameters
    ----------
    report : FitReport
        A fit to `data`.
    data : MasterCurve or another measurement
        Fitted data; tests over time leave the report unchanged.
    shifts : ShiftTable or a law
        Shifts with their uncertainty; without one the report is unchanged.
    seed : int
        Seed of the random shifts.

    Returns
    -------
    FitReport
        With wider intervals, and a caution if they are much wider.

    Notes
    -----
    Twelve tables with independent errors of the steps between rows are sampled. Each shifts the
    master curve, and the same law is fitted again. The spread of ln(constant) is added in
    quadrature to the half-width of its interval. The band of the report is not widened.

    Examples
    --------
    >>> import numpy as np
    >>> from viscotack.lab import MasterCurve, fit
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5)
    >>> omega = np.geomspace(0.1, 1e4, 16)
    >>> modulus = solid.complex_modulus(omega)
    >>> curve = MasterCurve(293.15, omega, modulus.real, modulus.imag, "E")
    >>> report = fit(curve, poisson_ratio=0.5, model="sls")
    >>> allow_for_shifts(report, curve, shifts=None) is report
    True
    """
    if not isinstance(data, MasterCurve) or not isinstance(shifts, ShiftTable):
        return report
    if shifts.uncertainty is None or data.temperature is None or not np.any(shifts.uncertainty):
        return report
    rng = np.random.default_rng(seed)
    found = [_refitted(report, _moved(data, shifts, rng)) for _ in range(_DRAWS)]
    quantile = NormalDist().inv_cdf((1 + report.level) / 2)
    intervals, more = [], 1.0
    for each in report.intervals:
        logs = np.log([getattr(solid, each.name) for solid in found])
        wider = quantile * float(np.std(logs, ddof=1))
        intervals.append(_wider(each, wider))
        if each.bounded and not each.known and each.high > each.low:
            last = intervals[-1]
            more = max(more, float(np.log(last.high / last.low) / np.log(each.high / each.low)))
    cautions = report.cautions
    if more > _WORTH:
        worst = int(np.argmax(shifts.uncertainty))
        cautions = (
            *cautions,
            f"the uncertainty of the shifts, {shifts.uncertainty[worst]:.2g} decades at "
            f"{shifts.temperature[worst] - 273.15:.4g} C, widens intervals by up to a factor of "
            f"{more:.2g}, but not the band",
        )
    return replace(report, intervals=tuple(intervals), cautions=cautions)


def _moved(curve: MasterCurve, shifts: ShiftTable, rng: np.random.Generator) -> MasterCurve:
    """Return the curve with random shifts within their uncertainty."""
    assert shifts.uncertainty is not None and curve.temperature is not None, "checked by the caller"
    variance = shifts.uncertainty**2
    zero = int(np.argmin(variance))
    error = np.zeros(variance.size)
    for side in (range(zero + 1, variance.size), range(zero - 1, -1, -1)):
        before = zero
        for i in side:
            # a smaller uncertainty than in the previous row counts as independent
            step = np.sqrt(max(variance[i] - variance[before], 0.0))
            kept = min(1.0, np.sqrt(variance[i] / variance[before])) if variance[before] else 0.0
            error[i] = kept * error[before] + step * rng.standard_normal()
            before = i
    moved = np.interp(curve.temperature, shifts.temperature, error)
    return replace(curve, angular_frequency=curve.angular_frequency * 10**moved)


def _refitted(report: FitReport, curve: MasterCurve) -> Any:
    seen = observed(curve, poisson_ratio=report.observed.poisson_ratio)
    if len(report.observed.parts) == 1:
        seen = only(seen, report.observed.parts[0])
    else:
        seen = replace(seen, noise=report.observed.noise)
    if isinstance(report.material, Prony):
        arms = len(report.material.branches)
        return fit_series(seen, arms=arms).material
    known = {each.name: each.value for each in report.intervals if each.known}
    return fitted_constants(seen, model=report.model, known=known)[0]


def _wider(each: Interval, wider: float) -> Interval:
    """Add another error to an interval in quadrature; an unbounded side stays unbounded."""
    if each.known:
        return each
    low, high = each.low, each.high
    if low > 0:
        low = each.value * np.exp(-np.hypot(np.log(each.value / low), wider))
    if np.isfinite(high):
        high = each.value * np.exp(np.hypot(np.log(high / each.value), wider))
    return replace(each, low=float(low), high=float(high))
