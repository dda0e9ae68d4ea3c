r"""How far one curve must move to continue its neighbour in temperature.

Two neighbours are two noisy pieces of one smooth curve, displaced along the logarithm of
frequency, and perhaps along that of the modulus:

.. math:: y_a = p(x_a) + \epsilon, \quad y_b + v = p(x_b + s) + \epsilon

for y = log10 of a modulus and x = log10 of frequency. The polynomial p, the shift s and the
vertical shift v are fitted together. The scatter has heavy tails (Student's t), because the first
point of a sweep often lags behind its temperature; with two moduli each has a scatter of its own,
so that the one that superposes better counts more.

What is known of v before enters as one more observation of it, :class:`Hold`. Where the curves
are straight, v and s can replace each other, and this observation is all there is; where loss and
storage bend, it does not matter.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError

_DEGREES = range(1, 7)
_FREEDOM = 4.0  # degrees of freedom of Student's t
_FINEST = 1e-4  # decades: scatter below which two curves are the same
_ROUNDS = 8  # of reweighting
_FEW = 4  # while shifts are compared roughly
_COARSE = 0.1  # decades between the shifts that are tried first
_FINE = (0.025, 0.005, 0.001)  # and then, about the best
_ROUGH = (0.03, 0.008)  # where only a difference is asked for
_BLOCKS = 4  # stretches of the overlap that are left out in turn


@dataclass(frozen=True)
class Hold:
    """What is known of a vertical shift before: log10 of the factor on the hotter modulus.

    Attributes
    ----------
    expected : float
        Its value [decades].
    spread : float
        Standard deviation [decades]: 0 where it is given, inf where nothing is known.
    moves : bool
        Whether the fit may move it. If not, its spread still widens the uncertainty of the shift.
    """

    expected: float = 0.0
    spread: float = 0.0
    moves: bool = True


@dataclass(frozen=True)
class Step:
    """How far one curve must move to continue its neighbour, in decades, and how sure that is."""

    shift: float
    vertical: float
    variance: float  # of the shift, apart from what is common
    common: float  # part of its standard deviation that every step may have with the same sign


@dataclass(frozen=True)
class Curve:
    """One temperature: log10 of frequency, ascending, and log10 of one or two moduli."""

    x: Array
    y: tuple[Array, ...]

    def chosen(self, points: npt.NDArray[np.bool_]) -> "Curve":
        """Return some of the points."""
        return Curve(self.x[points], tuple(y[points] for y in self.y))


def step_between(colder: Curve, hotter: Curve, hold: Hold) -> Step:
    """Return how far the hotter curve must move along log10 of frequency to continue the colder.

    The variance is the larger one of the scatter's (Fisher) and of a jackknife that leaves out
    stretches of the overlap, which sees neighbouring points that err alike; to it comes how far
    the next richer polynomial moves the shift. What a vertical shift within its spread could do
    is told apart, as far as the data do not fix it: such shifts have causes that run on with
    temperature, so that they add up from step to step.

    Raises
    ------
    ValueError
        If the curves fit best end to end, so that the data do not fix the shift.
    """
    hotter = Curve(hotter.x, tuple(y + hold.expected for y in hotter.y))
    free = hold.moves and hold.spread > 0
    found, degree = _found(colder, hotter, hold)
    pair = _pair(colder, hotter, np.array([found]), hold, hold.spread > 0, degree)
    variance, _, both = _variances(pair)
    # a vertical shift that the data leave open may run the same way in all steps
    leaning = (both / hold.spread) ** 2 if hold.spread > 0 else 0.0
    richer = _refined(colder, hotter, found, hold, degree + 1)
    others = _without_blocks(colder, hotter, found, hold, degree)
    jackknife = (_BLOCKS - 1) / _BLOCKS * float(np.sum((others - np.mean(others)) ** 2))
    # where it may move, the pair has it as its last unknown
    vertical = float(_solved(pair)[0][0, -1, 0]) if free else 0.0
    return Step(
        found,
        hold.expected + vertical,
        max(variance - leaning, jackknife) + (richer - found) ** 2,
        float(np.sqrt(leaning)),
    )


def free_vertical(colder: Curve, hotter: Curve) -> tuple[float, float]:
    """Return the vertical shift that the curves alone ask for, and its variance.

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
    free = hold.moves and hold.spread > 0
    low, high = _range(colder, hotter)
    tried = np.linspace(low, high, max(5, int((high - low) / _COARSE) + 1))
    costs = np.full((len(_DEGREES), tried.size), np.inf)
    for row, degree in enumerate(_DEGREES):
        costs[row] = _costs(_pair(colder, hotter, tried, hold, free, degree), _FEW)
        if row > 2 and np.min(costs[row]) > np.min(costs[row - 1]) > np.min(costs[row - 2]):
            break  # richer polynomials pay no longer
    degree, best = np.unravel_index(int(np.argmin(costs)), costs.shape)
    if best in (0, tried.size - 1):
        raise InputError(
            "the curves fit best end to end, so the data do not fix the shift; measure closer "
            "temperatures, superpose by another modulus (--shift-by), or give a law of shift "
            "(--glass-transition, --wlf, --shift-file)"
        )
    degree = _DEGREES[int(degree)]
    return _refined(colder, hotter, float(tried[best]), hold, degree), degree


