"""What uncertain shifts do to a fit: the same fit to curves that the shifts allow as well."""

from dataclasses import replace
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.materials import Prony

from .fit_power_law import fitted_constants
from .fit_prony import fit_series
from .fit_report import FitReport, Interval
from .observed import observed, only
from .sweeps import MasterCurve, ShiftTable

_DRAWS = 12
_WORTH = 1.05  # of a half-width: less is not worth a sentence


def allow_for_shifts(report: FitReport, data: Any, shifts: Any, *, seed: int = 0) -> FitReport:
    """Return a report whose intervals hold the uncertainty of the shifts as well.

    Parameters
    ----------
    report : FitReport
        A fit to `data`.
    data : MasterCurve or another measurement
        What was fitted; a test over time stays as it is.
    shifts : ShiftTable or a law
        Its uncertainty is what counts; without one the report stays as it is.
    seed : int
        Of the shifts that are drawn.

    Notes
    -----
    Twelve tables are drawn, whose steps from row to row err apart, the master curve is shifted
    anew by each and the same law fitted. The spread of ln(constant) is added in quadrature to the
    half-width of its interval. The band of the report does not know of it.
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
            more = max(more, _width(intervals[-1]) / _width(each))
    cautions = report.cautions
    if more > _WORTH:
        worst = int(np.argmax(shifts.uncertainty))
        cautions = (
            *cautions,
            f"the shifts are known to {shifts.uncertainty[worst]:.2g} decades at "
            f"{shifts.temperature[worst] - 273.15:.4g} C: intervals are up to {more:.2g} times as "
            "wide as the scatter of the points alone makes them; the band is not",
        )
    return replace(report, intervals=tuple(intervals), cautions=cautions)


def _moved(curve: MasterCurve, shifts: ShiftTable, rng: np.random.Generator) -> MasterCurve:
    """Return the curve as other shifts within their uncertainty would make it."""
    assert shifts.uncertainty is not None and curve.temperature is not None, "checked before"
    variance = shifts.uncertainty**2
    zero = int(np.argmin(variance))
    error = np.zeros(variance.size)
    for side in (range(zero + 1, variance.size), range(zero - 1, -1, -1)):
        before = zero
        for i in side:
            # a row surer than the one before it errs on its own
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
        return fit_series(seen, arms=arms, level=report.level, draws=0, seed=0).material
    known = {each.name: each.value for each in report.intervals if each.known}
    return fitted_constants(seen, model=report.model, known=known)[0]


def _width(each: Interval) -> float:
    return float(np.log(each.high / each.low))


def _wider(each: Interval, wider: float) -> Interval:
    """Return an interval with another error in quadrature; an open end stays open."""
    if each.known:
        return each
    low, high = each.low, each.high
    if low > 0:
        low = each.value * np.exp(-np.hypot(np.log(each.value / low), wider))
    if np.isfinite(high):
        high = each.value * np.exp(np.hypot(np.log(high / each.value), wider))
    return replace(each, low=float(low), high=float(high))
