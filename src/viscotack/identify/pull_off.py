"""Pull-offs of a rate series: forces at true speeds, from the cycles of tack tests."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.lab.tack import Cycle, Measured

from .travel import travels

_SAME = 0.03  # relative difference below which speeds are equal


@dataclass(frozen=True)
class PullOff:
    """One pull-off, or the mean of several at one speed.

    Parameters
    ----------
    speed : float
        True retraction speed [m/s].
    force : Measured
        Pull-off force, positive [N].
    preload : float, optional
        Force under which the contact relaxed [N].
    travels : tuple of Measured, optional
        Travels along the curve [m], from :func:`.travel.travels`.
    """

    speed: float
    force: Measured
    preload: float | None = None
    travels: tuple[Measured, ...] | None = None


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off per speed; repeated cycles are averaged.

    Speeds within 3 % are equal. The uncertainty of a mean includes the scatter of its cycles. The
    preload is the force at the start of the retractions, or None if one begins in tension.
    """
    found: list[PullOff] = []
    rest = sorted(cycles, key=lambda cycle: cycle.speed.value)
    while rest:
        first = rest[0].speed.value
        same = [cycle for cycle in rest if cycle.speed.value <= (1 + _SAME) * first]
        rest = rest[len(same) :]
        forces = np.array([cycle.pull_off_force.value for cycle in same])
        own = float(np.mean([cycle.pull_off_force.uncertainty for cycle in same]))
        spread = float(np.std(forces, ddof=1) / np.sqrt(forces.size)) if forces.size > 1 else 0.0
        speed = float(np.mean([cycle.speed.value for cycle in same]))
        begins = [float(cycle.force[cycle.segments.retract]) for cycle in same]
        force = Measured(float(forces.mean()), float(np.hypot(own, spread)))
        preload = float(np.mean(begins)) if min(begins) > 0 else None
        found.append(PullOff(speed, force, preload, _mean([travels(cycle) for cycle in same])))
    return found


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
