"""What a measurement cannot determine, in sentences that say so."""

from typing import Any

import numpy as np

from .fit_plateaus import change, open_ends
from .fit_prony import fit_series
from .fit_report import Fitted, Interval, Scatter
from .observed import Observed, only

# A law that puts a plateau this many times beyond the measured moduli extrapolates.
_BEYOND = 1.25
# Points from which on one modulus alone has a shape to be compared with the other.
_SHAPE = 8
# Decades between neighbouring points over which single arms show as stairs.
_GAP = 1.5
# Root mean square of ln(measured/fitted) from which on a model has missed.
_MISSED = 0.4
# Loss over storage modulus at the slowest point from which on a material flows. The most lossy
# rubbers reach 2 to 2.5 at their peak.
_FLOWS = 3.0
# Slope of ln(compliance), or fall of ln(modulus), over ln(time) from which on it does.
_FLOWING = 0.8


def undetermined(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[str, ...]:
    """Return what the measurement cannot say of the constants, and where it ends."""
    if getattr(material, "no_contact", ""):
        flowing = flow(data, material)
        liquid = (f"this is a liquid: at the slowest point {flowing}",) if flowing else ()
        return (*liquid, material.no_contact, *_constants(data, material, intervals), _ends(data))
    if scatter_of(data, material) > _MISSED:
        return (_ends(data),)
    return (*_constants(data, material, intervals), _ends(data))


def _constants(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[str, ...]:
    """Return what the measurement cannot say of single constants."""
    said = {"rubbery_modulus": _rubbery, "glassy_modulus": _glassy}
    words = []
    for each in intervals:
        if each.known:
            continue
        if not each.told:
            if each.name in open_ends(data, material):
                words += said[each.name](data, material, each)
        elif each.name in said:
            words += said[each.name](data, material, each)
        elif not each.bounded:
            words.append(f"{each.name}: the data set no bound on one side or on both")
        elif each.high > 3 * each.low:
            words.append(
                f"{each.name} is known only to a factor of {each.high / each.low:.2g}; "
                "the constants can make up for each other"
            )
    return tuple(words)


def misfit_cautions(data: Observed, material: Any, found: Scatter) -> tuple[str, ...]:
    """Return what the residuals say of the fit: a model that misses, neighbours that err alike."""
    words = []
    if scatter_of(data, material) > _MISSED:
        words.append(
            "this model does not describe the measurement: it is off by a factor of "
            f"{np.exp(scatter_of(data, material)):.2g} on average. Its constants and intervals "
            "mean nothing; choose another model"
        )
    if np.max(data.noise) > 1:
        noise = dict(zip(data.parts, data.noise, strict=True))
        worse = max(noise, key=lambda part: noise[part])
        words.append(
            f"the {worse} modulus scatters {noise[worse]:.2g} times as much as the other part "
            "about a smooth curve, and counts by so much less"
        )
    if found.shared:
        words.append(f"{found.shared}; the intervals are wider for it")
    return tuple(words)


def scatter_of(data: Observed, material: Any) -> float:
    """Return the root of the mean square of ln(measured/fitted)."""
    return float(np.sqrt(np.mean(data.weighed(data.residuals(material)) ** 2)))


def series_cautions(data: Observed, found: Fitted, *, few: bool) -> tuple[str, ...]:
    """Return what to know of a fitted series: too many constants, gaps, moduli that contradict."""
    words = []
    arms, numbers = found.grid, data.values.size
    if 2 * arms + 1 > numbers:
        words.append(
            f"{arms} arms are {2 * arms + 1} constants (moduli, times and the rubbery modulus) on "
            f"{numbers} numbers; with times on a grid {arms + 1} moduli are fitted, none negative, "
            f"and {found.constants} are not zero. Between the points the series is not determined"
        )
    steps = np.diff(np.log10(data.at))
    if np.max(steps) > _GAP:
        words.append(
            f"points are up to {np.max(steps):.2g} decades apart, and one arm reaches over about "
            "one: in such gaps the series rises in stairs that nobody measured, and its band does "
            "not show it; a power law goes smoothly through them"
        )
    if few:
        return tuple(words)
    if len(data.parts) == 2 and data.at.size >= _SHAPE and found.scatter.deviation > 0.05:
        alone = fit_series(only(data, "storage"), arms=None, level=0.9, draws=0, seed=0)
        if found.scatter.deviation > 3 * alone.scatter.deviation:
            off = np.median(np.abs(np.expm1(data.residuals(alone.material)[1])))
            words.append(
                "storage and loss modulus contradict each other (Kramers-Kronig): a series that "
                f"meets the storage modulus to {100 * alone.scatter.deviation:.2g} % has a loss "
                f"that is {100 * off:.2g} % off the measured one in the median. Shift factors, a "
                "sweep or a calibration are wrong; this fit is a compromise, and one without the "
                "loss modulus trusts the storage modulus alone"
            )
    return tuple(words)


def few_arms_caution(data: Observed, found: Fitted) -> tuple[str, ...]:
    """Return what a given number of arms costs beside as many as the data carry."""
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
        f"{few} arms meet the measurement to {100 * own:.2g} % on average and {100 * worst:.2g} % "
        f"at worst; the {many} that the data carry, to {100 * best:.2g} %",
    )


def _ends(data: Observed) -> str:
    slow, fast = data.frequencies
    return (
        f"nothing faster than {1 / fast:.2g} s or slower than {1 / slow:.2g} s was measured; "
        "what happens in such times is the model's guess"
    )


def flow(data: Observed, material: Any) -> str:
    """Return that a material flows at the slowest point and with which viscosity, or nothing."""
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
        how = f"the {what} as time to the power {abs(slope):.2g}"
        # stress over the rate of strain of a creep; at least, from a relaxation
        viscosity = end / near[1] / slope if creeping else end * near[1]
    return f"{how} (shear viscosity about {viscosity / shear:.2g} Pa s)"


def _rubbery(data: Observed, material: Any, interval: Interval) -> list[str]:
    softest = data.moduli[0]
    flowing = flow(data, material)
    if flowing:
        return [
            f"this is a liquid: at the slowest point {flowing}. It has no rubbery plateau; "
            f"rubbery_modulus = {interval.value:.3g} Pa is where the fit ends and no property of "
            "the material, and what rests on it (a relaxed contact, slow detachment) is not known"
        ]
    if not interval.bounded:
        rate = 100 * change(data, material, interval.name)
        return [
            "no rubbery plateau was measured: at the slowest point the modulus still falls by "
            f"{rate:.2g} % a decade. rubbery_modulus is {_bound(interval)}, and slow detachment "
            "cannot be forecast; give it if you know it"
        ]
    if softest > _BEYOND * interval.value:
        return [
            f"rubbery_modulus lies {softest / interval.value:.3g} times below the softest point: "
            "the law says so, not the data, and its interval holds only if the law does"
        ]
    return []


def _glassy(data: Observed, material: Any, interval: Interval) -> list[str]:
    stiffest = data.moduli[1]
    if not interval.bounded:
        rate = 100 * change(data, material, interval.name)
        least = interval.low if interval.told else interval.value
        ratio = material.rubbery_modulus / max(least, material.rubbery_modulus)
        return [
            "no glassy plateau was measured: at the fastest point the modulus still rises by "
            f"{rate:.2g} % a decade. glassy_modulus is {_bound(interval)} and "
            f"modulus_ratio at most {ratio:.2g}, so that fast detachment may hold up to 1/k times "
            "the slow force with k unknown; give glassy_modulus if you know it"
        ]
    if interval.value > _BEYOND * stiffest:
        return [
            f"glassy_modulus lies {interval.value / stiffest:.3g} times above the stiffest point: "
            "the law says so, not the data, and its interval holds only if the law does"
        ]
    return []


def _bound(interval: Interval) -> str:
    if not interval.told:
        return "a guess"
    if np.isfinite(interval.high):
        return f"at most {interval.high:.3g} Pa"
    return f"at least {interval.low:.3g} Pa" if interval.low > 0 else "not bounded"
