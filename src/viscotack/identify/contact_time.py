r"""Growth of the work of adhesion with contact time, from tests after several dwells.

The pull-off force of an elastic sphere with forces of short range is :math:`1.5 \pi R w` (JKR), so
the force after a time t in contact is that of a new one times :math:`1 + G(t)`. Two laws of
:mod:`viscotack.model.traction.growing` are fitted by least squares to the logarithms of the forces:
:math:`G = s \ln(1 + t/t_0)` and :math:`G = g (1 - e^{-t/t_0})`. Each has a profile likelihood over
t0. A logarithmic growth observed at times far above t0 alone does not determine t0: the data then
have the work after one time and its growth in a decade.

The edge of the contact touches later than its middle: forces simulated with a logarithmic interface
grow by 6 % less in a decade than their interface does (`tests/test_identify_dwell.py`).

The time in contact is that from the start of the dwell to the pull-off. Bulk relaxation in the
dwell changes the force too; :func:`check_relaxed` refuses solids for which it may.

In tests at several speeds the growth is one more unknown of the rate series (:mod:`.search`): the
work of adhesion of a test is :math:`w (1 + g \log_{10}(t/t_m))`, with the geometric mean
:math:`t_m` of the times. It is fitted where times differ at one speed. Where each speed has its own
time, the effects of both are one, and tests of that design determine no growth.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack import Cycle
from viscotack.lab.tack.repeats import same_speeds
from viscotack.model.materials import Material
from viscotack.model.traction import LogarithmicAgeing, SaturatingAgeing
from viscotack.units import readable

# Fewest tests and dwells, and smallest ratio of the longest to the shortest time.
_FEWEST, _DWELLS, _RANGE = 4, 3, 5.0
# Reference times over the observed ones: decades beyond them, and number in each decade.
_BEYOND, _PER_DECADE = 2, 20
# Probability below which a growth is not chance.
_CHANCE = 0.01
# Ratio of times from which tests at one speed are no repeats, that up to which times are equal, and
# change of the modulus between the dwells that may be neglected.
APART, _SAME, _LEFT = 2.0, 1.25, 0.02
# Dwell times of an undetermined law begin at this multiple of its reference time.
_ABOVE = 10.0
# The unknown of a series of several speeds, and its correlation with another unknown from which the
# data hardly separate them.
PER_DECADE, _TOGETHER = "growth_per_decade", 0.9
# Laws, the names of their amplitudes, and their growth by t/t0.
_SHAPES: dict[Any, tuple[str, Callable[[Array], Array]]] = {
    LogarithmicAgeing: ("sensitivity", np.log1p),
    SaturatingAgeing: ("largest_growth", lambda u: -np.expm1(-u)),
}
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
    radius : float
        Radius of the sphere [m].
    work_of_adhesion : float
        Work after the geometric mean of the times [J/m^2], by JKR.
    growth_per_decade : float
        Increase of the work in a decade over the work at the geometric mean time.
    interval : (float, float)
        Interval of this increase at `level`.
    chance : float
        Probability of such a growth, or fall, by chance.
    scatter : float
        Relative standard deviation of the forces around the line in the logarithm of the time.
    level : float
        Confidence level.
    kind : type or None
        :class:`.LogarithmicAgeing` or :class:`.SaturatingAgeing`; None without growth or where both
        fit.
    parameters : dict of str to float
        Constants of the law: "work_of_adhesion", "reference_time" and "sensitivity" or
        "largest_growth"; empty without a law.
    reference_time : (float, float)
        Interval of t0 of the law [s]; 0 or inf where the data do not limit it.
    both : bool
        Whether the data do not distinguish the laws.
    """

    times: tuple[float, ...]
    forces: tuple[float, ...]
    radius: float
    work_of_adhesion: float
    growth_per_decade: float
    interval: tuple[float, float]
    chance: float
    scatter: float
    level: float
    kind: Any
    parameters: dict[str, float]
    reference_time: tuple[float, float]
    both: bool

    @property
    def law(self) -> str | None:
        """Word of the law; None without growth or where both fit."""
        return None if self.kind is None else self.kind.word

    def line(self, time: Array) -> Array:
        """Return the pull-off forces [N] that are straight in the logarithm of the time [s]."""
        growth = self.growth_per_decade * np.log10(time / np.exp(np.log(self.times).mean()))
        return 1.5 * np.pi * self.radius * self.work_of_adhesion * (1 + growth)

    def force(self, time: Array) -> Array:
        """Return the pull-off forces [N] of the law after times in contact [s]."""
        law = self.kind(equilibrium_gap=1.0, **self.parameters)
        work = law.work_of_adhesion * (1 + law.growth_after(time))
        return 1.5 * np.pi * self.radius * work

    @property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result."""
        middle = readable(float(np.exp(np.log(self.times).mean())), "s")
        low, high = self.interval
        said = (
            f"work of adhesion {readable(self.work_of_adhesion, 'J/m2')} after {middle} in contact "
            f"(JKR); it grows by {self.growth_per_decade:.1%} in a decade of time ({low:.1%} to "
            f"{high:.1%}, {self.level:.0%})"
        )
        low, high = self.reference_time
        until = "any time" if high == inf else readable(high, "s", digits=2)
        if self.chance > _CHANCE:
            law = "no growth with contact time is found beyond the scatter of the tests"
        elif self.both:
            law = "logarithmic and saturating growth fit alike; more dwells would tell them apart"
        elif self.kind is None:
            law = "the force falls with the dwell, which no law describes; was the solid relaxed?"
        elif low == 0.0:
            law = (
                f"{self.law}: the reference time is below {until} and not determined, nor are work "
                "and sensitivity of a new contact; the constants describe times above "
                f"{readable(self.times[0], 's', digits=2)}"
            )
        else:
            time = readable(self.parameters["reference_time"], "s")
            between = f"{readable(low, 's', digits=2)} to {until}"
            law = f"{self.law} with a reference time of {time} ({between})"
        return said, law


@dataclass(frozen=True)
class FoundAgeing:
    """Growth with contact time that was fitted to a rate series.

    Attributes
    ----------
    better_by : float
        Reduction of the misfit compared with the best interface without this growth.
    correlation : dict of str to float
        Correlation of the growth with each other unknown.
    """

    better_by: float
    correlation: dict[str, float]

    @property
    def chance(self) -> float:
        """Probability of such a reduction of the misfit for an interface without this growth."""
        return float(scipy.stats.chi2.sf(self.better_by, 1))

    @property
    def together(self) -> tuple[str, ...]:
        """Unknowns of the speed from which the data hardly separate the growth."""
        rows = self.correlation.items()
        return tuple(n for n, x in rows if abs(x) > _TOGETHER and n != "work_of_adhesion")


def tests_by_dwell(cycles: Sequence[Cycle]) -> tuple[Array, Array, float]:
    """Return times in contact [s] and forces [N] of tests at one speed, and their uncertainty.

    Raises
    ------
    ValueError
        If the tests have several speeds, or one has no approach.
    """
    speeds = same_speeds(cycles)
    if len(speeds) > 1:
        listed = ", ".join(readable(same[0].speed.value, "m/s", digits=3) for same in speeds)
        raise InputError(
            f"tests at {listed}: the force grows with speed and with dwell; give the files of one "
            "speed, or all to `viscotack identify rates` or `viscotack identify edge`"
        )
    known = [time for one in cycles if (time := contact_time(one)) is not None]
    if len(known) < len(cycles):
        raise InputError(
            f"{len(cycles) - len(known)} of {len(cycles)} tests have no approach, so that their "
            "time in contact is unknown; give files with approach and dwell"
        )
    times = np.array(known)
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
        ends = readable(float(t[0]), "s", digits=2, to=float(t[-1]))
        raise InputError(
            f"{t.size} tests after {dwells} dwells, {ends}: a growth with contact time needs "
            f"{_FEWEST} tests after {_DWELLS} dwells over a factor of {_RANGE:g}"
        )
    middle = float(np.exp(np.log(t).mean()))
    # the line in ln t is what all data determine
    line, miss = _fitted(np.log(t / middle), F)
    left = t.size - 2
    noise = max(float(np.sqrt(miss / left)), uncertainty, _LEAST)
    slope = float(line[1] / line[0])
    error = noise / float(np.sqrt(np.sum(np.log(t / middle) ** 2)))
    wide = float(scipy.stats.t.ppf((1 + level) / 2, left)) * error
    decade = float(np.log(10))
    chance = 2 * float(scipy.stats.t.sf(abs(slope) / error, left))
    grows = chance <= _CHANCE and slope > 0
    laws = _laws(t, F, max(uncertainty, _LEAST), radius, level) if grows else []
    kind, constants, ends = laws[0] if len(laws) == 1 else (None, {}, (0.0, inf))
    return DwellFit(
        times=tuple(t.tolist()),
        forces=tuple(F.tolist()),
        radius=radius,
        work_of_adhesion=float(line[0]) / (1.5 * np.pi * radius),
        growth_per_decade=decade * slope,
        interval=(decade * (slope - wide), decade * (slope + wide)),
        chance=chance,
        scatter=noise,
        level=level,
        kind=kind,
        parameters=constants,
        reference_time=ends,
        both=len(laws) > 1,
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
        ends = readable(float(times.min()), "s", digits=2, to=float(times.max()))
        raise InputError(
            f"the modulus relaxes by {first / last - 1:.0%} between contact times of {ends}, which "
            "changes the force like a growing interface; leave out short dwells, or set history"
        )


def contact_time(cycle: Cycle) -> float | None:
    """Return the time from the start of the dwell to the pull-off [s]; None without an approach."""
    begin, dwell = cycle.segments.begin, cycle.segments.dwell
    time = float(cycle.time[cycle.pull_off_at] - cycle.time[dwell])
    return time if begin < dwell and time > 0 else None


def same_times(cycles: Sequence[Cycle]) -> list[list[Cycle]]:
    """Return tests of one speed by their time in contact, the shortest first.

    Times within a factor of 1.25 are equal, and all are unless they differ by a factor of 2.
    """
    times = np.array([contact_time(one) or 0.0 for one in cycles])
    if times.min() <= 0 or times.max() < APART * times.min():
        return [list(cycles)]
    groups: list[list[int]] = []
    for i in np.argsort(times, kind="stable").tolist():
        if not groups or times[i] > _SAME * times[groups[-1][0]]:
            groups.append([])
        groups[-1].append(i)
    return [[cycles[i] for i in same] for same in groups]


def of_one_time(cycles: Sequence[Cycle]) -> Array:
    """Return forces [N] of tests of one speed, without their power law of the time in contact."""
    forces = np.log([one.pull_off_force.value for one in cycles])
    times = np.log([contact_time(one) or 1.0 for one in cycles])
    slope = np.polyfit(times, forces, 1)[0]
    return np.exp(forces - slope * (times - times.mean()))


def _fitted(x: Array, F: Array) -> tuple[Array, float]:
    """Return the coefficients of a + b x with least relative misfit, and the sum of its squares."""
    rows = np.column_stack([np.ones_like(x), x]) / F[:, None]
    found: Any = np.linalg.lstsq(rows, np.ones_like(F), rcond=None)[0]
    return found, float(np.sum((rows @ found - 1) ** 2))


def _laws(
    t: Array, F: Array, uncertainty: float, radius: float, level: float
) -> list[tuple[Any, dict[str, float], tuple[float, float]]]:
    """Return kind, constants and interval of t0 of the laws that the data do not distinguish."""
    decades = np.log10(t[0]) - _BEYOND, np.log10(t[-1]) + _BEYOND
    t0 = np.logspace(*decades, int(_PER_DECADE * (decades[1] - decades[0])))
    fits = {kind: [_fitted(shape(t / x), F) for x in t0] for kind, (_, shape) in _SHAPES.items()}
    # only laws that grow from a positive work
    misfits = {
        kind: np.array([miss if min(a) > 0 else inf for a, miss in rows])
        for kind, rows in fits.items()
    }
    least = min(float(each.min()) for each in misfits.values())
    freedom = max(t.size - 3, 1)
    variance = max(least / freedom, uncertainty**2)
    limit = float(scipy.stats.t.ppf((1 + level) / 2, freedom)) ** 2
    found = []
    for kind in _SHAPES:
        misfit = misfits[kind] / variance
        if misfit.min() - least / variance >= _DIFFERENT:
            continue
        near = np.flatnonzero(misfit - misfit.min() <= limit)
        # the ends lie between these points and the next ones
        low = 0.0 if near[0] == 0 else float(t0[near[0] - 1])
        high = inf if near[-1] == t0.size - 1 else float(t0[near[-1] + 1])
        at = int(np.argmin(misfit))
        if kind is LogarithmicAgeing and low == 0.0:
            # any small t0 describes these times; one that is a tenth of the first is reported
            at = int(np.argmin(np.abs(np.log(t0 * _ABOVE / t[0]))))
        a, _ = fits[kind][at]
        constants = {
            "work_of_adhesion": float(a[0]) / (1.5 * np.pi * radius),
            "reference_time": float(t0[at]),
            _SHAPES[kind][0]: float(a[1] / a[0]),
        }
        found.append((kind, constants, (low, high)))
    return found
