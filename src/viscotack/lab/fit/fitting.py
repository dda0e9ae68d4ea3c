"""Fit a material model to measured moduli, with intervals and cautions.

:func:`fit` fits every model and returns a report of the quality of the fit.

Sentences state constants and ranges that a measurement does not determine. The uncertainty of shift
factors is propagated by fitting shifted curves again.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.lab.sweeps import MasterCurve, celsius
from viscotack.model.materials.passport import LIQUID
from viscotack.model.materials.shift import TabulatedShift
from viscotack.threads import one_blas_thread
from viscotack.units import readable

from .observed import Data, Observed, observed, only, thinned
from .power_law import KINDS, fit_constants
from .prony import NAMES, change, fit_series, open_ends, with_noise
from .report import ALIKE, FitReport, Interval

# Ratio of a plateau to the measured moduli above which the law extrapolates.
_BEYOND = 1.25
# Decades between neighbouring points above which single arms show as steps.
_GAP = 1.5
# Root mean square of ln(measured/fitted) above which a model has failed.
_MISSED = 0.4
# Loss tangent at the slowest point above which a material flows. The most lossy
# rubbers reach 2 to 2.5 at their peak.
_FLOWS = 3.0
# Slope of ln(compliance) or -ln(modulus) over ln(time) above which a material flows.
_FLOWING = 0.8


def undetermined(found: FitReport) -> tuple[str, ...]:
    """Return sentences on undetermined constants and on the ends of the measured range."""
    data, material = found.observed, found.material
    words = []
    # constants of a model that has failed mean nothing
    failed = scatter_of(found) > _MISSED
    for each in () if failed else [each for each in found.intervals if not each.known]:
        if each.name in NAMES:
            if each.told or each.name in open_ends(data, material):
                words += _plateau(data, material, each)
        elif not each.bounded:
            words.append(f"{each.name}: the data give no bound on one or both sides")
        elif each.high > 3 * each.low:
            words.append(f"{each.name} is known only to a factor of {each.high / each.low:.2g}")
    slow, fast = data.frequencies
    words.append(
        f"the measurement covers {1 / fast:.2g} s to {1 / slow:.2g} s; faster or slower "
        "response is an extrapolation"
    )
    return tuple(words)


def cautions(found: FitReport, arms: int | None) -> list[str]:
    """Return sentences on a poor fit, on correlated residuals, and on the arms of a series.

    `arms` is their number if it was given.
    """
    data, words, missed = found.observed, [], scatter_of(found)
    if missed > _MISSED:
        words.append(
            f"this model does not describe the measurement, off by a factor of {np.exp(missed):.2g}"
            ": its constants and intervals are meaningless; choose another model"
        )
    if np.max(data.noise) > 1:
        noise = dict(zip(data.parts, data.noise, strict=True))
        worse = max(noise, key=lambda part: noise[part])
        words.append(
            f"the {worse} modulus scatters {noise[worse]:.2g} times as much as the other part; its "
            "weight is reduced accordingly"
        )
    if found.shared:
        words.append(f"{found.shared}; the intervals are widened accordingly")
    numbers = data.values.size
    if arms is not None and numbers >= 6:
        free, few = fit_series(data), len(found.material.branches)
        many, best = len(free.material.branches), scatter_of(free)
        if few < many and missed >= 1.1 * best:
            worst = float(np.max(np.abs(np.expm1(-found.residuals))))
            words.append(
                f"the error of {few} arms is {100 * missed:.2g} % and at most {100 * worst:.2g} %; "
                f"the best number, {many}, has {100 * best:.2g} %"
            )
    if found.model == "prony" and found.draws:
        unknown, steps = 2 * found.grid + 1, np.diff(np.log10(data.at))
        if unknown > numbers:
            words.append(
                f"{found.grid} arms have {unknown} constants for {numbers} numbers: between the "
                "points the series is not determined"
            )
        if np.max(steps) > _GAP:
            words.append(
                f"points are up to {np.max(steps):.2g} decades apart: in gaps beyond a decade the "
                "series rises in steps that were not measured; a power law interpolates smoothly"
            )
    return words


def scatter_of(found: FitReport) -> float:
    """Return the root mean square of ln(measured/fitted)."""
    return float(np.sqrt(np.mean(found.observed.weighed(found.residuals) ** 2)))


def flow(data: Observed, material: Any) -> str:
    """Describe the flow and viscosity of a liquid at the slowest point; empty for a solid."""
    shear = 2 * (1 + data.poisson_ratio)
    if data.in_frequency:
        slow = data.frequencies[0]
        modulus = complex(material.complex_modulus(slow))
        if modulus.imag < _FLOWS * modulus.real:
            return ""
        ratio = modulus.imag / max(modulus.real, 1e-12 * modulus.imag)
        how = f"the loss modulus is {ratio:.2g} times the storage modulus"
        viscosity = modulus.imag / slow
    else:
        end = float(data.at[-1])
        near = data.predicted(material, [end / np.sqrt(10), end])[0]
        slope = float(np.log(near[1] / near[0]) / np.log(np.sqrt(10)))
        creeping = data.quantity == "creep"
        if (slope if creeping else -slope) < _FLOWING:
            return ""
        what = "compliance rises" if creeping else "modulus falls"
        how = f"the {what} with time to the power {abs(slope):.2g}"
        # creep: stress over strain rate; relaxation: a lower bound
        viscosity = end / near[1] / slope if creeping else end * near[1]
    return f"{how} (shear viscosity about {viscosity / shear:.2g} Pa s)"


def _plateau(data: Observed, material: Any, interval: Interval) -> list[str]:
    """Return a sentence on a plateau that was not measured, or lies beyond the measurement."""
    rubbery = interval.name == "rubbery_modulus"
    if rubbery and (flowing := flow(data, material)):
        return [
            f"{LIQUID}: at the slowest point {flowing}. It has no rubbery plateau; rubbery_modulus "
            f"= {interval.value:.3g} Pa is the end of the fit, not a property: relaxed contact and "
            "slow detachment cannot be predicted"
        ]
    if interval.bounded:
        beyond = data.moduli[0] / interval.value if rubbery else interval.value / data.moduli[1]
        end = "below the softest" if rubbery else "above the stiffest"
        words = f"{interval.name} lies {beyond:.3g} times {end} point: it extrapolates the law"
        return [words] if beyond > _BEYOND else []
    ratio = material.rubbery_modulus / max(
        interval.low if interval.told else interval.value, material.rubbery_modulus
    )
    at, unknown = (
        ("slowest", "slow detachment cannot be predicted")
        if rubbery
        else ("fastest", f"modulus_ratio at most {ratio:.2g}: the largest pull-off is unknown")
    )
    bound = "not bounded" if interval.told else "a guess"
    if interval.told and np.isfinite(interval.high):
        bound = f"at most {interval.high:.3g} Pa"
    elif interval.told and interval.low > 0:
        bound = f"at least {interval.low:.3g} Pa"
    return [
        f"the {interval.name.partition('_')[0]} plateau was not measured: at the {at} point the "
        f"modulus still changes by {100 * change(data, material, interval.name):.2g} % per decade. "
        f"{interval.name} is {bound}, and {unknown}; give {interval.name} if you know it"
    ]


MODELS = (*KINDS, "prony")


def fit(
    data: Data,
    *,
    poisson_ratio: float,
    model: str = "best",
    arms: int | None = None,
    known: Mapping[str, float] | None = None,
    loss: bool = True,
    level: float = 0.9,
    draws: int = 100,
    seed: int = 0,
) -> FitReport:
    r"""Fit a material model to a master curve, one sweep, or a test over time.

    Minimises the sum of squares of ln(measured/fitted) over all numbers. Storage and loss modulus
    have equal weights, unless the scatter of one about its own smooth curve is more than twice the
    other's: then each is weighted by its scatter.

    Parameters
    ----------
    data : MasterCurve, FrequencySweeps, RelaxationTest or CreepTest
        Measurement at one temperature. Shear moduli are converted to tensile ones by the Poisson
        ratio, because all materials of this package are tensile.
    poisson_ratio : float
        Poisson ratio nu, in [0, 0.5], constant; 0.5 for rubber, about 0.35 for a glass.
    model : str
        "power-law" (:class:`viscotack.RetardationPowerLaw`), "relaxation-power-law", "sls",
        "fractional-zener", "prony"; or "best": all are fitted, and of those within 2 of the
        smallest corrected Akaike criterion the one with the fewest constants is chosen.
    arms : int, optional
        Number of relaxation times of a Prony series, on a logarithmic grid; up to 12 times are
        optimised. By default the criterion chooses. Arms of zero modulus are dropped. A caution
        states the accuracy lost by few arms.
    known : mapping, optional
        Constants that are not fitted, in SI, such as ``{"glassy_modulus": 3e9}`` for a plateau
        known from elsewhere. For all models except "prony" and "best".
    loss : bool
        Whether to fit the loss modulus; False if it contradicts the storage modulus.
    level : float
        Confidence level of the intervals and the band.
    draws : int
        Number of solids to sample from the uncertainty; 0: none, and no intervals of a Prony
        series.
    seed : int
        Seed of the random numbers; the same seed gives the same report.

    Returns
    -------
    FitReport
        Material, intervals, residuals, and cautions.

    Raises
    ------
    ValueError
        If the data are unsuitable, a model or constant is unknown, or options contradict each
        other.

    Notes
    -----
    Intervals assume that the model is right. They account for noise that grows towards one end, for
    errors common to a sweep and for instrument drift; correlated errors widen them. Intervals of
    a Prony series are given for its plateaus only, over all series on a dense grid of times,
    because its single arms are not determined.

    Examples
    --------
    Fitting the rounded moduli of a standard solid recovers its constants:

    >>> import numpy as np
    >>> from viscotack.lab.sweeps import MasterCurve, celsius
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> omega = np.geomspace(0.1, 1e4, 16)
    >>> modulus = solid.complex_modulus(omega)
    >>> storage, loss = np.round(modulus.real, -3), np.round(modulus.imag, -3)
    >>> report = fit(MasterCurve(293.15, omega, storage, loss, "E"), poisson_ratio=0.5, model="sls")
    >>> f"{report.material.tau0:.3f} s, {report.material.glassy_modulus / 1e6:.2f} MPa"
    '0.100 s, 10.00 MPa'
    """
    if model not in (*MODELS, "best"):
        raise InputError(f"model must be one of {', '.join(MODELS)} or best, got {model!r}")
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level}")
    if arms is not None and model != "prony":
        raise InputError(f"arms apply to the model prony only, got model {model}")
    if known and model in ("prony", "best"):
        raise InputError(f"known constants apply to {', '.join(KINDS)} only, got model {model}")
    seen = observed(data, poisson_ratio=poisson_ratio)
    if not loss:
        seen = only(seen, "storage")
    constants = {each: 3 if each in ("sls", "prony") else 4 for each in MODELS}
    affordable = [each for each in MODELS if seen.values.size > constants[each] + 3]
    if model == "best" and not affordable:
        raise InputError(f"{seen.values.size} numbers are too few to compare models; name one")
    with one_blas_thread():
        seen = with_noise(thinned(seen))
        # without intervals, which only the model that is used needs
        tried = [_fitted(seen, each) for each in (affordable if model == "best" else ())]
        alike = _alike(tried)
        if alike:
            model = alike[0].model
        found = _fitted(seen, model, arms, known or {}, level=level, draws=draws, seed=seed)
        if tried:
            found = replace(found, compared=tuple((one.model, one.criterion) for one in tried))
        words = (*cautions(found, arms), *seen.source.notes[-1:] * bool(seen.points))
        unknown = (*undetermined(found), *_undecided(alike))
        return replace(found, level=level, undetermined=unknown, cautions=words)


def _fitted(
    data: Observed,
    model: str,
    arms: int | None = None,
    known: Mapping[str, float] | None = None,
    **more: Any,
) -> FitReport:
    """Return one model fitted to measured numbers; without `level` and `draws`, no intervals."""
    if model == "prony":
        return fit_series(data, arms=arms, **more)
    return fit_constants(data, model=model, known=known or {}, **more)


def _alike(tried: Sequence[FitReport]) -> list[FitReport]:
    """Return the models that the data do not distinguish from the best, the simplest first."""
    least = min((one.criterion for one in tried), default=0.0)
    alike = [one for one in tried if one.criterion <= least + ALIKE]
    return sorted(alike, key=lambda one: (one.constants, one.criterion))


def _undecided(alike: Sequence[FitReport]) -> tuple[str, ...]:
    """Return a sentence on the models that the data do not distinguish, with their plateaus."""
    if len(alike) < 2:
        return ()
    least, each = min(one.criterion for one in alike), []
    for one in alike:
        ends = (one.material.rubbery_modulus, one.material.glassy_modulus)
        rubbery, glassy = (readable(end, "Pa", digits=3) for end in ends)
        above = f"{one.constants} constants, criterion {one.criterion - least:+.1f}"
        each.append(f"{one.model} ({above}; rubbery {rubbery}, glassy {glassy})")
    return (
        f"the data do not distinguish {' from '.join(each)}; the one with the fewest constants is "
        "used; `model` fits another",
    )


_DRAWS = 12
_WORTH = 1.05  # ratio of half-widths above which a caution is added


def allow_for_shifts(report: FitReport, data: Any, shifts: Any) -> FitReport:
    """Widen the intervals of a report by the uncertainty of the shifts.

    Parameters
    ----------
    report : FitReport
        A fit to `data`.
    data : MasterCurve or another measurement
        Fitted data; tests over time leave the report unchanged.
    shifts : TabulatedShift or a law
        Shifts with their uncertainty; without one the report is unchanged.

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
    if not isinstance(data, MasterCurve) or not isinstance(shifts, TabulatedShift):
        return report
    if data.temperature is None or not np.any(shifts.uncertainty):
        return report
    rng = np.random.default_rng(0)
    seen, known = report.observed, {x.name: x.value for x in report.intervals if x.known}
    found = []
    for _ in range(_DRAWS):
        moved = observed(_moved(data, shifts, rng), poisson_ratio=seen.poisson_ratio)
        if len(seen.parts) == 1:
            moved = only(moved, seen.parts[0])
        moved = replace(moved, noise=seen.noise)
        arms = len(report.material.branches) if report.model == "prony" else None
        found.append(_fitted(moved, report.model, arms, known).material)
    quantile = NormalDist().inv_cdf((1 + report.level) / 2)
    intervals, more = [], 1.0
    for each in report.intervals:
        logs = np.log([getattr(solid, each.name) for solid in found])
        wider, low, high = quantile * float(np.std(logs, ddof=1)), each.low, each.high
        # in quadrature; an unbounded side stays unbounded
        if not each.known and low > 0:
            low = float(each.value * np.exp(-np.hypot(np.log(each.value / low), wider)))
        if not each.known and np.isfinite(high):
            high = float(each.value * np.exp(np.hypot(np.log(high / each.value), wider)))
        intervals.append(replace(each, low=low, high=high))
        if each.bounded and not each.known and each.high > each.low:
            more = max(more, float(np.log(high / low) / np.log(each.high / each.low)))
    cautions = report.cautions
    if more > _WORTH:
        worst = int(np.argmax(shifts.uncertainty))
        cautions += (
            f"the uncertainty of the shifts, {shifts.uncertainty[worst]:.2g} decades at "
            f"{celsius(shifts.temperature[worst])}, widens intervals by up to a factor of "
            f"{more:.2g}, but not the band",
        )
    return replace(report, intervals=tuple(intervals), cautions=cautions)


def _moved(curve: MasterCurve, shifts: TabulatedShift, rng: np.random.Generator) -> MasterCurve:
    """Return the curve with random shifts within their uncertainty."""
    assert curve.temperature is not None, "checked by the caller"
    variance = np.array(shifts.uncertainty) ** 2
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
