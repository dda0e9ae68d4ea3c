r"""Holding with an array: payload, time under a dead load, and release.

A mass m that is lifted with the acceleration a needs the force :math:`S m (g + a)` with the safety
factor S. Under that force at rest viscoelastic pads creep off if it exceeds their elastic pull-off
force. The time is that of one pad under its share, that of the pad that carries most at the
pull-off: the force over the number of pads and over the load sharing factor.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import inf, nan
from typing import Annotated

import numpy as np

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError, OutOfRange
from viscotack.model.materials import Elastic
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import Apart, Approach, AtForce, Dwell, LoadTo, Retraction
from viscotack.model.traction import at_rest, grows
from viscotack.result import Outcome
from viscotack.simulate import solve
from viscotack.simulate.crack_contact.by_crack import crack_contact

from .pulling import ArrayPull, PadArray, pull_array, shared_compliance

GRAVITY = 9.80665
# Longest time of a dead load [s]: one day.
LONGEST = 86_400.0
# Distance of a start before contact, in ranges of the forces: fixed, and for each Tabor number.
_APART, _BY_TABOR = 10.0, 3.0
# Time in which a pad is loaded over the time unit of its solid: so short that it hardly creeps.
_SUDDEN = 1e-3


@dataclass(frozen=True)
class Hold:
    """A load that an array has to hold.

    Parameters
    ----------
    mass : float
        Mass [kg].
    acceleration : float
        Largest acceleration besides gravity [m/s^2].
    safety_factor : float
        Factor on the force, at least 1.

    Examples
    --------
    >>> f"{Hold(mass=1e-3, acceleration=10.0, safety_factor=2.0).force * 1e3:.1f} mN"
    '39.6 mN'
    """

    mass: Annotated[float, Quantity("kg", "m", "mass", above=0, example="2 g")]
    acceleration: Annotated[
        float, Quantity("m/s^2", "a", "acceleration besides gravity", least=0, example="10 m/s^2")
    ] = 0.0
    safety_factor: Annotated[
        float, Quantity("1", "S", "factor on the force", least=1, example="2")
    ] = 1.0

    def __post_init__(self) -> None:
        conform(self)

    @property
    def force(self) -> float:
        """Force that the array has to hold [N]."""
        return self.safety_factor * self.mass * (GRAVITY + self.acceleration)

    @property
    def weight(self) -> float:
        """Weight of the mass at rest [N]."""
        return self.mass * GRAVITY


@dataclass(frozen=True)
class Holding:
    """How an array holds a load.

    Attributes
    ----------
    holds : bool or None
        Whether the array reaches the force of the load; None within the interval.
    force : float
        Force of the load with acceleration and safety factor [N].
    payload : float
        Largest mass at the speed of the pull with the same acceleration and safety factor, by the
        lower end of the interval of the pull-off force [kg].
    lasting : float or None
        Largest mass at rest with the same safety factor that never creeps off [kg]: by the lower
        end of the pull-off force of the array of relaxed pads. None if these have no such start.
    time : float
        Time under the weight at rest, hung on suddenly, until the array detaches [s]; 0 above the
        instantaneous strength, inf if it never does or lasts longer than a day, nan if unknown.
    release_time : float
        Time from the start of the pull until the last pad has detached [s].
    why : str
        Where the time comes from.
    """

    holds: bool | None
    force: float
    payload: float
    lasting: float | None
    time: float
    release_time: float
    why: str


def holding(
    array: PadArray,
    found: ArrayPull,
    load: Hold,
    *,
    speed: float,
    preload: float,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> Holding:
    """Return how an array that was pulled with a speed and a preload holds a load.

    Parameters
    ----------
    array, found : PadArray and ArrayPull
        The array and its pull.
    load : Hold
        Mass, acceleration and safety factor.
    speed, preload : float
        Those of the pull.
    accuracy, time_limit : float
        Of a simulation of the dead load on one pad.
    """
    low, high = found.interval
    holds = True if load.force <= low else False if load.force > high else None
    payload = low / (load.safety_factor * (GRAVITY + load.acceleration))
    release = float(np.nanmax(found.released)) / speed
    solid, how = array.pad.material, {"accuracy": accuracy, "time_limit": time_limit}
    relaxed = Elastic(rubbery_modulus=solid.rubbery_modulus, poisson_ratio=solid.poisson_ratio)
    pad = replace(array.pad, material=relaxed, traction=at_rest(array.pad.traction))
    slow = None
    with suppress(InputError):  # relaxed pads may have no such start
        resting = pull_array(replace(array, pad=pad), speed=speed, preload=preload, **how)
        slow = resting.interval[0]
    lasting = None if slow is None else slow / (load.safety_factor * GRAVITY)
    held = partial(Holding, holds, load.force, payload, lasting)
    if array.pad.groups().modulus_ratio == 1:
        if slow is not None and load.weight <= slow:
            return held(inf, release, "elastic pads do not creep")
        if grows(array.pad.traction):
            return held(nan, release, "not computed for an interface that grows with its speed")
        above = load.weight > found.pull_off_force
        return held(0.0 if above else inf, release, "elastic pads do not creep")
    count = len(array.positions)
    share = load.weight / (count * found.load_sharing)
    time, why = _time(array.pad, share, preload / count, accuracy, time_limit)
    return held(time, release, why)


def preload_after(
    array: PadArray,
    time: float,
    *,
    preload: float,
    speed: float,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> float:
    """Return the force [N] that is left of a preload after the drive has stood still for a time.

    The pads relax at the position at which they carried the preload, so the force falls, and may
    become tensile by their adhesion. One pad under the mean force is simulated, from an approach at
    the speed of the pull, behind its share of the springs; heights and works of single pads are not
    included.

    Parameters
    ----------
    array : PadArray
        The array.
    time : float
        Time for which the drive is held [s], positive.
    preload, speed : float
        Total force at the end of the approach [N], and speed of the drive [m/s].
    accuracy, time_limit : float
        Of the simulation.

    Raises
    ------
    SimulationError
        If the simulation stops before the end of the time.
    """
    if not 0 < time < inf:
        raise InputError(f"the preload is held for a positive time, got {time:.4g} s")
    if array.pad.groups().modulus_ratio == 1:
        return preload
    count, si = len(array.positions), array.pad.scales()
    soft = shared_compliance(array)
    # so far away that surfaces of short range do not jump into contact
    away = (_APART + _BY_TABOR * (array.pad.groups().tabor or 0.0)) * si.length
    moves = (Approach(speed, to=AtForce(preload / count)), Dwell(time))
    protocol = Retraction(Apart(away), None, stiffness=1 / soft if soft > 0 else None, moves=moves)
    result = solve(
        replace(array.pad, protocol=protocol),
        accuracy=accuracy,
        estimate_error=False,
        time_limit=time_limit,
    )
    return float(result.force[-1]) * si.force * count


def _time(
    pad: Problem, tension: float, preload: float, accuracy: float, time_limit: float | None
) -> tuple[float, str]:
    """Return the time until a pad detaches under a tension [s], and its tier."""
    unit = pad.scales().time
    moves = (LoadTo(-tension, _SUDDEN * unit), Dwell(LONGEST, hold="force"))
    problem = replace(pad, protocol=Retraction(AtForce(preload), None, moves=moves))
    try:
        found = crack_contact(problem)
        tier = "steady crack of one pad under its share"
        gone = found.status == "detached"
        end = float(found.time[np.argmax(found.contact_radius == 0)]) if gone else inf
    except OutOfRange:
        result = solve(
            problem, accuracy=accuracy, estimate_error=False, time_limit=time_limit, throw=False
        )
        if result.outcome is Outcome.STOPPED:
            return nan, f"the simulation of the dead load stopped: {result.status}"
        tier = "simulation of one pad under its share"
        gone = result.outcome in (Outcome.JUMPED, Outcome.DETACHED)
        end = float(result.time[-1]) if gone else inf
    if end <= _SUDDEN:
        return 0.0, f"the weight exceeds the instantaneous strength: {tier}"
    return (end - _SUDDEN) * unit, tier if gone else f"{tier}, for a day"