def vertical_at(colder: Curve, hotter: Curve, shift: float, hold: Hold) -> float:
    """Return the vertical shift that goes best with a shift that is known."""
    if not (hold.moves and hold.spread > 0):
        return hold.expected
    hotter = Curve(hotter.x, tuple(y + hold.expected for y in hotter.y))
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
    """Return the best shift near one that was found roughly."""
    free = hold.moves and hold.spread > 0
    for spacing in spacings:
        tried = found + spacing * np.arange(-5.0, 6.0)
        costs = _costs(_pair(a, b, tried, hold, free, degree), _ROUNDS)
        # too few points for the degree say nothing
        if np.isfinite(costs).any():
            found = _lowest(tried, costs)
    return found


def _lowest(tried: Array, costs: Array) -> float:
    """Return where a parabola through the lowest of evenly spaced costs has its bottom."""
    i = int(np.argmin(costs))
    if not 0 < i < tried.size - 1:
        return float(tried[i])
    left, middle, right = costs[i - 1 : i + 2]
    bend = left - 2 * middle + right
    if not bend > 0:
        return float(tried[i])
    return float(tried[i] + (tried[1] - tried[0]) * (left - right) / (2 * bend))


def _without_blocks(a: Curve, b: Curve, found: float, hold: Hold, degree: int) -> Array:
    """Return the shift without each stretch of the overlap in turn."""
    low = max(a.x[0], b.x[0] + found) - 1e-9
    high = min(a.x[-1], b.x[-1] + found) + 1e-9
    edges = np.linspace(low, high, _BLOCKS + 1)
    shifts = []
    for start, end in pairwise(edges):
        one, other = (c.chosen((x < start) | (x >= end)) for c, x in ((a, a.x), (b, b.x + found)))
        # a curve that lies in one stretch cannot spare it
        enough = min(one.x.size, other.x.size) >= 2
        shifts.append(_refined(one, other, found, hold, degree, _ROUGH) if enough else found)
    return np.array(shifts)


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
    precision: float  # of the vertical shift, the last unknown, about zero; 0 where it is free


def _pair(a: Curve, b: Curve, shifts: Array, hold: Hold, free: bool, degree: int) -> _Pair:
    """Return polynomials side by side, one for each modulus, then the vertical shift of all."""
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
    """Return unknowns, residuals and squared scatter at each shift, by reweighting."""
    design, points = pair.design, pair.y.size // pair.moduli
    weight = tail = np.ones(design.shape[:2])
    found = residual = scatter = np.zeros(0)
    for _ in range(rounds):
        weighted = np.swapaxes(design * weight[..., None], 1, 2)
        normal = weighted @ design
        # a vertical shift that the data do not fix must not stop the rest
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
    """Return minus twice the log likelihood at each shift, with Schwarz's penalty."""
    if pair.design.shape[2] > pair.y.size - 3 * pair.moduli:
        return np.full(len(pair.design), np.inf)  # too few points for the degree
    found, residual, scatter = _solved(pair, rounds)
    cost = np.log(scatter) + (_FREEDOM + 1) * np.log1p(residual**2 / (_FREEDOM * scatter))
    held = pair.precision * found[:, -1, 0] ** 2
    return np.sum(cost, axis=1) + held + pair.design.shape[2] * np.log(pair.y.size)


def _variances(pair: _Pair) -> tuple[float, float, float]:
    """Return the variances of shift and vertical shift, the last unknown, and their covariance.

    One shift is tried. The inverse of Fisher's information on all unknowns and the shift. A
    vertical shift that is held still, and need not be so, is an unknown as well: what it could
    make up for is not known.
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
