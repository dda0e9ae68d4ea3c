"""Pull-offs of a rate series: forces at true speeds and travels, from the cycles of tack tests.

Travels between forces of a retraction are measured from its start to zero force, and from there to
fractions of the largest tension. They need no zero of depth and no force other than the pull-off;
machine compliance is subtracted. Where an edge accelerates during one test, they contain its rate
dependence.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack import Cycle, Measured
from viscotack.lab.tack.repeats import Repeats, pooled, same_speeds, temperature_of
from viscotack.model.protocol import Approach, AtForce, Dwell, Move
from viscotack.units import readable

from .contact_time import contact_time, of_one_time, same_times

# Fractions of the largest tension at which the travel is read, in addition to zero.
PARTS = (0.3, 0.6, 0.85)
# window relative to the pull-off around such a force, and smallest number of points in it
_WINDOW, _FEWEST = 0.06, 6


def travels(cycle: Cycle) -> tuple[Measured, ...] | None:
    """Return the travels of a cycle [m]: the first to zero force, the others from there.

    None if the retraction begins in tension, or has too few points.
    """
    back = slice(cycle.segments.retract, cycle.pull_off_at + 1)
    force, depth = cycle.force[back], cycle.depth[back]
    size = cycle.pull_off_force.value
    if force.size == 0 or force[0] <= 3 * cycle.noise:
        return None
    places = []
    for part in (0.0, *PARTS):
        near = np.abs(force + part * size) < _WINDOW * size
        if np.count_nonzero(near) < _FEWEST or np.ptp(force[near]) == 0:
            return None
        # a parabola, because fast retractions are curved
        _, slope, level = np.polyfit(force[near] + part * size, depth[near], 2)
        noise = abs(slope) * cycle.noise / np.sqrt(np.count_nonzero(near))
        # the uncertainty of the pull-off moves the level of the tension
        noise = float(np.hypot(noise, abs(slope) * part * cycle.pull_off_force.uncertainty))
        places.append((float(level), noise))
    (zero, doubt), start = places[0], float(depth[0])
    found = [Measured(start - zero, doubt)]
    found += [Measured(zero - level, float(np.hypot(doubt, noise))) for level, noise in places[1:]]
    return None if any(one.value <= 0 for one in found) else tuple(found)


def travels_of(travel: Array, force: Array, tension: Array) -> Array:
    """Return the travels of computed curves.

    Parameters
    ----------
    travel, force : ndarray, shape (points, cases)
        Travel, ascending, and force, compression positive.
    tension : ndarray, shape (cases,)
        Largest tension.

    Returns
    -------
    ndarray, shape (cases, 1 + parts)
        nan where a curve does not begin in compression.
    """
    cases = np.arange(tension.size)
    places = []
    for part in (0.0, *PARTS):
        level = -part * tension
        at = np.argmax(force <= level, axis=0)
        before = np.maximum(at - 1, 0)
        f0, f1 = force[before, cases], force[at, cases]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(at > 0, (f0 - level) / (f0 - f1), np.nan)
        places.append(travel[before, cases] * (1 - share) + travel[at, cases] * share)
    zero = places[0]
    return np.stack([zero, *(place - zero for place in places[1:])], axis=1)


_HELD = 0.95  # of the peak: a smaller force at the start of the retraction was not held


@dataclass(frozen=True)
class History:
    """Loading of a test before its retraction.

    Parameters
    ----------
    approach_speed : float
        Speed of the approach [m/s].
    peak : float
        Largest force, at its end [N].
    dwell : float
        Time from there to the retraction [s].
    """

    approach_speed: float
    peak: float
    dwell: float

    def moves(self, preload: float) -> tuple[Move, ...]:
        """Return the moves to the force at which the retraction begins [N].

        A force well below the peak has relaxed at a held drive; otherwise the force was held.
        """
        approach = Approach(self.approach_speed, to=AtForce(self.peak))
        hold = "drive" if preload < _HELD * self.peak else "force"
        return (approach, Dwell(self.dwell, hold=hold)) if self.dwell > 0 else (approach,)


@dataclass(frozen=True)
class Trial:
    """A test: a sphere that is pulled off at a speed.

    Parameters
    ----------
    speed : float
        Retraction speed [m/s].
    preload : float or None
        Force under which the contact rests [N]; by default the mean preload of the series.
    radius : float or None
        Radius of the sphere [m]; by default that of the series.
    dwell, approach_speed : float or None
        Time under the preload [s] after an approach at this speed [m/s]; by default the contact
        relaxes fully.

    Examples
    --------
    >>> Trial(1e-4, preload=2e-3).dwell is None
    True
    """

    speed: float
    preload: float | None = None
    radius: float | None = None
    dwell: float | None = None
    approach_speed: float | None = None

    def __post_init__(self) -> None:
        for name in ("speed", "preload", "radius", "approach_speed"):
            value = getattr(self, name)
            if value is not None and not 0 < value < np.inf:
                raise InputError(f"the {name} must be positive, got {value!r}", field=name)
        if (self.dwell is None) != (self.approach_speed is None):
            lost = "dwell" if self.dwell is None else "approach_speed"
            words = "a dwell needs the speed of the approach, and the other way round"
            raise InputError(words, field=lost)
        if self.dwell is not None and not self.dwell >= 0:
            raise InputError(f"a dwell must not be negative, got {self.dwell!r} s", field="dwell")

    @property
    def words(self) -> str:
        """The test in words."""
        return ", ".join(filter(None, (readable(self.speed, "m/s", digits=3), self.conditions)))

    @property
    def conditions(self) -> str:
        """Preload, radius and dwell in words."""
        rows = ("under", self.preload, "N"), ("R =", self.radius, "m"), ("dwell", self.dwell, "s")
        known = ((word, x, unit) for word, x, unit in rows if x is not None)
        return ", ".join(f"{word} {readable(x, unit, digits=3)}" for word, x, unit in known)

    def moves(self) -> tuple[Move, ...]:
        """Return the moves before the retraction; empty for a contact that relaxes."""
        if self.preload is None or self.dwell is None or self.approach_speed is None:
            return ()
        return History(self.approach_speed, self.preload, self.dwell).moves(self.preload)


@dataclass(frozen=True)
class PullOff:
    """One pull-off, or the mean of several at one temperature, speed and time in contact.

    Parameters
    ----------
    speed : float
        True retraction speed [m/s], times `shift`.
    force : Measured
        Pull-off force, positive [N].
    preload : float, optional
        Force under which the contact relaxed [N].
    travels : tuple of Measured, optional
        Travels along the curve [m], from :func:`travels`.
    remarks : tuple of str
        Sentences on the tests at this speed.
    history : History, optional
        Approach and dwell, at the speed and time of `speed`.
    temperature : float, optional
        Temperature of the tests [K].
    shift : float
        a_T, by which the speed is multiplied (:func:`.rate_series.shifted`).
    between_tests : float
        Relative standard uncertainty of the force of a single test beyond its own, from repeats; 0
        without repeats.
    contact_time : float, optional
        Time from the start of the dwell to the pull-off [s].
    """

    speed: float
    force: Measured
    preload: float | None = None
    travels: tuple[Measured, ...] | None = None
    remarks: tuple[str, ...] = ()
    history: History | None = None
    temperature: float | None = None
    shift: float = 1.0
    between_tests: float = 0.0
    contact_time: float | None = None

    @property
    def true_speed(self) -> float:
        """True retraction speed [m/s]."""
        return self.speed / self.shift

    @property
    def at(self) -> str:
        """Speed, shifted, in words."""
        return readable(self.speed, "m/s", digits=3)

    @property
    def conditions(self) -> str:
        """Temperature, if known, and true speed in words."""
        at = readable(self.true_speed, "m/s", digits=3)
        return at if self.temperature is None else f"{self.temperature - 273.15:.3g} C, {at}"


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off per temperature, speed and time in contact; repeats are averaged.

    Temperatures and speeds are equal as in :func:`~viscotack.lab.tack.repeats.same_speeds`, times
    as in :func:`.same_times`. The uncertainty of a mean includes the scatter of repeated cycles,
    which is pooled over all of them; that at one speed is about a power law of the time. The
    preload is the force at the start of the retractions, or None if one begins in tension.
    """
    groups = [same_times(same) for same in same_speeds(cycles)]
    tests = [[one for same in times for one in same] for times in groups]
    several = [len(times) > 1 for times in groups]
    forces = [
        of_one_time(same) if more else _forces(same)
        for same, more in zip(tests, several, strict=True)
    ]
    repeats = pooled(forces).less(sum(several))
    found = []
    for times, same, mean, far in zip(groups, tests, repeats.means, repeats.far, strict=True):
        speed = _mean([cycle.speed.value for cycle in same])
        at = readable(speed, "m/s", digits=3)
        remarks = tuple(
            f"one of {len(same)} tests at {at} is far from the others there and counts little: "
            f"{readable(same[i].pull_off_force.value, 'N', digits=3)}, their mean is "
            f"{readable(mean, 'N', digits=3)} (scatter of single tests {repeats.scatter:.1%})"
            for i in far
        )
        means = pooled([_forces(each) for each in times]).means if len(times) > 1 else [mean]
        for each, middle in zip(times, means, strict=True):
            found.append(_mean_of(each, speed, middle, repeats, remarks))
            remarks = ()
    return found


