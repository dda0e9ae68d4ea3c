r"""Shift factors from the overlap of neighbouring sweeps.

Two neighbours in temperature are two noisy pieces of one smooth curve, displaced along the
logarithm of frequency:

.. math:: y_a = p(x_a) + \epsilon, \quad y_b + v = p(x_b + s) + \epsilon

for y = log10 of a modulus and x = log10 of frequency. The polynomial p, the shift s and, if asked
for, the vertical shift v are fitted together. The scatter has heavy tails (Student's t), because
the first point of a sweep often lags behind its temperature; with two moduli each has a scatter of
its own, so that the one that superposes better counts more.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from viscotack.errors import InputError
from viscotack.materials.shift import TabulatedShift

from .grouping import GAP
from .sweeps import FrequencySweeps, ShiftTable

Array = npt.NDArray[np.float64]

FEWEST = 4  # points of one temperature; fewer carry no shape
MODULI = {"storage": ("storage",), "loss": ("loss",), "both": ("storage", "loss")}
_DEGREES = range(1, 6)
_FREEDOM = 4.0  # degrees of freedom of Student's t
_FINEST = 1e-4  # decades: scatter below which two curves are the same
_ROUNDS = 10  # of reweighting
_COARSE = 0.1  # decades between the shifts that are tried first
_FINE = (0.01, 0.001)  # and then, about the best


@dataclass(frozen=True)
class Step:
    """How far one curve must move to continue its neighbour, in decades."""

    shift: float
    vertical: float
    variance: float  # of the shift


@dataclass(frozen=True)
class Curve:
    """One temperature: log10 of frequency, ascending, and log10 of one or two moduli."""

    x: Array
    y: tuple[Array, ...]


def shift_factors(
    sweeps: FrequencySweeps,
    *,
    reference_temperature: float,
    by: str = "storage",
    vertical: bool = False,
) -> ShiftTable:
    """Return the shift of each temperature, found from the overlap of its neighbours.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Two or more temperatures, each with four or more frequencies.
    reference_temperature : float
        T0 [K], within the temperatures of the sweeps. Between two of them the shift is
        interpolated, and the table has no row with a shift of zero.
    by : {"storage", "loss", "both"}
        The modulus that must superpose. The loss modulus says more where storage is flat, and
        is spoilt more easily by the instrument.
    vertical : bool
        Whether the moduli may move as well, by one factor for storage and loss.

    Returns
    -------
    ShiftTable
        With the standard deviation of each shift relative to the reference, from the scatter of
        the points about the common curve. It grows with the number of steps from the reference,
        and does not know of systematic errors such as a solid that does not superpose.

    Raises
    ------
    ValueError
        If there are fewer than two temperatures, one of them has too few points, two neighbours
        do not overlap, or the reference lies outside.

    Notes
    -----
    Points within 1 K are one temperature, their mean.
    """
    if by not in MODULI:
        raise InputError(f"by must be 'storage', 'loss' or 'both', got {by!r}")
    levels = temperature_levels(sweeps)
    temperature = np.array([float(np.mean(level.temperature)) for level in levels])
    if len(levels) < 2:
        raise InputError(
            "a shift needs sweeps at two or more temperatures, got one; give shift=WLF(...)"
        )
    if not temperature[0] - GAP <= reference_temperature <= temperature[-1] + GAP:
        raise InputError(
            f"reference_temperature must lie between {temperature[0]:.2f} and "
            f"{temperature[-1]:.2f} K, got {reference_temperature:g} K; give shift=WLF(...) to go "
            "beyond"
        )
    curves = [curve(level, by) for level in levels]
    steps = []
    for i, (colder, hotter) in enumerate(pairwise(curves)):
        try:
            steps.append(step_between(colder, hotter, vertical=vertical))
        except ValueError as error:
            raise InputError(
                f"sweeps at {temperature[i]:.2f} and {temperature[i + 1]:.2f} K: {error}"
            ) from None
    shift, vertical_shift, deviation = _summed(steps, temperature, reference_temperature)
    return ShiftTable(temperature, shift, deviation, vertical_shift if vertical else None)


def step_between(colder: Curve, hotter: Curve, *, vertical: bool) -> Step:
    """Return how far the hotter curve must move along log10 of frequency to continue the colder.

    Raises
    ------
    ValueError
        If the curves fit best end to end, so that the data do not fix the shift.
    """
    low, high = _range(colder, hotter)
    tried = np.linspace(low, high, max(5, int((high - low) / _COARSE) + 1))
    costs = np.stack([_costs(_pair(colder, hotter, tried, vertical, d)) for d in _DEGREES])
    degree, best = np.unravel_index(int(np.argmin(costs)), costs.shape)
    if best in (0, tried.size - 1):
        raise InputError(
            "the curves fit best end to end, so the data do not fix the shift; measure closer "
            "temperatures, superpose by another modulus, or give shift=WLF(...)"
        )
    found = tried[best]
    for spacing in _FINE:
        tried = found + spacing * np.arange(-10, 11)
        costs = _costs(_pair(colder, hotter, tried, vertical, _DEGREES[degree]))
        found = tried[int(np.argmin(costs))]
    pair = _pair(colder, hotter, np.array([found]), vertical, _DEGREES[degree])
    return Step(float(found), *_read(pair, vertical))


def _range(a: Curve, b: Curve) -> tuple[float, float]:
    """Return the shifts at which two points, and a fifth of the shorter curve, overlap."""
    length = min(np.ptp(a.x), np.ptp(b.x))
    least = length * max(0.2, 1 / (min(a.x.size, b.x.size) - 1)) + 1e-9
    return a.x[0] + least - b.x[-1], a.x[-1] - least - b.x[0]


@dataclass(frozen=True)
class _Pair:
    """Two curves at many shifts as one linear problem; see :func:`_pair`."""

    design: Array  # (shifts, moduli * points, unknowns)
    y: Array  # (moduli * points,)
    slope: Array  # (shifts, moduli * points, unknowns): of the moved points, per decade
    moduli: int


def _pair(a: Curve, b: Curve, shifts: Array, vertical: bool, degree: int) -> _Pair:
    """Return polynomials side by side, one for each modulus, then the vertical shift of all."""
    moduli, n, tries = len(a.y), a.x.size + b.x.size, shifts.size
    x = np.concatenate((np.broadcast_to(a.x, (tries, a.x.size)), b.x + shifts[:, None]), axis=1)
    half = np.ptp(x, axis=1)[:, None, None] / 2
    basis = chebyshev.chebvander((x - x.min(axis=1, keepdims=True)) / half[..., 0] - 1, degree)
    derivative = basis[..., :-1] @ chebyshev.chebder(np.eye(degree + 1)) / half
    moved = np.concatenate((np.zeros(a.x.size), np.ones(b.x.size)))
    design = np.zeros((tries, moduli * n, moduli * (degree + 1) + vertical))
    slope = np.zeros_like(design)
    for m in range(moduli):
        rows, columns = slice(m * n, (m + 1) * n), slice(m * (degree + 1), (m + 1) * (degree + 1))
        design[:, rows, columns] = basis
        slope[:, rows, columns] = derivative * moved[:, None]
        if vertical:
            design[:, rows, -1] = -moved
    y = np.concatenate([np.concatenate(pair) for pair in zip(a.y, b.y, strict=True)])
    return _Pair(design, y, slope, moduli)


def _solved(pair: _Pair) -> tuple[Array, Array, Array]:
    """Return unknowns, residuals and squared scatter at each shift, by reweighting."""
    design, points = pair.design, pair.y.size // pair.moduli
    weight = tail = np.ones(design.shape[:2])
    found = residual = scatter = np.zeros(0)
    for _ in range(_ROUNDS):
        weighted = np.swapaxes(design * weight[..., None], 1, 2)
        normal = weighted @ design
        # a vertical shift that the data do not fix must not stop the rest
        normal += 1e-12 * np.trace(normal, axis1=1, axis2=2)[:, None, None] * np.eye(len(normal[0]))
        found = np.linalg.solve(normal, weighted @ pair.y[:, None])
        residual = pair.y - (design @ found)[..., 0]
        squares = (tail * residual**2).reshape(-1, pair.moduli, points)
        scatter = np.repeat(np.mean(squares, axis=2) + _FINEST**2, points, axis=1)
        tail = (_FREEDOM + 1) / (_FREEDOM + residual**2 / scatter)
        weight = tail / scatter
    return found, residual, scatter


def _costs(pair: _Pair) -> Array:
    """Return minus twice the log likelihood at each shift, with Schwarz's penalty."""
    if pair.design.shape[2] > pair.y.size - 3 * pair.moduli:
        return np.full(len(pair.design), np.inf)  # too few points for the degree
    _, residual, scatter = _solved(pair)
    cost = np.log(scatter) + (_FREEDOM + 1) * np.log1p(residual**2 / (_FREEDOM * scatter))
    return np.sum(cost, axis=1) + pair.design.shape[2] * np.log(pair.y.size)


