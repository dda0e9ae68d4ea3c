r"""Statistics of pull-offs by speed, as laboratories report them.

For each speed: number of tests, mean and standard deviation. For the series: scatter of single
tests pooled over speeds (:mod:`.repeats`), and the exponent of a power law of force by speed,

.. math:: \ln F = n \ln v + c ,

fitted by least squares to the means, with the standard error of its residuals. A rate-independent
contact has n = 0. The power law describes data; it is no model of the contact.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.lab.tack import Cycle, Measured
from viscotack.theory.elastic import jkr

from .pull_off import same_speeds
from .repeats import pooled

_LEAST = 3  # speeds; two leave no residual


@dataclass(frozen=True, eq=False)
class Repeated:
    """Tests at one speed.

    Parameters
    ----------
    cycles : tuple of Cycle
        The tests.
    far : tuple of Cycle
        Those far from the others.
    weighted_mean : float
        Mean pull-off force with Student weights, used by identifications [N].
    """

    cycles: tuple[Cycle, ...]
    far: tuple[Cycle, ...]
    weighted_mean: float

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


@dataclass(frozen=True, eq=False)
class SpeedTable:
    """Repeated tests by speed.

    Parameters
    ----------
    speeds : tuple of Repeated
        Slowest first.
    scatter : float or None
        Relative standard deviation of single pull-off forces, pooled over speeds; None without
        repeats.
    freedom : int
        Degrees of freedom of the scatter.
    exponent : Measured or None
        Of pull-off force by speed, with its standard error; None with fewer than three speeds.
    """

    speeds: tuple[Repeated, ...]
    scatter: float | None
    freedom: int
    exponent: Measured | None


def speed_table(cycles: Sequence[Cycle]) -> SpeedTable:
    """Return the statistics of cycles by speed; speeds within 3 % are equal."""
    groups = same_speeds(cycles)
    found = pooled([[one.pull_off_force.value for one in same] for same in groups])
    speeds = tuple(
        Repeated(tuple(same), tuple(same[i] for i in far), mean)
        for same, far, mean in zip(groups, found.far, found.means, strict=True)
    )
    return SpeedTable(
        speeds, found.scatter if found.freedom else None, found.freedom, _exponent(speeds)
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


def _deviation(values: Sequence[float]) -> float | None:
    return float(np.std(values, ddof=1)) if len(values) > 1 else None


def _exponent(speeds: Sequence[Repeated]) -> Measured | None:
    """Return the slope of ln(mean force) over ln(speed), and its standard error."""
    if len(speeds) < _LEAST or speeds[0].speed <= 0:
        return None
    x = np.log([one.speed for one in speeds])
    y = np.log([one.weighted_mean for one in speeds])
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    rest = y - slope * x
    return Measured(slope, float(np.sqrt(rest @ rest / (len(speeds) - 2) / (x @ x))))