def _mean_of(
    same: Sequence[Cycle], speed: float, mean: float, repeats: Repeats, remarks: tuple[str, ...]
) -> PullOff:
    """Return the mean of tests at one speed, with what all of them have."""
    own = _mean([cycle.pull_off_force.uncertainty for cycle in same])
    begins = [float(cycle.force[cycle.segments.retract]) for cycle in same]
    times = [time for cycle in same if (time := contact_time(cycle)) is not None]
    curves = [row for cycle in same if (row := travels(cycle)) is not None]
    approaches = [cycle.approach_speed for cycle in same if cycle.approach_speed]
    peak, history = _mean([cycle.preload.value for cycle in same]), None
    if len(approaches) == len(same) and peak > 0:
        history = History(_mean(approaches), peak, _mean([cycle.dwell_time for cycle in same]))
    return PullOff(
        speed,
        Measured(mean, float(np.hypot(own, mean * repeats.uncertainty(len(same))))),
        preload=_mean(begins) if min(begins) > 0 else None,
        travels=tuple(
            Measured(_mean([x.value for x in column]), _mean([x.uncertainty for x in column]))
            for column in zip(*curves, strict=True)
        )
        if len(curves) == len(same)
        else None,
        remarks=remarks,
        history=history,
        temperature=temperature_of(same),
        between_tests=repeats.uncertainty(1),
        contact_time=float(np.exp(_mean(np.log(times)))) if len(times) == len(same) else None,
    )


def _forces(cycles: Sequence[Cycle]) -> list[float]:
    return [one.pull_off_force.value for one in cycles]


def _mean(values: Sequence[float] | Array) -> float:
    return float(np.mean(values))
