r"""Shift factors from overlap: displacement between curves at neighbouring temperatures.

Two neighbours are noisy pieces of one smooth curve, displaced along the logarithm of
frequency, and possibly along that of the modulus:

.. math:: y_a = p(x_a) + \epsilon, \quad y_b + v = p(x_b + s) + \epsilon

for y = log10 of a modulus and x = log10 of frequency. The polynomial p, the shift s and the
vertical shift v are fitted together. The scatter is heavy-tailed (Student's t), because the first
point of a sweep is often measured before the temperature is uniform. With two moduli, each has a
scatter of its own, so that the one that superposes better has a larger weight.

Prior knowledge of v is one more observation of it, :class:`Hold`. Where the curves are straight, v
and s are interchangeable, and v depends on this observation alone; where the moduli are curved, it
hardly matters.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError

LAW = "give a shift law by `glass_transition`, `wlf` or `shift_file`"
_DEGREES = range(1, 7)
_FREEDOM = 4.0  # degrees of freedom of Student's t
_FINEST = 1e-4  # decades: scatter below which two curves are the same
_ROUNDS = 8  # of reweighting
_FEW = 4  # during the coarse search
_COARSE = 0.1  # decades between shifts of the coarse search
_FINE = (0.025, 0.005, 0.001)  # decades, of successive refinements
_ROUGH = (0.03, 0.008)  # decades, of refinements for a difference
_BLOCKS = 4  # jackknife blocks of the overlap


@dataclass(frozen=True)
class Hold:
    """Prior knowledge of a vertical shift: log10 of the factor on the hotter modulus.

    Attributes
    ----------
    expected : float
        Expected value [decades].
    spread : float
        Standard deviation [decades]: 0 if given, inf if unknown.
    moves : bool
        Whether the fit may adjust it. If not, its spread still widens the uncertainty of the shift.
    """

    expected: float = 0.0
    spread: float = 0.0
    moves: bool = True

    @property
    def free(self) -> bool:
        """Whether the fit adjusts the vertical shift."""
        return self.moves and self.spread > 0


@dataclass(frozen=True)
class Step:
    """Displacement between two neighbouring curves, in decades, with its uncertainty."""

    shift: float
    vertical: float
    variance: float  # of the shift, without the common part
    common: float  # part of the standard deviation that may have the same sign in all steps


@dataclass(frozen=True)
class Curve:
    """Data of one temperature: log10 of frequency, ascending, and log10 of one or two moduli."""

    x: Array
    y: tuple[Array, ...]

    def chosen(self, points: npt.NDArray[np.bool_]) -> "Curve":
        """Select points."""
        return Curve(self.x[points], tuple(y[points] for y in self.y))

    def moved(self, along: float, up: float) -> "Curve":
        """Return the curve shifted by decades of frequency and of the moduli."""
        return Curve(self.x + along, tuple(y + up for y in self.y))


def step_between(colder: Curve, hotter: Curve, hold: Hold) -> Step:
    """Fit the displacement of the hotter curve along log10 of frequency to its colder neighbour.

    The variance is the larger of the Fisher variance of the scatter and of a jackknife over blocks
    of the overlap, which detects correlated errors of neighbouring points; the change of the shift
    with a polynomial of the next degree is added. The effect of an undetermined vertical shift
    within its spread is returned separately, because its causes continue with temperature, so that
    it adds up from step to step.

    Raises
    ------
    ValueError
        If the curves fit best end to end, so that the data do not determine the shift.
    """
    hotter = hotter.moved(0.0, hold.expected)
    found, degree = _found(colder, hotter, hold)
    pair = _pair(colder, hotter, np.array([found]), hold, hold.spread > 0, degree)
    variance, _, both = _variances(pair)
    # an undetermined vertical shift may have the same sign in all steps
    leaning = (both / hold.spread) ** 2 if hold.spread > 0 else 0.0
    richer = _refined(colder, hotter, found, hold, degree + 1)
    others = _without_blocks(colder, hotter, found, hold, degree)
    jackknife = (_BLOCKS - 1) / _BLOCKS * float(np.sum((others - np.mean(others)) ** 2))
    # a movable vertical shift is the last unknown of the pair
    vertical = float(_solved(pair)[0][0, -1, 0]) if hold.free else 0.0
    return Step(
        found,
        hold.expected + vertical,
        max(variance - leaning, jackknife) + (richer - found) ** 2,
        float(np.sqrt(leaning)),
    )


def free_vertical(colder: Curve, hotter: Curve) -> tuple[float, float]:
    """Return the vertical shift fitted without prior knowledge, and its variance.

    Raises
    ------
    ValueError
        As :func:`step_between`.
    """
    hold = Hold(0.0, np.inf)
    found, degree = _found(colder, hotter, hold)
    pair = _pair(colder, hotter, np.array([found]), hold, True, degree)
    return float(_solved(pair)[0][0, -1, 0]), _variances(pair)[1]


def _found(colder: Curve, hotter: Curve, hold: Hold) -> tuple[float, int]:
    """Return the best shift and the degree of the common polynomial."""
    # two points, and a fifth of the shorter curve, overlap at least
    length = min(np.ptp(colder.x), np.ptp(hotter.x))
    least = length * max(0.2, 1 / (min(colder.x.size, hotter.x.size) - 1)) + 1e-9
    low, high = colder.x[0] + least - hotter.x[-1], colder.x[-1] - least - hotter.x[0]
    tried = np.linspace(low, high, max(5, int((high - low) / _COARSE) + 1))
    costs = np.full((len(_DEGREES), tried.size), np.inf)
    for row, degree in enumerate(_DEGREES):
        costs[row] = _costs(_pair(colder, hotter, tried, hold, hold.free, degree), _FEW)
        if row > 2 and np.min(costs[row]) > np.min(costs[row - 1]) > np.min(costs[row - 2]):
            break  # higher degrees do not improve the criterion
    degree, best = np.unravel_index(int(np.argmin(costs)), costs.shape)
    if best in (0, tried.size - 1):
        unknown = "the curves fit best end to end, so the data do not determine the shift"
        raise InputError(f"{unknown}; set `shift_by`, or {LAW}")
    degree = _DEGREES[int(degree)]
    return _refined(colder, hotter, float(tried[best]), hold, degree), degree


def vertical_at(colder: Curve, hotter: Curve, shift: float, hold: Hold) -> float:
    """Return the best vertical shift at a known horizontal shift."""
    if not hold.free:
        return hold.expected
    hotter = hotter.moved(0.0, hold.expected)
    at = np.array([shift])
    pairs = [_pair(colder, hotter, at, hold, True, degree) for degree in _DEGREES]
    pair = min(pairs, key=lambda each: float(_costs(each, _ROUNDS)[0]))
    return hold.expected + float(_solved(pair)[0][0, -1, 0])


def _refined(
    a: Curve,
    b: Curve,
    found: float,
    hold: Hold,
    degree: int,
    spacings: tuple[float, ...] = _FINE,
) -> float:
    """Refine a shift found by the coarse search."""
    for spacing in spacings:
        tried = found + spacing * np.arange(-5.0, 6.0)
        costs = _costs(_pair(a, b, tried, hold, hold.free, degree), _ROUNDS)
        # too few points for this degree: not usable
        if not np.isfinite(costs).any():
            continue
        i = int(np.argmin(costs))
        found = float(tried[i])
        if 0 < i < tried.size - 1:
            # the minimum of a parabola through the lowest costs
            left, middle, right = costs[i - 1 : i + 2]
            bend = left - 2 * middle + right
            found += float(spacing * (left - right) / (2 * bend)) if bend > 0 else 0.0
    return found


def _without_blocks(a: Curve, b: Curve, found: float, hold: Hold, degree: int) -> Array:
    """Return the jackknife estimates of the shift, each without one block of the overlap."""
    low = max(a.x[0], b.x[0] + found) - 1e-9
    high = min(a.x[-1], b.x[-1] + found) + 1e-9
    edges = np.linspace(low, high, _BLOCKS + 1)
    shifts = []
    for start, end in pairwise(edges):
        one, other = (c.chosen((x < start) | (x >= end)) for c, x in ((a, a.x), (b, b.x + found)))
        # keep a block that contains a whole curve
        enough = min(one.x.size, other.x.size) >= 2
        shifts.append(_refined(one, other, found, hold, degree, _ROUGH) if enough else found)
    return np.array(shifts)


@dataclass(frozen=True)
class _Pair:
    """Linear least-squares problems of two curves at many shifts; see :func:`_pair`."""

    design: Array  # (shifts, moduli * points, unknowns)
    y: Array  # (moduli * points,)
    slope: Array  # (shifts, moduli * points, unknowns): of the moved points, per decade
    moduli: int
    precision: float  # inverse variance of the vertical shift (last unknown); 0 if free


def _pair(a: Curve, b: Curve, shifts: Array, hold: Hold, free: bool, degree: int) -> _Pair:
    """Set up the problem: one polynomial per modulus, then their common vertical shift."""
    moduli, n, tries = len(a.y), a.x.size + b.x.size, shifts.size
    x = np.concatenate((np.broadcast_to(a.x, (tries, a.x.size)), b.x + shifts[:, None]), axis=1)
    half = np.ptp(x, axis=1)[:, None, None] / 2
    basis = chebyshev.chebvander((x - x.min(axis=1, keepdims=True)) / half[..., 0] - 1, degree)
    derivative = basis[..., :-1] @ chebyshev.chebder(np.eye(degree + 1)) / half
    moved = np.concatenate((np.zeros(a.x.size), np.ones(b.x.size)))
    design = np.zeros((tries, moduli * n, moduli * (degree + 1) + free))
    slope = np.zeros_like(design)
    for m in range(moduli):
        rows, columns = slice(m * n, (m + 1) * n), slice(m * (degree + 1), (m + 1) * (degree + 1))
        design[:, rows, columns] = basis
        slope[:, rows, columns] = derivative * moved[:, None]
        if free:
            design[:, rows, -1] = -moved
    y = np.concatenate([np.concatenate(pair) for pair in zip(a.y, b.y, strict=True)])
    return _Pair(design, y, slope, moduli, hold.spread**-2 if free else 0.0)


def _solved(pair: _Pair, rounds: int = _ROUNDS) -> tuple[Array, Array, Array]:
    """Return unknowns, residuals and squared scatter at each shift, by iterative reweighting."""
    design, points = pair.design, pair.y.size // pair.moduli
    weight = tail = np.ones(design.shape[:2])
    found = residual = scatter = np.zeros(0)
    for _ in range(rounds):
        weighted = np.swapaxes(design * weight[..., None], 1, 2)
        normal = weighted @ design
        # a singular vertical shift must not stop the iteration
        normal += 1e-12 * np.trace(normal, axis1=1, axis2=2)[:, None, None] * np.eye(len(normal[0]))
        normal[:, -1, -1] += pair.precision
        found = np.linalg.solve(normal, weighted @ pair.y[:, None])
        residual = pair.y - (design @ found)[..., 0]
        squares = (tail * residual**2).reshape(-1, pair.moduli, points)
        scatter = np.repeat(np.mean(squares, axis=2) + _FINEST**2, points, axis=1)
        tail = (_FREEDOM + 1) / (_FREEDOM + residual**2 / scatter)
        weight = tail / scatter
    return found, residual, scatter


def _costs(pair: _Pair, rounds: int) -> Array:
    """Return minus twice the log-likelihood at each shift, plus Schwarz's penalty (BIC)."""
    if pair.design.shape[2] > pair.y.size - 3 * pair.moduli:
        return np.full(len(pair.design), np.inf)  # too few points for the degree
    found, residual, scatter = _solved(pair, rounds)
    cost = np.log(scatter) + (_FREEDOM + 1) * np.log1p(residual**2 / (_FREEDOM * scatter))
    held = pair.precision * found[:, -1, 0] ** 2
    return np.sum(cost, axis=1) + held + pair.design.shape[2] * np.log(pair.y.size)


def _variances(pair: _Pair) -> tuple[float, float, float]:
    """Return variances and covariance of the horizontal and the vertical shift, at one shift.

    They follow from the inverse of the Fisher information of all unknowns and the shift. A
    vertical shift held fixed by the fit counts as unknown here if it may differ from its expected
    value.
    """
    found, _, scatter = _solved(pair)
    tangent = (pair.slope[0] @ found[0])[:, 0]
    rows = np.column_stack((pair.design[0], tangent)) / np.sqrt(scatter[0])[:, None]
    unknowns = rows.shape[1]
    efficiency = (_FREEDOM + 1) / (_FREEDOM + 3) * (1 - unknowns / pair.y.size)
    information = max(efficiency, 1e-3) * rows.T @ rows
    information[-2, -2] += pair.precision
    information += 1e-12 * np.trace(information) * np.eye(unknowns)
    covariance = np.linalg.inv(information)
    return float(covariance[-1, -1]), float(covariance[-2, -2]), float(covariance[-1, -2])
