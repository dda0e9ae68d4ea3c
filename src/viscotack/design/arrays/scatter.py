r"""Yield of arrays whose heights and works of adhesion scatter, by Monte Carlo.

The curve of one pad is computed once for a few starts and works; each drawn array takes its pads
from it. The share of arrays that reach a force has the interval of Wilson (1927),
doi:10.1080/01621459.1927.10502953.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import sqrt
from typing import Annotated

import numpy as np

from viscotack.arrays import Array
from viscotack.cards import Quantity
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY

from .pulling import PadArray, prepared

# Most pads of all drawn arrays together.
_MOST_DRAWN = 500_000
# Standard deviations of the drawn numbers, which are cut beyond.
_CUT = 3.0
# Normal deviate of a 90 % interval.
_DEVIATE = 1.6449


@dataclass(frozen=True)
class Scatter:
    """Scatter of the pads of an array.

    Parameters
    ----------
    height : float
        Standard deviation of the heights [m].
    work : float
        Standard deviation of the works of adhesion over their mean.
    seed : int
        Of the random numbers, normal ones cut at three standard deviations.

    Examples
    --------
    >>> heights, works = Scatter(height=1e-6, seed=1).drawn(3)
    >>> [f"{height * 1e6:.2f} um" for height in heights]
    ['0.35 um', '0.82 um', '0.33 um']
    """

    height: Annotated[
        float, Quantity("m", "s", "standard deviation of the heights", example="1 um")
    ] = 0.0
    work: Annotated[
        float, Quantity("1", "s_w", "relative standard deviation of the works", example="0.1")
    ] = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.height >= 0 or not 0 <= self.work < 1 / _CUT:
            raise InputError(
                "the scatter of heights must not be negative and that of works must lie between 0 "
                f"and {1 / _CUT:.2f}, got {self.height:.4g} m and {self.work:.4g}"
            )

    def drawn(self, count: int, number: int = 0) -> tuple[Array, Array]:
        """Return heights [m] and factors on the works of an array; `number` counts arrays."""
        random = np.random.default_rng([self.seed, number])
        both = np.clip(random.standard_normal((2, count)), -_CUT, _CUT)
        return self.height * both[0], 1 + self.work * both[1]

    def of(self, array: PadArray, number: int = 0) -> PadArray:
        """Return an array with drawn deviations added to its heights and works."""
        heights, works = self.drawn(len(array.positions), number)
        return replace(
            array, heights=np.array(array.heights) + heights, works=np.array(array.works) * works
        )


@dataclass(frozen=True, eq=False)
class ArrayYield:
    """Share of drawn arrays that reach a force.

    Attributes
    ----------
    share : float
        Share of the arrays whose pull-off force reaches the load.
    interval : tuple of float
        Its 90 % interval, by the number of arrays.
    forces : ndarray
        Pull-off forces of the arrays, ascending [N].
    load : float
        The load [N].
    """

    share: float
    interval: tuple[float, float]
    forces: Array
    load: float


def array_yield(
    array: PadArray,
    scatter: Scatter,
    *,
    load: float,
    speed: float,
    preload: float,
    draws: int = 500,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> ArrayYield:
    """Return the share of arrays with scattered heights and works that reach a load.

    Parameters
    ----------
    array : PadArray
        The array without scatter.
    scatter : Scatter
        Scatter of heights and works, with the seed.
    load : float
        Force that an array has to reach [N], positive in tension.
    speed, preload : float
        As for :func:`viscotack.pull_array`.
    draws : int
        Number of arrays.
    accuracy, time_limit, progress
        As for :func:`viscotack.pull_array`.

    Raises
    ------
    ValueError
        If an array has no relaxed start, or as for :func:`viscotack.pull_array`.
    """
    check_draws(draws, len(array.positions))
    arrays = [scatter.of(array, number) for number in range(draws)]
    pull = prepared(arrays, speed=speed, preload=preload, accuracy=accuracy, time_limit=time_limit)
    forces = np.empty(draws)
    for number, each in enumerate(arrays):
        forces[number] = pull(each)
        progress((number + 1) / draws)
    share = float(np.mean(forces >= load))
    return ArrayYield(share, wilson(share, draws), np.sort(forces), load)


def check_draws(draws: int, count: int) -> None:
    """Refuse more arrays of so many pads than are drawn."""
    if not 1 <= draws * count <= _MOST_DRAWN or draws < 1:
        raise InputError(
            f"draws: {draws:,} arrays of {count:,} pads; up to {_MOST_DRAWN:,} pads are drawn in "
            "all"
        )


def wilson(share: float, count: int) -> tuple[float, float]:
    """Return the 90 % interval of a share of a number of trials.

    Examples
    --------
    >>> low, high = wilson(0.9, 100)
    >>> f"{low:.3f} to {high:.3f}"
    '0.840 to 0.939'
    """
    z2 = _DEVIATE**2 / count
    middle = (share + z2 / 2) / (1 + z2)
    half = sqrt(z2 * share * (1 - share) + z2**2 / 4) / (1 + z2)
    return max(middle - half, 0.0), min(middle + half, 1.0)
