"""Tabulated energy of an edge, for fast scalar and vectorised evaluation."""

from __future__ import annotations

from collections.abc import Callable
from math import log
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.theory.crack.steady import SteadyCrack, energy_of_odds

# ln of the odds of Gamma at both ends of the table, and number of rows.
_ODDS, _ROWS = (-14.0, 12.0), 8000
# Number of rows of other tables over the speed.
_OTHERS = 1000
# Gamma - 1 of the slowest crack of an interface that grows with the opening speed.
_GAINED = 1e-6


class Even:
    """Linear interpolation on a uniform grid, constant beyond the ends."""

    def __init__(self, first: float, last: float, values: Array) -> None:
        self._first, self._per = first, (values.size - 1) / (last - first)
        self._values, self._last = values, values.size - 1
        self._rise = np.append(np.diff(values), 0.0)

    def __call__(self, x: Any) -> Any:
        """Return the values at x."""
        # minimum and maximum, because np.clip dominates the time for small arrays
        place = np.minimum(np.maximum((x - self._first) * self._per, 0.0), self._last)
        i = place.astype(np.intp)
        return self._values[i] + (place - i) * self._rise[i]

    def one(self, x: float) -> float:
        """Return the value at a scalar x, without array overhead."""
        place = min(max((x - self._first) * self._per, 0.0), float(self._last))
        i = int(place)
        return float(self._values[i] + (place - i) * self._rise[i])


class Edge:
    """Gamma as a function of ln V for an opening (sign 1) or closing (-1) crack."""

    def __init__(self, crack: SteadyCrack, sign: int) -> None:
        k = crack.modes.instantaneous
        self.limit, self.sign = (crack.largest if sign > 0 else k), sign
        # an interface that grows with the opening speed has no such limit
        grown = sign > 0 and crack.largest != 1 / k
        self.elastic, self.span = k == 1 and not grown, (0.0, 0.0)
        if self.elastic:
            return
        ends = energy_of_odds(np.exp(np.array(_ODDS)), k, sign)
        if grown:
            ends = 1 + np.array([_GAINED, (1 - 1e-9) * (crack.largest - 1)])
        first, last = np.log(np.abs(np.asarray(crack.speed(ends))))
        speed = np.exp(np.linspace(first, last, _ROWS))
        self._gamma = Even(first, last, np.asarray(crack.amplification(sign * speed)))
        self.span = first, last

    def amplification(self, speed: Any) -> Any:
        """Return Gamma at speeds, not negative."""
        if self.elastic:
            return np.ones(np.shape(speed))
        with np.errstate(divide="ignore"):
            return self._gamma(np.log(speed))

    def one(self, speed: float) -> float:
        """Return Gamma at one speed; negative speeds count as zero (round-off of the edge)."""
        if self.elastic or speed <= 0:
            return 1.0
        return self._gamma.one(log(speed))

    def table(self, quantity: Callable[[Array], Array]) -> Even | None:
        """Tabulate a function of the speed over ln V; None if Gamma is constant."""
        if self.elastic:
            return None
        first, last = self.span
        return Even(first, last, quantity(np.exp(np.linspace(first, last, _OTHERS))))
