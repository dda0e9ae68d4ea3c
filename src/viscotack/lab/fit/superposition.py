"""Test of superposition that weights all points equally.

A best shift always exists; whether the shifted sweeps form one curve is a separate question. No
outlier is down-weighted here, and both moduli have equal weights.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import FrequencySweeps, ShiftTable

from .master_curve import shifted_by
from .overlap import Curve
from .shift_factors import BEST, FEWEST, level_curves, steps_between, temperature_levels

_APART = 0.1  # decades; larger differences contradict each other
_SIGMAS = 3.0
_POINTS = 3  # smallest number of points of each sweep in the overlap for a comparison


@dataclass(frozen=True)
class Neighbours:
    """Two sweeps neighbouring in temperature, after shifting.

    Attributes
    ----------
    temperatures : (float, float)
        [K], colder first.
    deviation : tuple of float
        Root mean square of ln(modulus) about one smooth curve through both sweeps in the overlap,
        of storage and of loss modulus, with equal weights; nan where too few points overlap.
    own : tuple of float
        The same about a separate smooth curve for each sweep.
    shift, asked : float
        log10 a_T from the hotter to the colder sweep: as used, and as fitted to both moduli; nan
        where they do not determine it.
    doubt : float
        Standard deviation of `asked`.
    """

    temperatures: tuple[float, float]
    deviation: tuple[float, ...]
    own: tuple[float, ...]
    shift: float
    asked: float
    doubt: float


@dataclass(frozen=True)
class Superposition:
    """Result of the test whether shifted sweeps form one curve, see :func:`superposition`.

    Attributes
    ----------
    neighbours : tuple of Neighbours
        Every pair of sweeps neighbouring in temperature.
    tolerance : float
        Relative deviation above which two sweeps do not superpose.
    """

    neighbours: tuple[Neighbours, ...]
    tolerance: float

    @property
    def holds(self) -> bool:
        """Whether nothing contradicts superposition."""
        return not self.words()

    def words(self) -> tuple[str, ...]:
        """Return the contradictions to superposition as sentences; empty if there are none."""
        found = []
        for i, name in enumerate(("storage", "loss")):
            least = np.log1p(self.tolerance)
            # two noisy sweeps may still superpose
            off = [x for x in self.neighbours if x.deviation[i] > max(least, 2 * x.own[i])]
            if off:
                worst = max(off, key=lambda each: each.deviation[i])
                found.append(
                    f"sweeps do not superpose in {name}: {_between(worst)} differ by "
                    f"{100 * np.expm1(worst.deviation[i]):.2g} % where they overlap ({len(off)} "
                    "such pairs): moduli that move with temperature (--vertical), a glass, two "
                    "processes or a faulty sweep (--leave-out)"
                )
        limits = ((x, max(_APART, _SIGMAS * x.doubt)) for x in self.neighbours)
        off = [x for x, limit in limits if abs(x.shift - x.asked) > limit]
        if off:
            worst = max(off, key=lambda each: abs(each.shift - each.asked))
            found.append(
                f"storage and loss modulus give other shifts than those used: {_between(worst)} "
                f"are shifted by {worst.shift:.2f} decades, not {worst.asked:.2f} +- "
                f"{worst.doubt:.2f} ({len(off)} such steps)"
            )
        return tuple(found)


def superposition(
    sweeps: FrequencySweeps, shifts: ShiftTable, *, tolerance: float = 0.1
) -> Superposition:
    """Compare shifted sweeps where they overlap.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Measured sweeps, at two or more temperatures.
    shifts : ShiftTable
        Shifts to test, from any method; interpolated between the rows of the table.
    tolerance : float
        Relative deviation from one curve above which sweeps do not superpose, in (0, 1).

    Returns
    -------
    Superposition
        Deviations of all neighbouring sweeps, and contradictions in words.

    Raises
    ------
    ValueError
        If the table does not cover all temperatures of the sweeps.

    Examples
    --------
    >>> omega = np.geomspace(1, 100, 10)
    >>> sweeps = FrequencySweeps(
    ...     np.repeat([293.15, 303.15], 10),
    ...     np.tile(omega, 2),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     "E",
    ...     np.repeat([0, 1], 10),
    ... )
    >>> superposition(sweeps, ShiftTable([293.15, 303.15], [0.0, -1.0], None)).holds
    True
    """
    if not 0 < tolerance < 1:
        raise InputError(f"tolerance must lie between 0 and 1, got {tolerance!r}")
    levels = temperature_levels(sweeps)
    temperature = np.array([float(np.mean(level.temperature)) for level in levels])
    along, up, _ = shifted_by(shifts, temperature, temperature, float(shifts.temperature[0]))
    shapely = [i for i, level in enumerate(levels) if len(level) >= FEWEST]
    curves = level_curves([levels[i] for i in shapely])
    asked = _asked(temperature[shapely], curves)
    found = []
    for (a, b), (i, j), (other, doubt) in zip(
        pairwise(curves), pairwise(shapely), asked, strict=True
    ):
        step = float(along[j] - along[i])
        moved = Curve(b.x + step, tuple(y + up[j] - up[i] for y in b.y))
        deviation, own = _deviations(a, moved)
        between = float(temperature[i]), float(temperature[j])
        found.append(Neighbours(between, deviation, own, step, other, doubt))
    return Superposition(tuple(found), tolerance)


def _asked(temperature: Array, curves: list[Curve]) -> list[tuple[float, float]]:
    """Return the shift fitted to both moduli and its standard deviation, for each pair."""
    try:
        steps = steps_between(temperature, curves, *BEST)
    except ValueError:
        return [(np.nan, np.nan)] * (len(curves) - 1)
    return [(step.shift, float(np.hypot(np.sqrt(step.variance), step.common))) for step in steps]


def _deviations(a: Curve, b: Curve) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the scatter of each modulus about a common curve and about separate curves."""
    low, high = max(a.x[0], b.x[0]) - 1e-9, min(a.x[-1], b.x[-1]) + 1e-9
    one, other = (c.chosen((c.x >= low) & (c.x <= high)) for c in (a, b))
    if min(one.x.size, other.x.size) < _POINTS:
        return (np.nan, np.nan), (np.nan, np.nan)
    x = np.concatenate((one.x, other.x))
    common, own = [], []
    for ya, yb in zip(one.y, other.y, strict=True):
        common.append(_scatter(x, np.concatenate((ya, yb))))
        own.append(float(np.hypot(_scatter(one.x, ya), _scatter(other.x, yb)) / np.sqrt(2)))
    return tuple(common), tuple(own)


def _scatter(x: Array, y: Array) -> float:
    """Return the scatter of ln(y) about the polynomial with the smallest one."""
    left = []
    # a temperature measured twice repeats its frequencies
    for degree in range(max(min(5, np.unique(np.round(x, 3)).size - 2), 0) + 1):
        residual = y - Chebyshev.fit(x, y, degree)(x)
        left.append(float(np.sum(residual**2)) / (x.size - degree - 1))
    return float(np.log(10) * np.sqrt(min(left)))


def _between(each: Neighbours) -> str:
    colder, hotter = each.temperatures
    return f"those at {colder - 273.15:.4g} and {hotter - 273.15:.4g} C"
