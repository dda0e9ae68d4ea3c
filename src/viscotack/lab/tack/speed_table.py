r"""Statistics of pull-offs by temperature and speed, as laboratories report them.

For each speed: number of tests, mean and standard deviation. For the series: scatter of single
tests pooled over speeds (:mod:`.repeats`), and for each temperature the exponent of a power law of
force by speed,

.. math:: \ln F = n \ln v + c ,

fitted by least squares to the means, with the standard error of its residuals. A rate-independent
contact has n = 0. The power law describes data; it is no model of the contact.

With a shift law, a test at speed v and temperature T is referred to the reference temperature: the
times of the solid are a_T times those there, so that the same force is reached at the speed a_T v
(master curve), if the interface does not depend on temperature.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.shift import Shift
from viscotack.theory.elastic import jkr

from .cycle import Cycle, Measured
from .repeats import pooled, same_speeds, same_temperatures, temperature_of

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
        return _deviation([one.pull_off_force.value for one in self.cycles])

    @property
    def work(self) -> float:
        """Mean work of separation [J]."""
        return float(np.mean([one.work_of_separation.value for one in self.cycles]))

    @property
    def work_deviation(self) -> float | None:
        """Standard deviation of the works of separation [J]; None for a single test."""
        return _deviation([one.work_of_separation.value for one in self.cycles])


@dataclass(frozen=True)
class Exponent:
    """Exponent of pull-off force by speed.

    Parameters
    ----------
    temperature : float or None
        Temperature of the tests [K]; None if unknown.
    exponent : Measured
        With its standard error.
    """

    temperature: float | None
    exponent: Measured


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
    exponents : tuple of Exponent
        Of each temperature with three or more speeds.
    master : Measured or None
        Exponent of the force by a_T v over all temperatures; None without a shift law.
    """

    series: tuple[tuple[Repeated, ...], ...]
    scatter: float | None
    freedom: int
    exponents: tuple[Exponent, ...]
    master: Measured | None = None

    @property
    def speeds(self) -> tuple[Repeated, ...]:
        """Tests at all temperatures and speeds."""
        return tuple(one for same in self.series for one in same)

    @property
    def exponent(self) -> Measured | None:
        """Exponent of a series at one temperature; None for several, or fewer than 3 speeds."""
        single = len(self.series) == 1 and self.exponents
        return self.exponents[0].exponent if single else None


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
    speeds = [
        Repeated(tuple(same), tuple(same[i] for i in far), mean, _factor(same, shift))
        for same, far, mean in zip(tests, found.far, found.means, strict=True)
    ]
    rest = iter(speeds)
    series = tuple(tuple(islice(rest, len(group))) for group in groups)
    fitted = [(same[0].temperature, _exponent([x.speed for x in same], same)) for same in series]
    moved = [one.shifted_speed for one in speeds if one.shifted_speed is not None]
    return SpeedTable(
        series,
        found.scatter if found.freedom else None,
        found.freedom,
        tuple(Exponent(at, one) for at, one in fitted if one is not None),
        None if shift is None else _exponent(moved, speeds),
    )


def _factor(same: Sequence[Cycle], shift: Shift | None) -> float | None:
    """Return a_T of tests at one temperature; None without a shift law."""
    if shift is None:
        return None
    temperature = temperature_of(same)
    if temperature is None:
        raise InputError(
            f"the temperature of {same[0].source.path} is unknown, so that its speed cannot be "
            "shifted; write it into the file or, with --temperature-in-name, into the file name"
        )
    return 10.0 ** float(shift.log10_shift(temperature))


def jkr_work(force: float, radius: float) -> float:
    r"""Return the work of adhesion :math:`2F/(3\pi R)` [J/m2] of an elastic JKR sphere.

    Of a viscoelastic sphere it is an apparent work that grows with speed.

    Examples
    --------
    >>> f"{jkr_work(4.31e-3, 5.19e-3):.4f} J/m2"
    '0.1762 J/m2'
    """
    return force / float(jkr.pull_off_force(radius=radius, work_of_adhesion=1.0))


def _deviation(values: Sequence[float]) -> float | None:
    return float(np.std(values, ddof=1)) if len(values) > 1 else None


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
