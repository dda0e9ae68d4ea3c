r"""Statistics of pull-offs by temperature and speed, as laboratories report them.

For each speed: number of tests, mean and standard deviation. For the series: scatter of single
tests pooled over speeds, and for each temperature the exponent of a power law of
force by speed,

.. math:: \ln F = n \ln v + c ,

fitted by least squares to the means, with the standard error of its residuals. A rate-independent
contact has n = 0. The power law describes data; it is no model of the contact.

With a shift law, a test at speed v and temperature T is referred to the reference temperature: the
times of the solid are a_T times those there, so that the same force is reached at the speed a_T v
(master curve), if the interface does not depend on temperature.

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
from dataclasses import dataclass, replace
from itertools import islice
from math import erfc, exp, pi, sqrt

import numpy as np
import numpy.typing as npt
from scipy.stats import norm, t

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import levels
from viscotack.model.materials.shift import Shift
from viscotack.theory.elastic import jkr

from .record import Cycle, Measured

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

    def less(self, fitted: int) -> "Repeats":
        """Return these repeats with a number of degrees of freedom that a fit has taken."""
        left = self.freedom - fitted
        if left <= 0:
            return replace(self, scatter=0.0, freedom=0)
        return replace(self, scatter=self.scatter * sqrt(self.freedom / left), freedom=left)

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
        shares = [max(1 - 1 / one.size, 0.5) for one in logs]  # a single one is its mean
        away = [x - m for x, m in zip(logs, means, strict=True)]
        weights = [
            (_FREEDOM + 1) / (_FREEDOM + each**2 / (variance * share))
            for each, share in zip(away, shares, strict=True)
        ]
        means = [float(np.average(x, weights=w)) for x, w in zip(logs, weights, strict=True)]
        squares = (w @ (x - m) ** 2 for x, w, m in zip(logs, weights, means, strict=True))
        variance = float(sum(squares)) / (_NORMAL * freedom)
    scatter = sqrt(variance)
    far = tuple(_far(x, scatter) for x in logs)
    return Repeats(tuple(np.exp(means).tolist()), scatter, freedom, far)


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
    groups: list[list[Cycle]] = []
    for same in same_temperatures(cycles):
        slowest = None
        for cycle in sorted(same, key=lambda cycle: cycle.speed.value):
            if slowest is None or cycle.speed.value > (1 + SAME) * slowest:
                slowest = cycle.speed.value
                groups.append([])
            groups[-1].append(cycle)
    return groups


_LEAST = 3  # speeds; two leave no residual


@dataclass(frozen=True, eq=False)
class Repeated:
    """Tests at one temperature and speed.

    Parameters
    ----------
    cycles : tuple of Cycle
        The tests.
    far : tuple of Cycle
        Those far from the others.
    weighted_mean : float
        Mean pull-off force with Student weights, used by identifications [N].
    shift : float or None
        a_T of the temperature; None without a shift law.
    """

    cycles: tuple[Cycle, ...]
    far: tuple[Cycle, ...]
    weighted_mean: float
    shift: float | None = None

    @property
    def temperature(self) -> float | None:
        """Mean temperature [K]; None if unknown."""
        return temperature_of(self.cycles)

    @property
    def shifted_speed(self) -> float | None:
        """Speed with the same force at the reference temperature, a_T v [m/s]."""
        return None if self.shift is None else self.shift * self.speed

    @property
    def speed(self) -> float:
        """Mean of the true speeds [m/s]."""
        return float(np.mean([one.speed.value for one in self.cycles]))

    @property
    def force(self) -> float:
        """Mean pull-off force, positive [N]."""
        return float(np.mean([one.pull_off_force.value for one in self.cycles]))

    @property
    def force_deviation(self) -> float | None:
        """Standard deviation of the pull-off forces [N]; None for a single test."""
        forces = [one.pull_off_force.value for one in self.cycles]
        return float(np.std(forces, ddof=1)) if len(forces) > 1 else None

    @property
    def work(self) -> float:
        """Mean work of separation [J]."""
        return float(np.mean([one.work_of_separation.value for one in self.cycles]))

    @property
    def work_deviation(self) -> float | None:
        """Standard deviation of the works of separation [J]; None for a single test."""
        works = [one.work_of_separation.value for one in self.cycles]
        return float(np.std(works, ddof=1)) if len(works) > 1 else None


@dataclass(frozen=True, eq=False)
class SpeedTable:
    """Repeated tests by temperature and speed.

    Parameters
    ----------
    series : tuple of tuple of Repeated
        Tests at each temperature, the coldest first, by speed, the slowest first.
    scatter : float or None
        Relative standard deviation of single pull-off forces, pooled over speeds; None without
        repeats.
    freedom : int
        Degrees of freedom of the scatter.
    exponents : tuple of (float or None, Measured)
        Temperature [K], if known, and exponent of pull-off force by speed with its standard error,
        of each temperature with three or more speeds.
    master : Measured or None
        Exponent of the force by a_T v over all temperatures; None without a shift law.
    """

    series: tuple[tuple[Repeated, ...], ...]
    scatter: float | None
    freedom: int
    exponents: tuple[tuple[float | None, Measured], ...]
    master: Measured | None = None

    @property
    def speeds(self) -> tuple[Repeated, ...]:
        """Tests at all temperatures and speeds."""
        return tuple(one for same in self.series for one in same)

    @property
    def exponent(self) -> Measured | None:
        """Exponent of a series at one temperature; None for several, or fewer than 3 speeds."""
        single = len(self.series) == 1 and self.exponents
        return self.exponents[0][1] if single else None


def speed_table(cycles: Sequence[Cycle], shift: Shift | None = None) -> SpeedTable:
    """Return the statistics of cycles by temperature and speed; speeds within 3 % are equal.

    Raises
    ------
    ValueError
        If there is a shift law, and a temperature is unknown or outside its range.
    """
    groups = [same_speeds(same) for same in same_temperatures(cycles)]
    tests = [same for group in groups for same in group]
    found = pooled([[one.pull_off_force.value for one in same] for same in tests])
    speeds = []
    for same, far, mean in zip(tests, found.far, found.means, strict=True):
        factor = None
        if shift is not None:
            temperature = temperature_of(same)
            if temperature is None:
                unknown = f"the temperature of {same[0].source.path} is unknown, for a shift"
                raise InputError(f"{unknown}; write it there, or set `temperature_in_name`")
            factor = 10.0 ** float(shift.log10_shift(temperature))
        speeds.append(Repeated(tuple(same), tuple(same[i] for i in far), mean, factor))
    rest = iter(speeds)
    series = tuple(tuple(islice(rest, len(group))) for group in groups)
    fitted = [(same[0].temperature, _exponent([x.speed for x in same], same)) for same in series]
    moved = [one.shifted_speed for one in speeds if one.shifted_speed is not None]
    return SpeedTable(
        series,
        found.scatter if found.freedom else None,
        found.freedom,
        tuple((at, one) for at, one in fitted if one is not None),
        None if shift is None else _exponent(moved, speeds),
    )


def jkr_work(force: float, radius: float) -> float:
    r"""Return the work of adhesion :math:`2F/(3\pi R)` [J/m2] of an elastic JKR sphere.

    Of a viscoelastic sphere it is an apparent work that grows with speed.

    Examples
    --------
    >>> f"{jkr_work(4.31e-3, 5.19e-3):.4f} J/m2"
    '0.1762 J/m2'
    """
    return force / float(jkr.pull_off_force(radius=radius, work_of_adhesion=1.0))


def _exponent(speeds: Sequence[float], tests: Sequence[Repeated]) -> Measured | None:
    """Return the slope of ln(mean force) over ln(speed), and its standard error."""
    if len(speeds) < _LEAST or min(speeds) <= 0:
        return None
    x = np.log(speeds)
    y = np.log([one.weighted_mean for one in tests])
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    rest = y - slope * x
    return Measured(slope, float(np.sqrt(rest @ rest / (len(speeds) - 2) / (x @ x))))
