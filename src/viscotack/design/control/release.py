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
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite

from viscotack.errors import InputError
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
