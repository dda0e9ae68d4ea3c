"""What a measurement cannot determine, in sentences that say so."""

from dataclasses import replace
from typing import Any

import numpy as np

from viscotack.materials import Prony

from .fit_prony import FittedSeries, fit_series
from .fit_report import Interval, Scatter
from .observed import Observed, only

# A modulus that changes by more than this share a decade is on no plateau.
_PLATEAU = 0.05
# A law that puts a plateau this many times beyond the measured moduli extrapolates.
_BEYOND = 1.25
# Points from which on one modulus alone has a shape to be compared with the other.
_SHAPE = 8
# Decades between neighbouring points over which single arms show as stairs.
_GAP = 1.5
# Root mean square of ln(measured/fitted) from which on a model has missed.
_MISSED = 0.4


def opened(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[Interval, ...]:
    """Return the intervals, without an outer end where no plateau was measured.

    A series of arms ends where the measurement ends, and takes the last modulus for the plateau;
    its bootstrap cannot know what lies beyond. A law that goes on beyond has its own intervals.
    """
    if not isinstance(material, Prony):
        return intervals
    found = []
    for each in intervals:
        if _change(data, material, each.name) > _PLATEAU:
            rubbery = each.name == "rubbery_modulus"
            each = replace(each, low=0.0) if rubbery else replace(each, high=np.inf)
        found.append(each)
    return tuple(found)


def undetermined(data: Observed, material: Any, intervals: tuple[Interval, ...]) -> tuple[str, ...]:
    """Return what the measurement cannot say of the constants, and where it ends."""
    if scatter_of(data, material) > _MISSED:
        return (_ends(data),)
    said = {"rubbery_modulus": _rubbery, "glassy_modulus": _glassy}
    words = []
    for each in intervals:
        if each.known:
            continue
        if each.name in said:
            words += said[each.name](data, material, each)
        elif not each.bounded:
            words.append(f"{each.name}: the data set no bound on one side or on both")
        elif each.high > 3 * each.low:
            words.append(
                f"{each.name} is known only to a factor of {each.high / each.low:.2g}; "
                "the constants can make up for each other"
            )
    return (*words, _ends(data))


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
    if found.correlation > 0:
        words.append(
            f"neighbouring residuals err alike (correlation {found.correlation:.2f}): the model, "
            f"or a sweep, is off in places; intervals were widened {found.widening:.1f} times"
        )
    return tuple(words)


def scatter_of(data: Observed, material: Any) -> float:
    """Return the root of the mean square of ln(measured/fitted)."""
    return float(np.sqrt(np.mean(data.weighed(data.residuals(material)) ** 2)))


def series_cautions(data: Observed, found: FittedSeries) -> tuple[str, ...]:
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


def _ends(data: Observed) -> str:
    slow, fast = data.frequencies
    return (
        f"nothing faster than {1 / fast:.2g} s or slower than {1 / slow:.2g} s was measured; "
        "what happens in such times is the model's guess"
    )


def _change(data: Observed, material: Any, name: str) -> float:
    """Return by which share a decade the modulus still changes at the end next to a plateau."""
    slow = name == "rubbery_modulus"
    if data.in_frequency:
        modulus = complex(material.complex_modulus(data.frequencies[0 if slow else 1]))
        # d ln E'/d ln omega is about 2/pi times the loss angle
        return float(10 ** (2 / np.pi * np.angle(modulus)) - 1)
    end = data.at[-1] if slow else data.at[0]
    ratio = data.predicted(material, [end / np.sqrt(10), end * np.sqrt(10)])[0]
    return float(np.exp(abs(np.log(ratio[1] / ratio[0]))) - 1)


def _rubbery(data: Observed, material: Any, interval: Interval) -> list[str]:
    softest = data.moduli[0]
    if not interval.bounded:
        change = 100 * _change(data, material, interval.name)
        return [
            "no rubbery plateau was measured: at the slowest point the modulus still falls by "
            f"{change:.2g} % a decade. rubbery_modulus is {_bound(interval)}, and slow detachment "
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
        change = 100 * _change(data, material, interval.name)
        ratio = material.rubbery_modulus / max(interval.low, material.rubbery_modulus)
        return [
            "no glassy plateau was measured: at the fastest point the modulus still rises by "
            f"{change:.2g} % a decade. glassy_modulus is {_bound(interval)} and "
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
    if np.isfinite(interval.high):
        return f"at most {interval.high:.3g} Pa"
    return f"at least {interval.low:.3g} Pa" if interval.low > 0 else "not bounded"
