"""Cracks of one solid and law in one direction, computed on demand from the slowest on.

At speeds a quarter of a decade apart Newton's method starts from the previous crack. Between
them ln of (Gamma - 1)/(1/k - Gamma), for closing of (1 - Gamma)/(Gamma - k), is piecewise cubic in
ln of the speed (:mod:`._mesh`); fourth differences give the error estimate.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.threads import one_blas_thread

from ._balance import Law, Solution, System, solved
from ._mesh import (
    AHEAD,
    AHEAD_FOR_ERROR,
    Mesh,
    alone,
    between,
    closing_inflow,
    closing_matrix,
    curve,
    lengths_of,
    opening_matrix,
    stated,
)

STEP = np.log(10) / 4
_SHORTEST_STEP = STEP / 64
# Decay length of the longest mode at the first computed speed, over the length of the crack; and
# lower speeds at which Gamma - 1 = s V + b V^2 gives the odds, with s of the slowest crack.
_SLOW, _SLOWER = 0.03, 12
# ln of the odds at which the crack is glassy; and largest number of computed speeds.
_GLASSY, _MOST = np.log(2e3), 400


def energy_of_odds(odds: Array, modulus_ratio: float, sign: int = 1) -> Array:
    """Return the dimensionless energy Gamma of a crack from its odds.

    Parameters
    ----------
    odds : ndarray
        (Gamma - 1)/(1/k - Gamma) for an opening crack, (1 - Gamma)/(Gamma - k) for a closing
        one; not negative.
    modulus_ratio : float
        k, above 0 and at most 1.
    sign : int
        1 opening, -1 closing.

    Examples
    --------
    >>> float(energy_of_odds(np.array(1.0), 0.1))
    5.5
    """
    limit = odds / modulus_ratio if sign > 0 else odds * modulus_ratio
    return (1 + limit) / (1 + odds)


def walked(
    system: Callable[[float, Solution], System],
    before: float,
    crack: Solution,
    aim: float,
    guess: Array | None = None,
) -> Solution | None:
    """Continue a crack from one place to another in steps that converge; None if none does.

    The balance at a place may depend on the previous crack. A guess of the crack at the aim is
    tried first.
    """
    if guess is not None:
        with one_blas_thread():
            found = solved(system(aim, crack), guess)
        if found is not None:
            return found
    at, step = before, aim - before
    while True:
        towards = aim if abs(aim - at) <= abs(step) else at + step
        with one_blas_thread():
            found = solved(system(towards, crack), crack.u)
        if found is not None:
            at, crack, step = towards, found, 1.5 * step
            if at == aim:
                return crack
            continue
        step /= 2
        if abs(step) < _SHORTEST_STEP:
            return None


class Branch:
    """Opening (sign 1) or closing (sign -1) cracks.

    Parameters
    ----------
    mesh, law, modes
        Of the crack; times of the modes in the unit of time.
    start : Solution
        The elastic crack.
    slow : float
        (Gamma - 1)/V of the slowest crack.
    sign : int
        1 or -1.
    """

    def __init__(
        self, mesh: Mesh, law: Law, modes: Modes, start: Solution, slow: float, sign: int
    ) -> None:
        self._mesh, self._law, self._modes, self._sign = mesh, law, modes, sign
        self._elastic, self._slow = start, slow
        # the distance of the limits of Gamma at infinite speed from 1
        self._limit = 1 / modes.instantaneous if sign > 0 else modes.instantaneous
        self._first = float(np.log(_SLOW * mesh.width / max(modes.times)))
        self._log_speed: list[float] = []
        self._odds: list[float] = []
        self._cracks: list[Solution] = []
        self._curve: tuple[int, Any] | None = None
        # message of the crack that was not found, which ends the list
        self._failed = ""

    @alone
    def gamma(self, log_speed: Array) -> Array:
        """Return amplifications at ln of speeds; linear below the first speed."""
        self._reach(float(np.max(log_speed, initial=-np.inf)))
        first, last = self._log_speed[0], self._log_speed[-1]
        inside = self._between()(np.clip(log_speed, first, last))
        beyond = np.minimum(log_speed - first, 0) + np.maximum(log_speed - last, 0)
        return energy_of_odds(np.exp(inside + beyond), self._modes.instantaneous, self._sign)

    @alone
    def log_speed(self, gamma: Array) -> Array:
        """Return ln of the speeds of amplifications."""
        odds = np.log((gamma - 1) / (self._limit - gamma))
        highest = float(np.max(odds, initial=-np.inf))
        while not self._complete and (not self._odds or self._odds[-1] < highest):
            self._append()
        above = int(np.argmax(np.array(self._odds) >= highest))
        if self._failed and self._odds[above] < highest:
            raise InputError(self._failed)
        self._reach(max(self._log_speed[above], self._first))
        grid = between(np.array(self._log_speed))
        # the odds increase; a decreasing curve is caused by round-off at the ends
        y = np.maximum.accumulate(self._between()(grid))
        inside = np.interp(odds, y, grid)
        return inside + np.minimum(odds - y[0], 0) + np.maximum(odds - y[-1], 0)

    @alone
    def interpolation_error(self, log_speed: Array) -> Array:
        """Return the interpolation error of ln of the odds."""
        self._reach(float(np.max(log_speed, initial=-np.inf)), AHEAD_FOR_ERROR)
        place = np.interp(log_speed, self._log_speed, np.arange(len(self._log_speed)))
        return stated(np.array(self._odds), place)

    @alone
    def at(self, log_speed: float) -> Solution:
        """Return the crack at ln of a speed, computed without interpolation."""
        self._reach(log_speed)
        i = int(np.argmin(np.abs(np.array(self._log_speed) - log_speed)))
        return self._walk(self._log_speed[i], self._cracks[i], log_speed)

    @property
    def _complete(self) -> bool:
        return bool(self._failed) or (
            bool(self._odds) and (self._odds[-1] > _GLASSY or len(self._odds) >= _MOST)
        )

    def _reach(self, log_speed: float, ahead: int = AHEAD) -> None:
        """Compute the cracks up to ln of a speed, and those beyond that fix the curve there."""
        least = max(log_speed, self._first) + ahead * STEP
        while not self._complete and (not self._odds or self._log_speed[-1] < least):
            self._append()
        if self._failed and log_speed > self._log_speed[-1]:
            raise InputError(self._failed)

    def _append(self) -> None:
        if self._cracks:
            before, crack = self._log_speed[-1], self._cracks[-1]
            log_speed = before + STEP
        else:
            before, crack, log_speed = self._first - STEP, self._elastic, self._first
        try:
            found = self._walk(before, crack, log_speed)
        except InputError as failed:
            if not self._cracks:
                raise
            self._failed = str(failed)
            return
        if not self._cracks:
            self._begin(found)
        odds = self._odds_of(self._gained(found))
        self._log_speed.append(log_speed)
        self._cracks.append(found)
        self._odds.append(odds)

    def _begin(self, first: Solution) -> None:
        """Add the slow cracks below the first computed one."""
        over = self._gained(first) / (self._slow * np.exp(self._first))
        parts = [np.exp(i * STEP) for i in range(-_SLOWER, 0)]
        slowest = self._slow * np.exp(self._first)
        odds = [self._odds_of(slowest * part * (1 + (over - 1) * part)) for part in parts]
        self._log_speed += [self._first + i * STEP for i in range(-_SLOWER, 0)]
        self._odds += odds
        self._cracks += [self._elastic] * _SLOWER

    def _walk(self, before: float, crack: Solution, aim: float) -> Solution:
        """Continue the crack from ln of one speed to another, in steps that converge."""
        found = walked(lambda x, _: self._system(np.exp(x)), before, crack, aim)
        if found is None:
            speed = self._sign * np.exp(aim)
            raise InputError(
                f"no steady crack was found at the speed {speed:.4g} E0* h0^2/(dg tau); "
                "choose a slower one, or simulate the contact"
            )
        return found

    def _system(self, speed: float) -> System:
        modes = lengths_of(self._mesh, self._modes, speed)
        if self._sign > 0:
            return System(self._mesh, self._law, opening_matrix(self._mesh, modes))
        own = np.concatenate([np.eye(self._mesh.x.size), self._mesh.far[:, None]], axis=1)
        inflow = closing_inflow(self._mesh, modes, self._law.traction)
        return System(self._mesh, self._law, own, closing_matrix(self._mesh, modes), inflow)

    def _gained(self, crack: Solution) -> float:
        """Return the positive distance of the amplification from 1."""
        return self._sign * (crack.amplification / self._elastic.amplification - 1)

    def _odds_of(self, gained: float) -> float:
        if not gained > 0:
            raise InputError(
                "the slowest crack does not differ from the elastic one: the slowest retardation "
                f"time of the solid, {max(self._modes.times):.3g} time units, is too long for its "
                "weight; remove modes of negligible weight"
            )
        return float(np.log(gained / max(abs(self._limit - 1) - gained, 1e-12)))

    def _between(self) -> Any:
        """Return the curve of ln of the odds through the computed cracks."""
        if self._curve is None or self._curve[0] != len(self._odds):
            x, y = np.array(self._log_speed), np.array(self._odds)
            self._curve = x.size, curve(x, y)
        return self._curve[1]
