"""A table on an even grid: read without a search."""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.arrays import Array


class Even:
    """Values at even distances, straight between, constant beyond the ends."""

    def __init__(self, first: float, last: float, values: Array) -> None:
        self._first, self._per = first, (values.size - 1) / (last - first)
        self._values, self._last = values, values.size - 1
        self._rise = np.append(np.diff(values), 0.0)

    def __call__(self, x: Any) -> Any:
        """Return the values at x."""
        # two plain functions: np.clip takes longer than all the rest where arrays are small
        place = np.minimum(np.maximum((x - self._first) * self._per, 0.0), self._last)
        i = place.astype(np.intp)
        return self._values[i] + (place - i) * self._rise[i]

    def one(self, x: float) -> float:
        """Return the value at one x, without the overhead of arrays."""
        place = min(max((x - self._first) * self._per, 0.0), float(self._last))
        i = int(place)
        return float(self._values[i] + (place - i) * self._rise[i])
