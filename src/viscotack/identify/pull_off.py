"""Pull-offs of a rate series: forces at true speeds, from the cycles of tack tests."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.lab.tack import Cycle, Measured
from viscotack.lab.tack.repeats import Repeats, pooled, same_speeds, temperature_of
from viscotack.model.protocol import Approach, AtForce, Dwell, Move
from viscotack.units import readable

from .travel import travels

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
class PullOff:
    """One pull-off, or the mean of several at one temperature and speed.

    Parameters
    ----------
    speed : float
        True retraction speed [m/s], times `shift`.
    force : Measured
        Pull-off force, positive [N].
    preload : float, optional
        Force under which the contact relaxed [N].
    travels : tuple of Measured, optional
        Travels along the curve [m], from :func:`.travel.travels`.
    remarks : tuple of str
        Sentences on the tests at this speed.
    history : History, optional
        Approach and dwell, at the speed and time of `speed`.
    temperature : float, optional
        Temperature of the tests [K].
    shift : float
        a_T, by which the speed is multiplied (:func:`.temperatures.shifted`).
    between_tests : float
        Relative standard uncertainty of the force of a single test beyond its own, from repeats; 0
        without repeats.
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

    @property
    def true_speed(self) -> float:
        """True retraction speed [m/s]."""
        return self.speed / self.shift

    @property
    def at(self) -> str:
        """Speed, shifted, in words."""
        return readable(self.speed, "m/s", digits=3)

    def conditions(self, digits: int = 4) -> str:
        """Return temperature, if known, and true speed in words."""
        at = readable(self.true_speed, "m/s", digits=digits)
        return at if self.temperature is None else f"{self.temperature - 273.15:.3g} C, {at}"


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off per temperature and speed; repeated cycles are averaged.

    These are equal as in :func:`~viscotack.lab.tack.repeats.same_speeds`. The uncertainty of a mean
    includes the scatter of repeated cycles, which is pooled over all of them. The preload is the
    force at the start of the retractions, or None if one begins in tension.
    """
    groups = same_speeds(cycles)
    repeats = pooled([[one.pull_off_force.value for one in same] for same in groups])
    rows = zip(groups, repeats.means, repeats.far, strict=True)
    return [_of_one_speed(same, mean, repeats, far) for same, mean, far in rows]


def _of_one_speed(
    same: Sequence[Cycle], mean: float, repeats: Repeats, far: Sequence[int]
) -> PullOff:
    speed = float(np.mean([cycle.speed.value for cycle in same]))
    own = float(np.mean([cycle.pull_off_force.uncertainty for cycle in same]))
    spread = mean * repeats.uncertainty(len(same))
    begins = [float(cycle.force[cycle.segments.retract]) for cycle in same]
    at = readable(speed, "m/s", digits=3)
    remarks = tuple(
        f"one of {len(same)} tests at {at} is far from the others there and counts little: "
        f"{readable(same[i].pull_off_force.value, 'N', digits=3)}, their mean is "
        f"{readable(mean, 'N', digits=3)} (scatter of single tests {repeats.scatter:.1%})"
        for i in far
    )
    return PullOff(
        speed,
        Measured(mean, float(np.hypot(own, spread))),
        float(np.mean(begins)) if min(begins) > 0 else None,
        _mean([travels(cycle) for cycle in same]),
        remarks,
        _history(same),
        temperature_of(same),
        between_tests=repeats.uncertainty(1),
    )


def _history(same: Sequence[Cycle]) -> History | None:
    """Return the mean history; None if the speed of an approach is not known."""
    speeds = [one.approach_speed for one in same if one.approach_speed]
    if len(speeds) < len(same):
        return None
    peak = float(np.mean([one.preload.value for one in same]))
    dwell = float(np.mean([one.dwell_time for one in same]))
    return History(float(np.mean(speeds)), peak, dwell) if peak > 0 else None


def _mean(rows: Sequence[tuple[Measured, ...] | None]) -> tuple[Measured, ...] | None:
    """Return the mean travels; None if a curve has none."""
    told = [row for row in rows if row is not None]
    if len(told) < len(rows):
        return None
    columns = list(zip(*told, strict=True))
    return tuple(
        Measured(
            float(np.mean([one.value for one in column])),
            float(np.mean([one.uncertainty for one in column])),
        )
        for column in columns
    )
