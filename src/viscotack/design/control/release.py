r"""A controller that lets a contact go at a wanted force.

The pull-off force depends on the speed of the contact, which is not that of the drive: behind a
spring K the drive at D has the contact at :math:`\delta = D - F/K`. The controller chooses the
speed v of the contact whose pull-off force is the wanted one, and moves the drive so that the
contact keeps it. At every tick it measures D and F, and aims at a depth for the next one,

.. math:: \delta_{n+1} = \delta_n - c\, v\,\Delta t, \quad
          D_{n+1} = \delta_{n+1} + \frac{1}{K}\left(F_n
          + \frac{\partial F}{\partial \delta} (\delta_{n+1} - \delta_n)\right),

with the slope of the table. The factor c brings the contact back to where it would be at the speed
v, :math:`\delta_0 - (n + 1) v\,\Delta t`, but stays between 0.97 and 1.03: the force depends on the
speed, and hardly on the time, so that an error of the depth should not become one of the speed.
Where the slope s of the table is not that of the contact, F', the contact moves by
:math:`(K + s)/(K + F')` of what is aimed at. Past the pull-off, where F' may be below -K and no
drive holds the contact, the drive continues at v.

The rig on which it is tried is simulated: a contact behind a spring.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite

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
from viscotack.units import readable

from .table import ForceTable

# Loss of tension, over the largest one so far, after which the pull-off is past.
PAST = 0.02
# Largest change of the speed of the contact to be where it should be, relative.
CATCH_UP = 0.03


@dataclass
class Release:
    """A controller that moves a drive so that a contact detaches at a wanted force.

    Parameters
    ----------
    table : ForceTable
        The contact.
    wanted : float
        Pull-off force [N], positive.
    stiffness : float
        Of the spring between drive and indenter [N/m], positive; infinite for a rigid machine.
    period : float
        Time between two ticks [s], 1 ms for 1 kHz.
    fastest : float
        Largest speed of the drive [m/s], either way.

    Attributes
    ----------
    speed : float
        Speed of the contact [m/s], positive, constant until the pull-off.

    Raises
    ------
    ValueError
        If a number is not positive.
    OutOfRange
        If no speed of the table has the wanted force; the message states the range.

    Examples
    --------
    >>> import numpy as np
    >>> table = ForceTable(
    ...     start_depth=1e-6,
    ...     speed=np.array([1e-6, 1e-4]),
    ...     travel=np.array([[2e-6, 3e-6, 4e-6], [4e-6, 5e-6, 6e-6]]),
    ...     share=np.array([0.0, 1.0, 2.0, 3.0]),
    ...     force=np.array([[1e-3, -1e-3, -5e-4, 0.0], [1e-3, -3e-3, -1.5e-3, 0.0]]),
    ...     error=0.01,
    ...     of="an example",
    ... )
    >>> release = Release(table, wanted=2e-3, stiffness=500.0, period=1e-3, fastest=1e-2)
    >>> f"{release.speed:.1e} {release.drive_speed(drive=3e-6, force=1e-3):.2e}"
    '1.0e-05 -3.00e-05'
    """

    table: ForceTable
    wanted: float
    stiffness: float
    period: float
    fastest: float = inf

    def __post_init__(self) -> None:
        for name, unit in (("stiffness", "N/m"), ("period", "s"), ("fastest", "m/s")):
            if not (value := getattr(self, name)) > 0:
                raise InputError(f"{name} must be positive, got {readable(value, unit)}")
        if not isfinite(self.period):
            raise InputError("the period must be finite")
        self.speed = self.table.speed_for(self.wanted)
        self.ticks = 0
        self.tension = 0.0
        self.past = False

    def drive_speed(self, drive: float, force: float) -> float:
        """Return the speed of the drive until the next tick, from the present measurement.

        Parameters
        ----------
        drive : float
            Position of the drive [m], positive into the solid; on a rigid machine the depth.
        force : float
            [N], positive in compression.

        Returns
        -------
        float
            Speed [m/s], positive into the solid: negative pulls.
        """
        self.ticks += 1
        self.tension = max(self.tension, -force)
        self.past = self.past or (self.tension > 0 and -force < (1 - PAST) * self.tension)
        if self.past:
            return -min(self.speed, self.fastest)
        depth = drive - force / self.stiffness
        step = self.speed * self.period
        late = (depth - (self.table.start_depth - self.ticks * step)) / step
        aim = depth - step * min(max(late, 1 - CATCH_UP), 1 + CATCH_UP)
        slope = self.table.slope_at(aim, self.speed)
        slope = max(slope, 0.0) if isfinite(slope) else 0.0
        to = aim + (force + slope * (aim - depth)) / self.stiffness
        return min(max((to - drive) / self.period, -self.fastest), self.fastest)


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
