r"""Growth of the work of adhesion with contact time, from tests at one speed after several dwells.

The pull-off force of an elastic sphere with forces of short range is :math:`1.5 \pi R w` (JKR), so
the force after a time t in contact is that of a new one times :math:`1 + G(t)`. Two laws of
:mod:`viscotack.traction.ageing` are fitted by least squares to the logarithms of the forces:
:math:`G = s \ln(1 + t/t_0)` and :math:`G = g (1 - e^{-t/t_0})`. Each has a profile likelihood over
t0. A logarithmic growth observed at times far above t0 alone does not determine t0: the data then
have the work after one time and its growth in a decade.

The edge of the contact touches later than its middle: forces simulated with a logarithmic interface
grow by 6 % less in a decade than their interface does (`tests/test_identify_dwell.py`).

The time in contact is that from the start of the dwell to the pull-off. Bulk relaxation in the
dwell changes the force too; :func:`check_relaxed` refuses solids for which it may.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack import Cycle
from viscotack.materials import Material
from viscotack.traction import LogarithmicAgeing, SaturatingAgeing
from viscotack.units import readable

from .pull_off import same_speeds

# Fewest tests and dwells, and smallest ratio of the longest to the shortest time.
_FEWEST, _DWELLS, _RANGE = 4, 3, 5.0
# Reference times over the observed ones: decades beyond them, and number in each decade.
_BEYOND, _PER_DECADE = 2, 20
# Probability below which a growth is not chance.
_CHANCE = 0.01
# ... and that above which tests of one speed count as repeats, so that few series are refused by
# chance.
_CERTAIN = 1e-3
# Ratio of dwells above which tests at one speed are no repeats, and change of the modulus in the
# dwells that may be neglected.
_APART, _LEFT = 2.0, 0.02
# Dwell times of an undetermined law begin at this multiple of its reference time.
_ABOVE = 10.0
_SATURATING, _LOGARITHMIC = SaturatingAgeing.word, LogarithmicAgeing.word
# Difference of chi2 that distinguishes both laws.
_DIFFERENT = 6.0
# Smallest relative uncertainty of a force.
_LEAST = 1e-6


@dataclass(frozen=True)
class DwellFit:
    """Growth of the work of adhesion with the time in contact.

    Attributes
    ----------
    times, forces : tuple of float
        Times in contact [s] and pull-off forces [N] of the tests, by time.
    law : str or None
        "logarithmic-ageing" or "saturating-ageing"; None without growth or where both fit.
    work_of_adhesion : float
        Work after the geometric mean of the times [J/m^2], by JKR.
    growth_per_decade : float
        Increase of the work in a decade over the work at the geometric mean time.
    interval : (float, float)
        Interval of this increase at `level`.
    reference_time : (float, float)
        Interval of t0 of the law [s]; 0 or inf where the data do not limit it.
    parameters : mapping
        Constants of the law, for its card: "work_of_adhesion", "reference_time" and "sensitivity"
        or "largest_growth"; empty without a law.
    scatter : float
        Relative standard deviation of the forces around the line in the logarithm of the time.
    level : float
        Confidence level.
    words : tuple of str
        Sentences on the result.
    radius : float
        Radius of the sphere [m].
    """

    times: tuple[float, ...]
    forces: tuple[float, ...]
    law: str | None
    work_of_adhesion: float
    growth_per_decade: float
    interval: tuple[float, float]
    reference_time: tuple[float, float]
    parameters: dict[str, float]
    scatter: float
    level: float
    words: tuple[str, ...]
    radius: float

    def line(self, time: Array) -> Array:
        """Return the pull-off forces [N] that are straight in the logarithm of the time [s]."""
        middle = np.exp(np.log(self.times).mean())
        growth = self.growth_per_decade * np.log10(time / middle)
        return 1.5 * np.pi * self.radius * self.work_of_adhesion * (1 + growth)

    def force(self, time: Array) -> Array:
        """Return the pull-off forces [N] of the law after times in contact [s]."""
        kind = {_LOGARITHMIC: LogarithmicAgeing, _SATURATING: SaturatingAgeing}[str(self.law)]
        law: Any = kind(equilibrium_gap=1.0, **self.parameters)
        work = law.work_of_adhesion * (1 + law.growth_after(time))
        return 1.5 * np.pi * self.radius * work


def tests_by_dwell(cycles: Sequence[Cycle]) -> tuple[Array, Array, float]:
    """Return times in contact [s] and forces [N] of tests at one speed, and their uncertainty.

    Raises
    ------
    ValueError
        If the tests have several speeds.
    """
    speeds = same_speeds(cycles)
    if len(speeds) > 1:
        listed = ", ".join(readable(same[0].speed.value, "m/s", digits=3) for same in speeds)
        raise InputError(
            f"tests at {listed}: the force grows with speed and with dwell; give the files of one "
            "speed"
        )
    times = np.array([_in_contact(one) for one in cycles])
    forces = np.array([one.pull_off_force.value for one in cycles])
    own = np.mean([one.pull_off_force.uncertainty / one.pull_off_force.value for one in cycles])
    return times, forces, float(own)


def identify_dwell(
    times: Sequence[float] | Array,
    forces: Sequence[float] | Array,
    *,
    radius: float,
    uncertainty: float = 0.0,
    level: float = 0.9,
) -> DwellFit:
    """Fit the growth of the work of adhesion with contact time to pull-off forces at one speed.

    Parameters
    ----------
    times, forces : array_like
        Time in contact [s] and pull-off force [N] of each test, positive.
    radius : float
        Radius of the sphere [m].
    uncertainty : float
        Relative standard uncertainty of a force; the scatter around the law if that is larger.
    level : float
        Confidence level of the intervals.

    Raises
    ------
    ValueError
        If there are fewer than four tests or three dwells, or all dwells lie within a factor of 5.

    Examples
    --------
    >>> t = np.array([1.0, 3.0, 10.0, 30.0, 100.0, 300.0])
    >>> noise = 1 + 0.002 * np.cos(np.arange(6) ** 2)
    >>> fit = identify_dwell(t, 1e-3 * (1 + 0.1 * np.log1p(t / 0.01)) * noise, radius=5e-3)
    >>> f"{fit.law}: {fit.growth_per_decade:.1%} in a decade"
    'logarithmic-ageing: 13.1% in a decade'
    """
    t, F = _checked(times, forces, radius, level)
    middle = float(np.exp(np.log(t).mean()))
    # the line in ln t is what all data determine
    line, miss = _fitted(np.log(t / middle), F)
    left = t.size - 2
    noise = max(float(np.sqrt(miss / left)), uncertainty, _LEAST)
    slope = float(line[1] / line[0])
    error = noise / float(np.sqrt(np.sum(np.log(t / middle) ** 2)))
    wide = float(scipy.stats.t.ppf((1 + level) / 2, left)) * error
    decade = float(np.log(10))
    interval = decade * (slope - wide), decade * (slope + wide)
    work = float(line[0]) / (1.5 * np.pi * radius)
    chance = 2 * float(scipy.stats.t.sf(abs(slope) / error, left))
    words = [
        f"work of adhesion {readable(work, 'J/m2', digits=4)} after {readable(middle, 's')} in "
        f"contact (JKR); it grows by {decade * slope:.1%} in a decade of time "
        f"({interval[0]:.1%} to {interval[1]:.1%}, {level:.0%})"
    ]
    if chance > _CHANCE or slope <= 0:
        words.append(
            "no growth with contact time is found beyond the scatter of the tests"
            if chance > _CHANCE
            else "the force falls with the dwell, which no law of ageing describes; was the solid "
            "relaxed?"
        )
        law, ends, constants = None, (0.0, inf), {}
    else:
        law, ends, constants, more = _law(t, F, max(uncertainty, _LEAST), radius, level)
        words += more
    return DwellFit(
        tuple(t.tolist()),
        tuple(F.tolist()),
        law,
        work,
        decade * slope,
        interval,
        ends,
        constants,
        noise,
        level,
        tuple(words),
        radius,
    )


def check_relaxed(material: Material, times: Array) -> None:
    """Raise an InputError where the modulus still relaxes between the shortest and longest dwell.

    Parameters
    ----------
    material : Material
        The solid, in SI.
    times : ndarray
        Times in contact [s].
    """
    first, last = (float(material.relaxation(x)) for x in (times.min(), times.max()))
    if first / last - 1 > _LEFT:
        raise InputError(
            f"the modulus relaxes by {first / last - 1:.0%} between contact times of "
            f"{readable(float(times.min()), 's', digits=2)} and "
            f"{readable(float(times.max()), 's', digits=2)}, which changes the force like a "
            "growing interface does; leave out the short dwells"
        )


def check_dwells(cycles: Sequence[Cycle]) -> None:
    """Raise an InputError where the force at one speed grows with the dwell.

    A rate series averages the tests of a speed; tests after different dwells are repeats only if
    the dwell does not matter.
    """
    for same in same_speeds(cycles):
        t = np.array([_in_contact(one) for one in same])
        if t.size < _FEWEST or t.min() <= 0 or t.max() < _APART * t.min():
            continue
        F = np.array([one.pull_off_force.value for one in same])
        found: Any = scipy.stats.linregress(np.log(t), F / F.mean())
        if found.pvalue < _CERTAIN:
            raise InputError(
                f"the pull-off force at {readable(same[0].speed.value, 'm/s', digits=3)} changes "
                f"by {np.log(10) * found.slope:.1%} in a decade of contact time "
                f"({readable(float(t.min()), 's', digits=2)} to "
                f"{readable(float(t.max()), 's', digits=2)}), so these tests are no repeats: give "
                "files of one dwell, or the dwells of one speed to `viscotack identify dwell`"
            )


def _in_contact(cycle: Cycle) -> float:
    """Return the time from the start of the dwell to the pull-off [s]."""
    return float(cycle.time[cycle.pull_off_at] - cycle.time[cycle.segments.dwell])


def _checked(
    times: Sequence[float] | Array, forces: Sequence[float] | Array, radius: float, level: float
) -> tuple[Array, Array]:
    """Return times and forces by time."""
    t, F = np.array(times, dtype=float), np.array(forces, dtype=float)
    if t.shape != F.shape or t.ndim != 1:
        raise InputError(f"times and forces must be lists of one length, got {t.shape}, {F.shape}")
    if not (np.all(np.isfinite(t) & np.isfinite(F)) and np.all(t > 0) and np.all(F > 0)):
        raise InputError("times and pull-off forces must be positive and finite")
    if not 0 < radius < inf or not 0 < level < 1:
        raise InputError(f"radius must be positive and level in (0, 1), got {radius} and {level}")
    order = np.argsort(t, kind="stable")
    t, F = t[order], F[order]
    dwells = 1 + int(np.count_nonzero(np.diff(np.log(t)) > np.log(1.1)))
    if t.size < _FEWEST or dwells < _DWELLS or t[-1] < _RANGE * t[0]:
        raise InputError(
            f"{t.size} tests after {dwells} dwells, {readable(float(t[0]), 's', digits=2)} to "
            f"{readable(float(t[-1]), 's', digits=2)}: a growth with contact time needs "
            f"{_FEWEST} tests after {_DWELLS} dwells over a factor of {_RANGE:g}"
        )
    return t, F


def _fitted(x: Array, F: Array) -> tuple[Array, float]:
    """Return the coefficients of a + b x with least relative misfit, and the sum of its squares."""
    rows = np.column_stack([np.ones_like(x), x]) / F[:, None]
    found: Any = np.linalg.lstsq(rows, np.ones_like(F), rcond=None)[0]
    return found, float(np.sum((rows @ found - 1) ** 2))


def _law(
    t: Array, F: Array, uncertainty: float, radius: float, level: float
) -> tuple[str | None, tuple[float, float], dict[str, float], list[str]]:
    """Return the likelier law, the interval of its time, its constants and sentences."""
    decades = np.log10(t[0]) - _BEYOND, np.log10(t[-1]) + _BEYOND
    t0 = np.logspace(*decades, int(_PER_DECADE * (decades[1] - decades[0])))
    shapes = {_LOGARITHMIC: lambda u: np.log1p(u), _SATURATING: lambda u: -np.expm1(-u)}
    fits = {word: [_fitted(shape(t / x), F) for x in t0] for word, shape in shapes.items()}
    # only laws that grow from a positive work
    misfits = {
        word: np.array([miss if a[0] > 0 and a[1] > 0 else inf for a, miss in rows])
        for word, rows in fits.items()
    }
    least = min(float(each.min()) for each in misfits.values())
    variance = max(least / max(t.size - 3, 1), uncertainty**2)
    misfits = {word: each / variance for word, each in misfits.items()}
    best = {word: float(each.min()) for word, each in misfits.items()}
    word = min(best, key=lambda each: best[each])
    other = next(each for each in best if each != word)
    limit = float(scipy.stats.t.ppf((1 + level) / 2, max(t.size - 3, 1))) ** 2
    near = np.flatnonzero(misfits[word] - best[word] <= limit)
    # the ends lie between these points and the next ones
    low = 0.0 if near[0] == 0 else float(t0[near[0] - 1])
    high = inf if near[-1] == t0.size - 1 else float(t0[near[-1] + 1])
    at = int(np.argmin(misfits[word]))
    if word == _LOGARITHMIC and low == 0.0:
        # any small t0 describes these times; one that is a tenth of the first is reported
        at = int(np.argmin(np.abs(np.log(t0 * _ABOVE / t[0]))))
    a, _ = fits[word][at]
    constants = {
        "work_of_adhesion": float(a[0]) / (1.5 * np.pi * radius),
        "reference_time": float(t0[at]),
        {_LOGARITHMIC: "sensitivity", _SATURATING: "largest_growth"}[word]: float(a[1] / a[0]),
    }
    words = []
    if best[other] - best[word] < _DIFFERENT:
        words.append(
            "logarithmic and saturating growth describe these times alike; longer or shorter "
            "dwells would distinguish them"
        )
        return None, (0.0, inf), {}, words
    if low == 0.0:
        words.append(
            f"{word}: the reference time is below {readable(high, 's', digits=2)} and not "
            "determined, nor are work and sensitivity of a new contact; the stated constants "
            f"describe times above {readable(float(t[0]), 's', digits=2)}"
        )
    else:
        words.append(
            f"{word} with a reference time of {readable(constants['reference_time'], 's')} "
            f"({readable(low, 's', digits=2)} to "
            f"{'any time' if high == inf else readable(high, 's', digits=2)})"
        )
    return word, (low, high), constants, words
