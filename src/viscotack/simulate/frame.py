r"""Time step in the frame of a moving crack edge: integration of the retardation modes.

When the edge moves, the pressure at a fixed point changes fast as the crack passes, although it
hardly changes in the frame of the crack. A step of length dt, in which the edge moves from
:math:`a_0` to :math:`a_1`, therefore assumes at the fraction :math:`\theta` of the step

.. math:: e(r, \theta) = (1-\theta)\, e_0(r + \varphi s_0) + \theta\, e_1(r + \varphi s_1),

with e the displacement that the pressure would cause in the relaxed solid (:mod:`.body`), the
shifts :math:`s_0 = a_0 - a(\theta)` and :math:`s_1 = a_1 - a(\theta)` along the way
:math:`a(\theta)` of the edge, a parabola through its last three places, and a :math:`\varphi` that
is 1 around the edge and decays to 0 towards the centre and the rim. The scheme is consistent for
any :math:`\varphi`; without travel it equals the step of :mod:`.body`.

The old :math:`e_0` is a spline on the old nodes, which need not be those of the step. The new one
is interpolated by the cubic through four nodes, so that the displacement at the end of the step is
linear in its values: :math:`u = C e_1 + u_0`, with a matrix C instead of a scalar compliance. The
weights come from the exact recursion over substeps, which are longer farther from the end.

Equilibrium is :math:`S e_1 + T(C e_1 + b) = 0` with the stiffness S, the tensions T of the
interface and the gap b without the new pressure. S C^-1 is not symmetric because of the loading
path, so there is no energy to minimise. The equation is solved by Newton's method in the gaps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.linalg import get_lapack_funcs

from viscotack.clock import look
from viscotack.model.materials import Modes
from viscotack.model.traction import Traction, effective_range
from viscotack.simulate.equilibrium import descend
from viscotack.simulate.machine import Hold
from viscotack.simulate.surface import Band, Faces, Surface, room

_getrf, _getrs = get_lapack_funcs(("getrf", "getrs"), dtype=np.float64)

# Width of the profile that moves with the edge, as a fraction of the distance to centre or rim.
_ALONG = 0.3
# Largest travel of the edge per step, as a fraction of that width; the profile must not fold.
_FARTHEST = 0.15
# Substeps: travel per substep in node distances, or as a fraction of the distance to the end of the
# step. A travel below _NONE node distances is treated as zero.
_PART, _LAGGING, _NONE = 0.25, 0.05, 0.02
# Largest curvature term of the path, as a fraction of the travel.
_MOST_BENT = 0.9
# Newton's method has converged when the relative change of the gaps is below this value; the
# convergence is quadratic.
_LAST_CHANGE = 0.01
_UNBALANCED = 2e-6
_MOST_ITERATIONS = 12
_LARGEST_CLOSING = 0.5


@dataclass(frozen=True)
class Way:
    """Path of the edge in a step: start, travel, and curvature term from the previous step."""

    begin: float
    travel: float
    bend: float

    @classmethod
    def of(cls, begin: float, travel: float, dt: float, speed: float, before: float) -> Way:
        """Return the path after a previous step of length `before` with this mean speed."""
        bend = dt * (travel - speed * dt) / (dt + before)
        most = _MOST_BENT * abs(travel)
        return cls(begin, travel, min(max(bend, -most), most))

    def from_begin(self, theta: npt.NDArray) -> npt.NDArray:
        """Return the shift s0, minus the distance travelled so far."""
        return -theta * (self.travel + self.bend * (theta - 1))

    def to_end(self, theta: npt.NDArray) -> npt.NDArray:
        """Return the shift s1, the remaining distance."""
        return (1 - theta) * (self.travel + self.bend * theta)


def along(nodes: npt.NDArray, edge: float) -> npt.NDArray:
    """Return the displacement of the profile at each node, relative to that of the edge."""
    inside, outside = widths(nodes, edge)
    distance = np.where(nodes < edge, (nodes - edge) / inside, (nodes - edge) / outside)
    return np.exp(-(distance**4))


def widths(nodes: npt.NDArray, edge: float) -> tuple[float, float]:
    """Return the widths inside and outside the edge over which the profile moves with it."""
    return _ALONG * edge, _ALONG * min(edge, float(nodes[-1]) - edge)


def farthest(nodes: npt.NDArray, edge: float) -> float:
    """Return the largest travel of an edge in a step."""
    return _FARTHEST * min(widths(nodes, edge))


@dataclass(frozen=True, eq=False)
class Passage:
    """A step in the frame of the crack, for one path of the edge, on the nodes of its end.

    Attributes
    ----------
    decay, weights : ndarray, shape (M,) and (M, Q)
        Decay factor of each mode, and its displacement per unit of e at each share.
    theta : ndarray, shape (Q,)
        Shares of the step.
    old : ndarray, shape (Q, N)
        (1 - theta) e_0 there.
    first, part : ndarray, shape (Q, N) and (4, Q, N)
        The first of four nodes, and their parts in e_1 there.
    """

    decay: npt.NDArray
    weights: npt.NDArray
    theta: npt.NDArray
    old: npt.NDArray
    first: npt.NDArray
    part: npt.NDArray

    @classmethod
    def of(
        cls, modes: Modes, dt: float, way: Way, before: CubicSpline, nodes: npt.NDArray, h: float
    ) -> Passage:
        """Return the passage for e_0 as a spline, onto nodes that are h apart at the edge."""
        theta = _shares(abs(way.travel) / h)
        decay, weights = path_recursion(np.asarray(modes.times), dt, theta)
        moves = along(nodes, way.begin + way.travel)
        old = (1 - theta)[:, None] * before(nodes + np.outer(way.from_begin(theta), moves))
        at = nodes + np.outer(way.to_end(theta), moves)
        return cls(decay, weights, theta, old, *_four_nodes(nodes, at))

    def compliance(self, modes: Modes) -> npt.NDArray:
        """Return C, shape (N, N): displacement at the end per e_1."""
        many = self.old.shape[1]
        each = (np.asarray(modes.weights) @ self.weights) * self.theta
        entries = self.part * each[:, None]
        place = np.arange(many) * many + self.first + np.arange(4)[:, None, None]
        C = np.bincount(place.ravel(), entries.ravel(), many * many).reshape(many, many)
        C.flat[:: many + 1] += modes.instantaneous
        return C

    def inherited(self, modes: Modes, d: npt.NDArray) -> npt.NDArray:
        """Return the displacement at the end due to the loading history alone."""
        w = np.asarray(modes.weights)
        return (w * self.decay) @ d + (w @ self.weights) @ self.old

    def interpolated(self, e1: npt.NDArray) -> npt.NDArray:
        """Return the field at the end of the step, shifted back along the path, shape (Q, N)."""
        return sum(part * e1[self.first + k] for k, part in enumerate(self.part))  # type: ignore

    def advanced(self, d: npt.NDArray, e1: npt.NDArray) -> npt.NDArray:
        """Return the displacement of every mode at the end."""
        e = self.old + self.theta[:, None] * self.interpolated(e1)
        return self.decay[:, None] * d + self.weights @ e


def _shares(travel: float) -> npt.NDArray:
    """Return the shares of a step at which e is evaluated, for a travel in node distances."""
    if travel < _NONE:
        return np.array([0.0, 1.0])
    lags, least = [0.0], _PART / travel
    while lags[-1] < 1:
        lags.append(lags[-1] + max(least, _LAGGING * lags[-1]))
    return 1 - np.array(lags[::-1]) / lags[-1]


def path_recursion(
    times: npt.NDArray, dt: float, theta: npt.NDArray
) -> tuple[npt.NDArray, npt.NDArray]:
    """Return the decay factor of each mode over a step, and the weights of e at the shares."""
    tau = times[:, None]
    x = np.diff(theta) * dt / tau
    decay = np.exp(-x)
    phi = -np.expm1(-x) / x
    left = np.exp(-(1 - theta[1:]) * dt / tau)
    weights = np.zeros((len(tau), len(theta)))
    weights[:, :-1] += left * (phi - decay)
    weights[:, 1:] += left * (1 - phi)
    return np.exp(-dt / tau[:, 0]), weights


def _four_nodes(nodes: npt.NDArray, at: npt.NDArray) -> tuple[npt.NDArray, npt.NDArray]:
    """Return the first of four nodes around each place, and their parts in the cubic there."""
    x = [nodes[k : len(nodes) - 3 + k] for k in range(4)]
    bottom = np.array(
        [np.prod([x[k] - x[j] for j in range(4) if j != k], axis=0) for k in range(4)]
    )
    first = np.clip(np.searchsorted(nodes, at, side="right") - 2, 0, len(nodes) - 4)
    off = [at - x[k][first] for k in range(4)]
    lower, upper = off[0] * off[1], off[2] * off[3]
    part = (1 / bottom)[:, first]
    for k, (one, pair) in enumerate(zip((1, 0, 3, 2), (upper, upper, lower, lower), strict=True)):
        part[k] *= off[one]
        part[k] *= pair
    return first, part


@dataclass(frozen=True, eq=False)
class Found:
    """Equilibrium in the frame of the crack."""

    gap: npt.NDArray
    faces: Faces
    relaxed: npt.NDArray
    depth: float
    iterations: int


def elastic(
    surface: Surface,
    law: Traction,
    free: npt.NDArray,
    compliance: float,
    guess: npt.NDArray,
    hold: Hold,
) -> Found | None:
    """Return the equilibrium of an elastic solid, by minimising its energy."""
    balance = descend(
        surface, law, free, compliance, guess, hold, most_iterations=2 * _MOST_ITERATIONS
    )
    if not balance.stable:
        return None
    e = (balance.gap - free + balance.depth) / compliance
    return Found(balance.gap, balance.faces, e, balance.depth, balance.iterations)


@dataclass(frozen=True, eq=False)
class Balancing:
    """Equilibrium at the end of a step, S e + T(C e + free - depth) = 0, with the machine."""

    surface: Surface
    law: Traction
    compliance: npt.NDArray
    free: npt.NDArray
    hold: Hold

    def found(self, guess: npt.NDArray) -> Found | None:
        """Return the equilibrium near a guess of the gap, None if Newton's method fails.

        The determinant of the tangent is positive on a stable branch and changes sign at its end.
        A solution with a negative determinant is therefore rejected.
        """
        span, gap, face = effective_range(self.law), guess, self.surface.interface
        here = face.at(self.law, gap)
        for iteration in range(1, _MOST_ITERATIONS + 1):
            look()
            tangent = Tangent.of(here, self)
            if tangent is None:
                return None
            e, depth = self._linear(gap, here.tension, tangent)
            after = self.compliance @ e + self.free - depth
            change, scale = after - gap, room(gap, span)
            closing, largest = float(np.max(-change / scale)), float(np.max(np.abs(change) / scale))
            if not np.isfinite(largest):
                return None
            part = min(1.0, _LARGEST_CLOSING / closing) if closing > 0 else 1.0
            gap = gap + part * change
            here = face.at(self.law, gap)
            if largest < _LAST_CHANGE:
                nodal = self.surface.stiffness @ e
                if np.sum(np.abs(nodal + here.tension)) < _UNBALANCED * np.sum(np.abs(nodal)):
                    return None if tangent.negative else Found(gap, here, e, depth, iteration)
        return None

    def _linear(
        self, gap: npt.NDArray, tension: npt.NDArray, tangent: Tangent
    ) -> tuple[npt.NDArray, float]:
        """Return e and depth in equilibrium with tensions linearised at these gaps."""
        right = tangent.pull(gap - self.free) - tension
        deeper = tangent.pull(np.ones_like(gap))
        if self.hold.rigid:
            return tangent.solved(right + self.hold.depth * deeper), self.hold.depth
        still, deeper = tangent.solved(np.column_stack([right, deeper])).T
        total = self._total
        depth = (self.hold.load - total @ still) / (total @ deeper + self.hold.stiffness)
        return still + depth * deeper, float(depth)

    @cached_property
    def _total(self) -> npt.NDArray:
        """The sum of nodal forces per e."""
        return self.surface.stiffness.sum(axis=0)


@dataclass(frozen=True, eq=False)
class Tangent:
    """Derivative of tensions with respect to gaps, and the LU factors of S + T' C."""

    curvature: Band
    factor: npt.NDArray
    pivots: npt.NDArray
    negative: bool

    @classmethod
    def of(cls, face: Faces, of: Balancing) -> Tangent | None:
        """Return the factored tangent at a face, None if it is singular."""
        diagonal, beside = curvature = face.tangent()
        tangent = diagonal[:, None] * of.compliance
        tangent += of.surface.stiffness
        if beside is not None:
            tangent[1:] += beside[:, None] * of.compliance[:-1]
            tangent[:-1] += beside[:, None] * of.compliance[1:]
        # LAPACK uses column order: factoring the transpose avoids a copy
        factor, pivots, info = _getrf(tangent.T, overwrite_a=1)
        swaps = np.count_nonzero(pivots != np.arange(len(pivots)))
        negative = bool((np.count_nonzero(np.diag(factor) < 0) + swaps) % 2)
        return None if info else cls(curvature, factor, pivots, negative)

    def pull(self, opening: npt.NDArray) -> npt.NDArray:
        """Return the change of tensions for a change of gaps."""
        diagonal, beside = self.curvature
        pull = diagonal * opening
        if beside is not None:
            pull[1:] += beside * opening[:-1]
            pull[:-1] += beside * opening[1:]
        return pull

    def solved(self, right: npt.NDArray) -> npt.NDArray:
        """Return e for a right side."""
        return _getrs(self.factor, self.pivots, right, trans=1)[0]
