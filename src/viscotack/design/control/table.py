r"""Force of a contact by depth and speed of a retraction, for controllers.

A row of the table is the retraction from one start at one speed. Rows have the same shares u of the
way: u = 0 at the start, 1 at the largest tension, 2 where the tension has fallen to half of it, and
3 where the surfaces are apart. With the travels d0 = 0, d1, d2, d3 to these,

.. math:: \delta = \delta_0 - d_j - (d_{j+1} - d_j)(u - j), \quad j \le u \le j + 1.

Between two speeds, forces at equal shares and the travels are linear in the logarithm of the speed,
so that peaks of neighbouring rows are joined with each other, and so are their falls. Beyond the
end the force is 0, before the start it has no value.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, nan

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.units import readable


@dataclass(frozen=True, eq=False)
class ForceTable:
    """Force of a contact by depth and speed of its retraction, in SI.

    Attributes
    ----------
    start_depth : float
        Depth at which every retraction starts [m], positive into the solid.
    speed : ndarray, shape (m,)
        Speeds of retraction of the contact [m/s], positive, ascending.
    travel : ndarray, shape (m, 3)
        Travels from the start to the pull-off, to half of its force and to the end [m], ascending.
    share : ndarray, shape (n,)
        Shares of the way, ascending from 0 to 3; 1 and 2 are among them.
    force : ndarray, shape (m, n)
        Forces [N], positive in compression.
    error : float
        Largest error of a force over the pull-off force, until half of that is left, and of the
        travels to both: of the interpolation, as measured at speeds between, and as estimated for
        the simulations.
    of : str
        The contact in words.

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
    >>> f"{table.force_at(-2e-6, 1e-5):.4f} {table.speed_for(2e-3):.1e}"
    '-0.0020 1.0e-05'
    """

    start_depth: float
    speed: Array
    travel: Array
    share: Array
    force: Array
    error: float
    of: str

    @property
    def pull_off_force(self) -> Array:
        """Pull-off forces at the speeds of the table [N], positive; shape (m,)."""
        return -self.force[:, self._peak]

    @property
    def _peak(self) -> int:
        return int(np.searchsorted(self.share, 1.0))

    def force_at(self, depth: float, speed: float) -> float:
        """Return the force at a depth in a retraction at a speed.

        Parameters
        ----------
        depth : float
            [m], positive into the solid.
        speed : float
            Of the contact [m/s], positive.

        Returns
        -------
        float
            Force [N], positive in compression; 0 beyond the end, nan before the start and at
            speeds outside the table.
        """
        return self._at(depth, speed)[0]

    def slope_at(self, depth: float, speed: float) -> float:
        """Return the derivative of the force by the depth [N/m]; other arguments as `force_at`."""
        return self._at(depth, speed)[1]

    def pull_off_force_at(self, speed: float) -> float:
        """Return the pull-off force at a speed [N], positive; nan outside the table."""
        i, part = self._between(speed)
        if i < 0:
            return nan
        P = self.pull_off_force
        return float(P[i] + part * (P[i + 1] - P[i]))

    def speed_for(self, wanted: float) -> float:
        """Return the slowest speed at which the pull-off force is a wanted one.

        Parameters
        ----------
        wanted : float
            Pull-off force [N], positive.

        Returns
        -------
        float
            Speed of the contact [m/s].

        Raises
        ------
        OutOfRange
            If no speed of the table has this force; the message states the range.
        """
        P = self.pull_off_force
        for i in range(len(P) - 1):
            low, high = sorted((float(P[i]), float(P[i + 1])))
            if low <= wanted <= high:
                part = 0.0 if low == high else (wanted - P[i]) / (P[i + 1] - P[i])
                return float(self.speed[i] * (self.speed[i + 1] / self.speed[i]) ** part)
        ends = readable(float(P.min()), "N"), readable(float(P.max()), "N")
        speeds = (readable(float(self.speed[i]), "m/s") for i in (0, -1))
        raise OutOfRange(
            f"a pull-off force of {readable(wanted, 'N')} is out of reach: between {ends[0]} and "
            f"{ends[1]} at speeds from {' to '.join(speeds)}"
        )

    def _between(self, speed: float) -> tuple[int, float]:
        """Return the row below a speed and the part of the way to the next; -1 if outside."""
        v = self.speed
        if not v[0] <= speed <= v[-1]:
            return -1, nan
        i = min(int(np.searchsorted(v, speed, side="right")) - 1, len(v) - 2)
        return i, log(speed / v[i]) / log(v[i + 1] / v[i])

    def _at(self, depth: float, speed: float) -> tuple[float, float]:
        """Return the force at a depth and its derivative by the depth."""
        i, part = self._between(speed)
        gone = self.start_depth - depth
        if i < 0 or not gone >= 0:
            return nan, nan
        travel = self.travel[i] + part * (self.travel[i + 1] - self.travel[i])
        if gone >= travel[2]:
            return 0.0, 0.0
        leg = int(gone > travel[0]) + int(gone > travel[1])
        before = 0.0 if leg == 0 else travel[leg - 1]
        way = travel[leg] - before
        u = leg + (gone - before) / way
        # at the peak, the part before it
        j = int(np.searchsorted(self.share, u, side="left")) - 1
        j = min(max(j, 0), len(self.share) - 2)
        row = self.force[i] + part * (self.force[i + 1] - self.force[i])
        width = self.share[j + 1] - self.share[j]
        rise = (row[j + 1] - row[j]) / width
        return float(row[j] + (u - self.share[j]) * rise), float(-rise / way)
