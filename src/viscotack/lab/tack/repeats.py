r"""Repeated tests: equal temperatures and speeds, and one scatter pooled over all speeds.

A few repeats at one speed do not determine their scatter: two tests that agree by chance would
weigh a hundred times those that do not. The relative scatter s is therefore one number for a
series. Forces are means with the weights of a Student distribution,

.. math:: w = \frac{\nu + 1}{\nu + z^2} , \qquad z^2 = \frac{r^2}{s^2 (1 - 1/n_i)} , \qquad
          s^2 = \frac{\sum w r^2}{c \sum_i (n_i - 1)} ,

where r are the deviations of ln(force) from the mean at its speed, :math:`n_i` the number of tests
there, :math:`\nu = 6`, and c the mean of :math:`w z^2` for normal deviations. A test far from the
others at its speed counts little, and is named.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import erfc, exp, pi, sqrt

import numpy as np
import numpy.typing as npt
from scipy.stats import norm, t

from viscotack.arrays import Array
from viscotack.lab.grouping import levels

from .cycle import Cycle

SAME = 0.03  # relative difference below which speeds, and preloads, are equal
_FREEDOM = 6.0  # of the weights: less shrinks the scatter of three tests, more trusts outliers
# Mean of w z^2 for a standard normal z
_NORMAL = (_FREEDOM + 1) * (
    1 - sqrt(pi * _FREEDOM / 2) * exp(_FREEDOM / 2) * erfc(sqrt(_FREEDOM / 2))
)
_ROUNDS = 30
_FAR = 3.5  # scatters from the mean of the others above which a test is named
_LEVEL = 0.95  # of the quantile at which the normal distribution replaces Student's


@dataclass(frozen=True, eq=False)
class Repeats:
    """Repeated tests of a series.

    Parameters
    ----------
    means : tuple of float
        Mean force at each speed [N].
    scatter : float
        Relative standard deviation of single tests; 0 if no speed has repeats.
    freedom : int
        Degrees of freedom of the scatter, the sum of n_i - 1.
    far : tuple of tuple of int
        Tests at each speed that are far from the others there.
    """

    means: tuple[float, ...]
    scatter: float
    freedom: int
    far: tuple[tuple[int, ...], ...]

    def uncertainty(self, tests: int) -> float:
        """Return the relative standard uncertainty of a mean of a number of tests.

        It is widened so that a normal 90 % interval is as wide as Student's.
        """
        if not self.freedom:
            return 0.0
        wider = t.ppf(_LEVEL, self.freedom) / norm.ppf(_LEVEL)
        return float(wider * self.scatter / np.sqrt(tests))


def pooled(forces: Sequence[npt.ArrayLike]) -> Repeats:
    """Return the means of the tests at each speed [N] and their pooled scatter.

    Parameters
    ----------
    forces : sequence of array_like
        Pull-off forces of the tests at each speed, positive [N].
    """
    logs = [np.log(np.asarray(one, dtype=float)) for one in forces]
    freedom = sum(one.size - 1 for one in logs)
    means = [float(np.median(one)) for one in logs]
    variance = sum(float(np.sum((x - m) ** 2)) for x, m in zip(logs, means, strict=True))
    variance /= max(freedom, 1)
    for _ in range(_ROUNDS if variance else 0):
        weights = [_weights(x - m, variance) for x, m in zip(logs, means, strict=True)]
        rows = list(zip(logs, weights, strict=True))
        means = [float(np.average(x, weights=w)) for x, w in rows]
        squares = (float(w @ (x - m) ** 2) for (x, w), m in zip(rows, means, strict=True))
        variance = sum(squares) / (_NORMAL * freedom)
    scatter = sqrt(variance)
    return Repeats(
        tuple(np.exp(means).tolist()), scatter, freedom, tuple(_far(x, scatter) for x in logs)
    )


def _weights(away: Array, variance: float) -> Array:
    """Return the Student weight of each test at one speed."""
    if away.size == 1:
        return np.ones(1)
    z2 = away**2 / (variance * (1 - 1 / away.size))
    return (_FREEDOM + 1) / (_FREEDOM + z2)


def _far(logs: Array, scatter: float) -> tuple[int, ...]:
    """Return the tests that are far from the mean of the others; of two, neither is."""
    if logs.size < 3 or not scatter:
        return ()
    others = (logs.sum() - logs) / (logs.size - 1)
    apart = np.abs(logs - others) / np.sqrt(1 + 1 / (logs.size - 1))
    worst = int(np.argmax(apart))
    return (worst,) if apart[worst] > _FAR * scatter else ()


def same_temperatures(cycles: Sequence[Cycle]) -> list[list[Cycle]]:
    """Return the cycles of each temperature, coldest first, before them those without one.

    Temperatures that differ by less than 1 K from the next one are equal.
    """
    known = [one for one in cycles if one.temperature is not None]
    groups = [[one for one in cycles if one.temperature is None]]
    if known:
        rows = levels(np.array([one.temperature for one in known]))
        groups += [[known[i] for i in sorted(row)] for row in rows]
    return [group for group in groups if group]


def temperature_of(cycles: Sequence[Cycle]) -> float | None:
    """Return the mean temperature of cycles [K], None if that of one is unknown."""
    found = [one.temperature for one in cycles if one.temperature is not None]
    return float(np.mean(found)) if len(found) == len(cycles) else None


def same_speeds(cycles: Sequence[Cycle]) -> list[list[Cycle]]:
    """Return the cycles of each temperature and speed, coldest and slowest first.

    Speeds within 3 % are equal, and temperatures as in :func:`same_temperatures`.
    """
    return [group for same in same_temperatures(cycles) for group in _same_speeds(same)]


def _same_speeds(cycles: Sequence[Cycle]) -> list[list[Cycle]]:
    groups: list[list[Cycle]] = []
    for cycle in sorted(cycles, key=lambda cycle: cycle.speed.value):
        if groups and cycle.speed.value <= (1 + SAME) * groups[-1][0].speed.value:
            groups[-1].append(cycle)
        else:
            groups.append([cycle])
    return groups