def _read(pair: _Pair, vertical: bool) -> tuple[float, float]:
    """Return the vertical shift and the variance of the shift, where one shift is tried."""
    found, _, scatter = _solved(pair)
    # Fisher's information on the shift, without what the other unknowns can imitate
    tangent = (pair.slope[0] @ found[0])[:, 0] / np.sqrt(scatter[0])
    basis = np.linalg.qr(pair.design[0] / np.sqrt(scatter[0])[:, None])[0]
    tangent -= basis @ (basis.T @ tangent)
    unknowns = pair.design.shape[2] + 1
    efficiency = (_FREEDOM + 1) / (_FREEDOM + 3) * (1 - unknowns / pair.y.size)
    variance = 1 / max(efficiency * float(tangent @ tangent), 1e-12)
    return float(found[0, -1, 0]) if vertical else 0.0, variance


def _summed(
    steps: Sequence[Step], temperature: Array, reference: float
) -> tuple[Array, Array, Array]:
    """Return shifts, vertical shifts and standard deviations relative to the reference."""
    columns = np.array([[s.shift, s.vertical, s.variance] for s in steps])
    sums = np.vstack((np.zeros(3), np.cumsum(columns, axis=0)))
    inside = float(np.clip(reference, temperature[0], temperature[-1]))
    at = [
        np.interp(inside, temperature, sums[:, 2])
        if i == 2
        else TabulatedShift(inside, tuple(temperature), tuple(sums[:, i])).log10_shift(temperature)
        for i in range(3)
    ]
    return np.asarray(at[0]), np.asarray(at[1]), np.sqrt(np.abs(sums[:, 2] - at[2]))


def temperature_levels(sweeps: FrequencySweeps) -> list[FrequencySweeps]:
    """Return the points of each temperature, from cold to hot."""
    if np.any(np.isnan(sweeps.temperature)):
        raise InputError("the temperature of some points is not known; give read_dma temperature=")
    order = np.argsort(sweeps.temperature, kind="stable")
    breaks = np.flatnonzero(np.diff(sweeps.temperature[order]) > GAP) + 1
    return [sweeps.chosen(points) for points in np.split(order, breaks)]


def curve(level: FrequencySweeps, by: str) -> Curve:
    """Return one temperature as a curve in decades."""
    order = np.argsort(level.angular_frequency, kind="stable")
    x = np.log10(level.angular_frequency[order])
    if x.size < FEWEST or np.ptp(x) < 0.1:
        raise InputError(
            f"{x.size} points at {np.mean(level.temperature):.2f} K, over "
            f"{np.ptp(x):.1g} decades of frequency: too few to find a shift from overlap; "
            "give shift=WLF(...) or leave them out"
        )
    return Curve(x, tuple(np.log10(getattr(level, name)[order]) for name in MODULI[by]))
