"""Cautions: constants and ranges that a measurement does not determine."""

from typing import Any

import numpy as np

from viscotack.materials.passport import LIQUID

from .observed import Observed, only
from .plateaus import NAMES, change, open_ends
from .prony import fit_series
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
            words.append(
                f"{each.name} is known only to a factor of {each.high / each.low:.2g}; "
                "the constants compensate each other"
            )
    return tuple(words)


def misfit_cautions(data: Observed, material: Any, found: Scatter) -> tuple[str, ...]:
    """Return sentences on a poor fit and on correlated residuals."""
    words = []
    if scatter_of(data, material) > _MISSED:
        words.append(
            "this model does not describe the measurement: its root mean square error is a "
            f"factor of {np.exp(scatter_of(data, material)):.2g}. Its constants and intervals are "
            "meaningless; choose another model"
        )
    if np.max(data.noise) > 1:
        noise = dict(zip(data.parts, data.noise, strict=True))
        worse = max(noise, key=lambda part: noise[part])
        words.append(
            f"the scatter of the {worse} modulus about a smooth curve is {noise[worse]:.2g} times "
            "that of the other part; its weight is reduced accordingly"
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
            f"{arms} arms have {2 * arms + 1} constants (moduli, times and the rubbery modulus) "
            f"for {numbers} numbers; with times on a grid {arms + 1} non-negative moduli are "
            f"fitted, of which {found.constants} are not zero. Between the points the series is "
            "not determined"
        )
    steps = np.diff(np.log10(data.at))
    if np.max(steps) > _GAP:
        words.append(
            f"points are up to {np.max(steps):.2g} decades apart, and one arm covers about one "
            "decade: in such gaps the series rises in steps that were not measured and that its "
            "band does not show; a power law interpolates smoothly"
        )
    if few:
        return tuple(words)
    if len(data.parts) == 2 and data.at.size >= _SHAPE and found.scatter.deviation > 0.05:
        alone = fit_series(only(data, "storage"), arms=None, level=0.9, draws=0, seed=0)
        if found.scatter.deviation > 3 * alone.scatter.deviation:
            off = np.median(np.abs(np.expm1(data.residuals(alone.material)[1])))
            words.append(
                "storage and loss modulus contradict each other (Kramers-Kronig): a series that "
                f"fits the storage modulus to {100 * alone.scatter.deviation:.2g} % has a loss "
                f"modulus {100 * off:.2g} % off the measured one (median). Shift factors, a sweep "
                "or a calibration are wrong; this fit is a compromise, and a fit without the "
                "loss modulus relies on the storage modulus alone"
            )
    return tuple(words)


def few_arms_caution(data: Observed, found: Fitted) -> tuple[str, ...]:
    """Return sentences on the accuracy lost by a given small number of arms."""
    few = len(found.material.branches)
    if data.values.size < 6:
        return ()
    free = fit_series(data, arms=None, level=0.9, draws=0, seed=0)
    many, own = len(free.material.branches), scatter_of(data, found.material)
    best = scatter_of(data, free.material)
    if few >= many or own < 1.1 * best:
        return ()
    worst = float(np.max(np.abs(np.expm1(-data.residuals(found.material)))))
    return (
        f"the error of {few} arms is {100 * own:.2g} % on average and {100 * worst:.2g} % "
        f"at most; with {many} arms, the best number for these data, it is {100 * best:.2g} %",
    )


def _ends(data: Observed) -> str:
    slow, fast = data.frequencies
    return (
        f"the measurement covers {1 / fast:.2g} s to {1 / slow:.2g} s; "
        "faster or slower response is an extrapolation of the model"
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
            f"{LIQUID}: at the slowest point {flowing}. It has no rubbery plateau; "
            f"rubbery_modulus = {interval.value:.3g} Pa is the end of the fit, not a property of "
            "the material, so relaxed contact and slow detachment cannot be predicted"
        ]
    if not interval.bounded:
        rate = 100 * change(data, material, interval.name)
        least = interval.low if interval.told else interval.value
        ratio = material.rubbery_modulus / max(least, material.rubbery_modulus)
        plateau, place, way, unknown = (
            ("rubbery", "slowest", "falls", ", and slow detachment cannot be predicted")
            if rubbery
            else (
                "glassy",
                "fastest",
                "rises",
                f" and modulus_ratio at most {ratio:.2g}, so the bound 1/k on the ratio of fast to "
                "slow pull-off force is unknown",
            )
        )
        return [
            f"the {plateau} plateau was not measured: at the {place} point the modulus still {way} "
            f"by {rate:.2g} % per decade. {interval.name} is {_bound(interval)}{unknown}; give "
            f"{interval.name} if you know it"
        ]
    beyond = data.moduli[0] / interval.value if rubbery else interval.value / data.moduli[1]
    if beyond <= _BEYOND:
        return []
    end = "below the softest" if rubbery else "above the stiffest"
    return [
        f"{interval.name} lies {beyond:.3g} times {end} point: it is an extrapolation of the law, "
        "and so is its interval"
    ]


def _bound(interval: Interval) -> str:
    if not interval.told:
        return "a guess"
    if np.isfinite(interval.high):
        return f"at most {interval.high:.3g} Pa"
    return f"at least {interval.low:.3g} Pa" if interval.low > 0 else "not bounded"
