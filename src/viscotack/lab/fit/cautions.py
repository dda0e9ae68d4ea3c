"""Cautions: constants and ranges that a measurement does not determine."""

from typing import Any

import numpy as np

from viscotack.model.materials.passport import LIQUID

from .observed import Observed, only
from .prony import NAMES, change, fit_series, open_ends
from .report import Fitted, Interval, Scatter

# Ratio of a plateau to the measured moduli above which the law extrapolates.
_BEYOND = 1.25
# Smallest number of points at which the shapes of the two moduli are compared.
_SHAPE = 8
# Decades between neighbouring points above which single arms show as steps.
_GAP = 1.5
# Root mean square of ln(measured/fitted) above which a model has failed.
_MISSED = 0.4
# Loss tangent at the slowest point above which a material flows. The most lossy
# rubbers reach 2 to 2.5 at their peak.
_FLOWS = 3.0
# Slope of ln(compliance) or -ln(modulus) over ln(time) above which a material flows.
_FLOWING = 0.8


def undetermined(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[str, ...]:
    """Return sentences on undetermined constants and on the ends of the measured range."""
    if getattr(material, "no_contact", ""):
        flowing = flow(data, material)
        liquid = (f"{LIQUID}: at the slowest point {flowing}",) if flowing else ()
        return (*liquid, material.no_contact, *_constants(data, material, intervals), _ends(data))
    if scatter_of(data, material) > _MISSED:
        return (_ends(data),)
    return (*_constants(data, material, intervals), _ends(data))


def _constants(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[str, ...]:
    """Return sentences on single undetermined constants."""
    words = []
    for each in intervals:
        if each.known:
            continue
        if each.name in NAMES:
            if each.told or each.name in open_ends(data, material):
                words += _plateau(data, material, each)
        elif not each.bounded:
            words.append(f"{each.name}: the data give no bound on one or both sides")
        elif each.high > 3 * each.low:
            words.append(f"{each.name} is known only to a factor of {each.high / each.low:.2g}")
    return tuple(words)


def misfit_cautions(data: Observed, material: Any, found: Scatter) -> tuple[str, ...]:
    """Return sentences on a poor fit and on correlated residuals."""
    words, missed = [], scatter_of(data, material)
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
    return tuple(words)


def scatter_of(data: Observed, material: Any) -> float:
    """Return the root mean square of ln(measured/fitted)."""
    return float(np.sqrt(np.mean(data.weighed(data.residuals(material)) ** 2)))


def series_cautions(data: Observed, found: Fitted, *, few: bool) -> tuple[str, ...]:
    """Return sentences on too many arms, gaps between points, and contradictory moduli."""
    words = []
    arms, numbers = found.grid, data.values.size
    if 2 * arms + 1 > numbers:
        words.append(
            f"{arms} arms have {2 * arms + 1} constants for {numbers} numbers: between the points "
            "the series is not determined"
        )
    steps = np.diff(np.log10(data.at))
    if np.max(steps) > _GAP:
        words.append(
            f"points are up to {np.max(steps):.2g} decades apart: in gaps beyond a decade the "
            "series rises in steps that were not measured; a power law interpolates smoothly"
        )
    if few:
        return tuple(words)
    if len(data.parts) == 2 and data.at.size >= _SHAPE and found.scatter.deviation > 0.05:
        alone = fit_series(only(data, "storage"))
        if found.scatter.deviation > 3 * alone.scatter.deviation:
            off = np.median(np.abs(np.expm1(data.residuals(alone.material)[1])))
            words.append(
                "storage and loss modulus contradict each other (Kramers-Kronig): a series that "
                f"fits storage to {100 * alone.scatter.deviation:.2g} % is {100 * off:.2g} % off "
                "the loss (median). A shift, a sweep or a calibration is wrong; this fit is a "
                "compromise"
            )
    return tuple(words)


def few_arms_caution(data: Observed, found: Fitted) -> tuple[str, ...]:
    """Return sentences on the accuracy lost by a given small number of arms."""
    few = len(found.material.branches)
    if data.values.size < 6:
        return ()
    free = fit_series(data)
    many, own = len(free.material.branches), scatter_of(data, found.material)
    best = scatter_of(data, free.material)
    if few >= many or own < 1.1 * best:
        return ()
    worst = float(np.max(np.abs(np.expm1(-data.residuals(found.material)))))
    return (
        f"the error of {few} arms is {100 * own:.2g} % and at most {100 * worst:.2g} %; the best "
        f"number, {many}, has {100 * best:.2g} %",
    )


def _ends(data: Observed) -> str:
    slow, fast = data.frequencies
    return (
        f"the measurement covers {1 / fast:.2g} s to {1 / slow:.2g} s; faster or slower "
        "response is an extrapolation"
    )


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
