r"""Opening cracks with an interface that grows with the opening speed.

Along a steady crack the opening speed is :math:`\dot h = v \, dh/dx`, so the balance is that of
the law at rest with more tension where the slope is steep (:class:`._balance.Law`). Growth
shortens the crack by the factor Q, the energy dissipated by the interface, and the mesh of the
crack at rest soon becomes too coarse. So each crack is computed in scaled units: tractions over Q,
lengths times Q, and with :math:`y = Q v` for the speed,

.. math:: \sigma' = \frac{\sigma_0 + \sigma_0^+ G(y \, dh/dx')}{Q}, \quad
          \Gamma = Q \, \Gamma', \quad v = y/Q .

The modes of the solid have lengths :math:`y \tau_j` there. Q is predicted from previous cracks.

Between values of y, :math:`\ln(\Gamma - 1)` and :math:`\ln Q` are piecewise
cubic in ln y (:mod:`._mesh`). For dominant growth, :math:`Q \sim (Q v)^n`: the energy tends to
:math:`v^{n/(1-n)}` while the solid is elastic, more steeply than the local tension, because the
crack becomes shorter; an interface whose growth is proportional to the speed has a
largest crack speed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Modes

from ._balance import Law, Solution, System, slopes, solved
from ._branch import STEP, walked
from ._mesh import AHEAD, AHEAD_FOR_ERROR, FINE, Mesh, alone, between, curve, stated

# Gamma - 1 of the first and the last computed crack, and largest number of cracks.
_FIRST, _LAST, _MOST = 1e-4, 300.0, 100
# Gamma - 1 above which no further crack may exist: a shorter table is accepted.
_ENOUGH = 4.0
# Weights of the last cracks in the next one, cubic in ln y.
_BEHIND = np.array([-1.0, 4.0, -6.0, 4.0])


class Grown:
    """Opening cracks of a solid with a growing law.

    Parameters
    ----------
    mesh, law, modes
        Of the crack at rest; times of the modes in the unit of time.
    opening : callable
        Returns the opening matrix of the solid at ln of a speed, without new computation at
        multiples of ``STEP`` that another law has asked for.
    growing : law that grows
        Reduced law, with speeds in h0 per unit of time.
    start : Solution
        The elastic crack of the law at rest.
    """

    def __init__(
        self,
        mesh: Mesh,
        law: Law,
        modes: Modes,
        opening: Callable[[float], Array],
        growing: Any,
        start: Solution,
    ) -> None:
        self._mesh, self._law, self._modes, self._growing = mesh, law, modes, growing
        self._opening = opening
        self._elastic, self._ended = start, False
        # message of the crack that was not found, which ends the list
        self._failed = ""
        self._log_y: list[float] = []
        self._log_work: list[float] = []
        self._log_gained: list[float] = []
        self._works: list[float] = []
        self._cracks: list[Solution] = []
        self._table: tuple[int, Array, Array, Array] | None = None

    @alone
    def gamma(self, log_speed: Array) -> Array:
        """Return amplifications at ln of speeds; constant beyond the last crack."""
        self._reach(speed=float(np.max(log_speed, initial=-np.inf)))
        speed, gained, _ = self._curves()
        below = _first_slope(speed, gained) * np.minimum(log_speed - speed[0], 0.0)
        return 1 + np.exp(np.interp(log_speed, speed, gained) + below)

    @alone
    def work(self, log_speed: Array) -> Array:
        """Return the energies dissipated by the interface at ln of speeds [works of adhesion]."""
        self._reach(speed=float(np.max(log_speed, initial=-np.inf)))
        speed, _, work = self._curves()
        return np.interp(log_speed, speed, work)

    @alone
    def log_speed(self, gamma: Array) -> Array:
        """Return ln of the speeds of amplifications above 1."""
        wanted = np.log(gamma - 1)
        self._reach(gained=float(np.max(wanted, initial=-np.inf)))
        speed, gained, _ = self._curves()
        below = np.minimum(wanted - gained[0], 0.0) / _first_slope(speed, gained)
        return np.interp(wanted, gained, speed) + below

    @property
    @alone
    def largest(self) -> float:
        """Amplification of the last crack that exists or is computed."""
        self._reach(gained=np.inf)
        return float(1 + np.exp(self._curves()[1][-1]))

    @alone
    def interpolation_error(self, log_speed: Array) -> Array:
        """Return the relative interpolation error of amplifications."""
        self._reach(speed=float(np.max(log_speed, initial=-np.inf)), ahead=AHEAD_FOR_ERROR)
        log_work, gained = np.array(self._log_work), np.array(self._log_gained)
        speed = np.maximum.accumulate(np.array(self._log_y) - log_work)
        place = np.interp(log_speed, speed, np.arange(speed.size))
        share = np.exp(np.interp(place, np.arange(speed.size), gained - np.logaddexp(0, gained)))
        return share * (stated(gained, place) + stated(log_work, place))

    @alone
    def at(self, log_speed: float) -> tuple[Solution, float]:
        """Return the crack at ln of a speed, computed, and the interface energy that scales it.

        The crack is in scaled units: lengths over 1/work, tractions over work.
        """
        self._reach(speed=log_speed)
        speed, _, _ = self._curves()
        y = float(np.interp(log_speed, speed, between(np.array(self._log_y))))
        i = int(np.argmin(np.abs(np.array(self._log_y) - y)))
        work = float(np.exp(y - log_speed))
        found = solved(self._system(y, work), self._cracks[i].u)
        if found is None:
            raise InputError(
                f"no steady crack was found at the speed {np.exp(log_speed):.4g}; choose a nearby "
                "speed"
            )
        return found, work

    @property
    def _complete(self) -> bool:
        return bool(self._failed) or (
            bool(self._log_gained)
            and (
                self._ended
                or self._log_gained[-1] > np.log(_LAST)
                or len(self._log_gained) >= _MOST
            )
        )

    def _reach(
        self, *, speed: float = -np.inf, gained: float = -np.inf, ahead: int = AHEAD
    ) -> None:
        """Compute the cracks up to ln of a speed and of Gamma - 1, and those that fix the curve."""
        while not self._complete and max(self._above(speed, gained), 2) + ahead >= len(self._log_y):
            self._append()
        if self._failed and self._above(speed, gained) == len(self._log_y):
            raise InputError(self._failed)

    def _above(self, speed: float, gained: float) -> int:
        """Return the number of the first crack above both; the number of cracks if none is."""
        fast = np.array(self._log_y) - np.array(self._log_work) >= speed
        above = fast & (np.array(self._log_gained) >= gained)
        return int(np.argmax(above)) if np.any(above) else above.size

    def _append(self) -> None:
        if self._cracks:
            before, crack = self._log_y[-1], self._cracks[-1]
            # a multiple, at which all laws share the openings
            y = STEP * (round(before / STEP) + 1)
        else:
            y = self._slowest()
            before, crack = y, self._elastic
        walked = self._walk(before, crack, y)
        if walked is None and self._log_gained and self._log_gained[-1] > np.log(_ENOUGH):
            self._ended = True
            return
        if walked is None:
            self._failed = (
                "no steady crack was found with such strong growth of the interface "
                f"({self._growing}); simulate the contact"
            )
            return
        found, work = walked
        gained = work * found.amplification / self._elastic.amplification - 1
        if not gained > 0:
            raise InputError(
                "no steady crack was found at rest, because the growth of the interface is too "
                "small to resolve; use the law at rest"
            )
        self._log_y.append(y)
        self._log_work.append(float(np.log(work)))
        self._log_gained.append(float(np.log(gained)))
        self._works.append(self._work(found, float(np.exp(y))))
        self._cracks.append(found)

    def _slowest(self) -> float:
        """Return ln of the first y, where Gamma - 1 is negligible."""
        y = STEP * np.arange(-120, 121)
        delay = float(np.dot(self._modes.weights, self._modes.times))
        slow = np.array([self._work(self._elastic, float(np.exp(u))) - 1 for u in y])
        some = slow + delay * np.exp(y)
        return float(y[int(np.argmax(some > _FIRST))])

    def _work(self, crack: Solution, y: float) -> float:
        """Return the interface energy along a crack in scaled units."""
        energy = np.where(crack.gap > 1, self._law.energy(crack.gap), -1.0)
        opening = y * slopes(self._mesh, crack.gap)
        return 1 + float(np.sum(self._growing.growth(opening) * np.diff(energy)))

    def _foreseen(self, crack: Solution, y: float) -> float:
        """Predict the interface energy, which divides the tractions, from previous cracks."""
        if len(self._log_y) < 2:
            return self._work(crack, float(np.exp(y)))
        slope = (self._log_work[-1] - self._log_work[-2]) / (self._log_y[-1] - self._log_y[-2])
        # for another y the divisor is the same function of y
        last = np.log(self._work(self._cracks[-1], float(np.exp(self._log_y[-1]))))
        return float(np.exp(max(last + slope * (y - self._log_y[-1]), 0.0)))

    def _walk(self, before: float, crack: Solution, aim: float) -> tuple[Solution, float] | None:
        """Return the crack at ln y and its interface energy, from another crack, or None."""
        works = [1.0]

        def system(y: float, crack: Solution) -> System:
            works.append(self._foreseen(crack, y))
            return self._system(y, works[-1])

        guess = None
        if len(self._cracks) >= _BEHIND.size:
            last = [known.u for known in self._cracks[-_BEHIND.size :]]
            guess = _BEHIND @ np.array(last)
        found = walked(system, before, crack, aim, guess)
        return None if found is None else (found, works[-1])

    def _system(self, log_y: float, work: float) -> System:
        law = self._law._replace(growing=self._growing, speed=float(np.exp(log_y)), strength=work)
        return System(self._mesh, law, self._opening(log_y))

    def _curves(self) -> tuple[Array, Array, Array]:
        """Return ln of speeds and of Gamma - 1, both increasing, and the interface energies."""
        if self._table is None or self._table[0] != len(self._log_y):
            y = np.array(self._log_y)
            fine = between(y)
            speed = fine - curve(y, np.array(self._log_work))(fine)
            gained = curve(y, np.array(self._log_gained))(fine)
            rising = np.maximum.accumulate(speed), np.maximum.accumulate(gained)
            work = np.exp(curve(y, np.log(self._works))(fine))
            self._table = (y.size, *rising, work)
        return self._table[1:]


def _first_slope(speed: Array, gained: Array) -> float:
    """Return the slope between the first two cracks, whose small Gamma - 1 is not smooth."""
    return float((gained[FINE] - gained[0]) / (speed[FINE] - speed[0]))
