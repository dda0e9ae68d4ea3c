"""A simulated rig: a contact behind a spring, and a controller that moves the drive."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from viscotack.arrays import Array
from viscotack.clock import TimeUp, limited
from viscotack.design.window.simulated import part_of, posed_contact
from viscotack.errors import InputError
from viscotack.model.problem import Problem, Scales
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.simulate.march import SteppedSimulation
from viscotack.simulate.settings import Settings
from viscotack.threads import one_blas_thread

from .release import Release

# A test ends after this multiple of the time of its retraction in the table.
_LONGEST = 3.0
# Tension, over the largest one, below which the contact has detached.
_GONE = 0.05


@dataclass(frozen=True, eq=False)
class Released:
    """A controlled release on a simulated rig, in SI; series with a value for each tick.

    Attributes
    ----------
    time, drive, depth, force : ndarray, shape (n,)
        Time [s], positions of drive and indenter [m], force [N], positive in compression.
    drive_speed : ndarray, shape (n,)
        Speed of the drive until the next tick [m/s], positive into the solid.
    pull_off_force : float
        Largest tension of all steps of the simulation [N].
    wanted : float
        Wanted pull-off force [N].
    """

    time: Array
    drive: Array
    depth: Array
    force: Array
    drive_speed: Array
    pull_off_force: float
    wanted: float

    @property
    def miss(self) -> float:
        """Pull-off force over the wanted one, less one."""
        return self.pull_off_force / self.wanted - 1


def let_go(
    problem: Problem,
    release: Release,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> Released:
    """Simulate a rig on which a controller lets a contact go.

    The rig measures the position of its drive and the force at every tick, without noise, and the
    drive keeps the speed that the controller returns until the next one.

    Parameters
    ----------
    problem : Problem
        The contact of the rig at its relaxed start, on a rigid machine without moves; it may differ
        from that of the table of the controller.
    release : Release
        The controller, at its beginning; it has the stiffness of the rig.
    accuracy : float
        Of the simulation, as for :func:`viscotack.solve`.
    time_limit : float, optional
        Longest wall time [s].

    Returns
    -------
    Released
        What the rig did until it detached.

    Raises
    ------
    ValueError
        If the protocol has moves or a spring, the controller was used before, or the contact does
        not detach within three times the time of the table or within the time limit.
    """
    test = problem.protocol
    if test.moves or test.stiffness is not None:
        raise InputError(
            "the rig starts at the relaxed contact, behind the spring of the controller: leave out "
            "moves and stiffness of the problem"
        )
    if release.ticks:
        raise InputError("the controller was used before; make a new one")
    unit, settings = problem.scales(), Settings.for_accuracy(accuracy)
    longest = _LONGEST * float(release.table.travel[:, 2].max()) / release.speed
    fastest = release.fastest if release.fastest < inf else 100 * release.speed
    with one_blas_thread(), limited(time_limit):
        try:
            posed = posed_contact(problem, settings)
            first = settings.first_travel * posed.contact.travel * unit.length / fastest
            least = min(first, release.period)
            simulation = SteppedSimulation(
                part_of(posed, settings, least, longest),
                release.stiffness * unit.length / unit.force,
                least_step=least / unit.time,
                settings=settings,
            )
            rows = _driven(simulation, release, unit, longest)
        except TimeUp as limit:
            raise InputError(f"{limit} before the contact detached; give more time") from None
    time, drives, depth, forces, moved = np.array(rows).T
    return Released(
        time, drives, depth, forces, moved, simulation.tension * unit.force, release.wanted
    )


def _driven(
    simulation: SteppedSimulation, release: Release, unit: Scales, longest: float
) -> list[tuple[float, ...]]:
    """Return time, drive, depth, force and speed of the drive at every tick until it detached."""
    rows, now = [], simulation.now
    drive = now.depth * unit.length + now.force * unit.force / release.stiffness
    for tick in range(int(longest / release.period) + 1):
        depth, force = simulation.now.depth * unit.length, simulation.now.force * unit.force
        moves = release.drive_speed(drive, force)
        rows.append((tick * release.period, drive, depth, force, moves))
        simulation.move(moves * unit.time / unit.length, release.period / unit.time)
        drive += moves * release.period
        if simulation.apart or (release.past and -force < _GONE * release.tension):
            return rows
    raise InputError(f"the contact did not detach within {longest:.3g} s")
