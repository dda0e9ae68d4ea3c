r"""Curves of one pad at a set speed, by its start and its work of adhesion.

A viscoelastic pad that starts deeper, or holds more, follows another curve. The family has curves
at a few starts and works, each of them computed by the best tier: steady cracks where they cover
the pad, else a simulation. Between them it interpolates force and travel at equal fractions of
the travel, by a polynomial in the start and linearly in the work. An elastic pad has one curve for
each work, that of the deepest start.

A spring of its own under each pad belongs to the pad: a viscoelastic pad is computed behind it, so
that its speed is that of the plate less the extension of its spring. An elastic one is put behind
it afterwards, which is exact.

**Force by position of pads pulled at a set speed, and of pads on springs and side by side.** A
curve is the path of one pad: positions that never increase, and forces, linear between them. It
ends with the force 0. Two operations give every array without elastic interaction:

- Behind a spring k the drive is at :math:`z = x + F/k`. Where z would have to increase, no state in
  equilibrium exists at a smaller z: the pad jumps, at constant z, to the first later point of its
  path with a smaller z. The jump loses the energy :math:`-\int F\, dz` over the skipped path, which
  is the energy released by the spring less the work that the pad absorbs.
- Side by side on a rigid plate the forces add up at equal z.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, Literal

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import AtDepth, AtForce, Retraction
from viscotack.result.observables import pull_off
from viscotack.simulate import solve
from viscotack.simulate.crack_contact.by_crack import crack_contact
from viscotack.simulate.in_series import CRACKS, SIMULATION

# Most points of the curve of several pads, besides the ends of theirs.
MOST_KNOTS = 5000


@dataclass(frozen=True, eq=False)
class Curve:
    """Force of a pad by its position, from the start of a pull to its end.

    Attributes
    ----------
    position : ndarray
        Position of the drive [m], positive into the contact, not increasing; equal neighbours are a
        jump.
    force : ndarray
        Force [N], positive in compression; the last one is 0.
    lost : float
        Energy lost in jumps behind springs [J].
    """

    position: Array
    force: Array
    lost: float = 0.0

    @property
    def start(self) -> float:
        """Position at the start [m]."""
        return float(self.position[0])

    @property
    def end(self) -> float:
        """Position at which the force has vanished [m]."""
        return float(self.position[-1])

    @property
    def pull_off_force(self) -> float:
        """Largest tension [N]; 0 without tension."""
        return max(-float(self.force.min()), 0.0)

    @property
    def work(self) -> float:
        """Work of the drive from the last zero of the force in tension to the end [J]."""
        compressed = np.flatnonzero(self.force[: int(np.argmin(self.force))] > 0)
        first = int(compressed[-1]) if compressed.size else 0
        x, F = self.position[first:].copy(), self.force[first:].copy()
        if F[0] > 0:
            x[0] += (x[1] - x[0]) * F[0] / (F[0] - F[1])
            F[0] = 0.0
        return -_integral(F, -x)

    @cached_property
    def _ascending(self) -> tuple[Array, Array]:
        return self.position[::-1], self.force[::-1]

    def at(self, position: Array) -> Array:
        """Return the force [N] at positions, before a jump there; 0 beyond the end."""
        found = self._between(position, "right", 1.0)
        return np.where(position < self._ascending[0][0], 0.0, found)

    def after(self, position: Array) -> Array:
        """Return the force [N] at positions, after a jump there."""
        found = self._between(position, "left", 0.0)
        return np.where(position <= self._ascending[0][0], 0.0, found)

    def _between(self, position: Array, side: Literal["left", "right"], at_jump: float) -> Array:
        """Return forces between points, at a jump of the share `at_jump` between its two ends."""
        x, F = self._ascending
        place = np.clip(np.searchsorted(x, position, side=side) - 1, 0, x.size - 2)
        width = x[place + 1] - x[place]
        share = np.where(
            width > 0, (position - x[place]) / np.where(width > 0, width, 1.0), at_jump
        )
        return F[place] + np.clip(share, 0.0, 1.0) * (F[place + 1] - F[place])

    def moved(self, by: float) -> Curve:
        """Return the curve with all positions increased by a length [m]."""
        return Curve(self.position + by, self.force, self.lost)

    def behind(self, stiffness: float | None) -> Curve:
        """Return the curve of the same pad behind a spring [N/m]; None if rigid."""
        if stiffness is None:
            return self
        z, F = self.position + self.force / stiffness, self.force
        least = np.minimum.accumulate(z)
        reached = np.append(True, z[1:] < least[:-1])
        # the point at which a jump arrives lies on the path into the next point that is reached
        arrives = np.flatnonzero(reached[1:] & ~reached[:-1]) + 1
        from_z = least[arrives - 1]
        share = (z[arrives - 1] - from_z) / (z[arrives - 1] - z[arrives])
        landed = F[arrives - 1] + share * (F[arrives] - F[arrives - 1])
        skipped = np.concatenate([z, from_z]), np.concatenate([F, landed])
        at = np.concatenate([np.arange(z.size, dtype=float), arrives - 0.5])
        keep = np.concatenate([reached, np.ones(arrives.size, dtype=bool)])
        order = np.argsort(at, kind="stable")
        keep = keep[order]
        path_z, path_F = (each[order] for each in skipped)
        path = Curve(path_z[keep], path_F[keep])
        taken = _integral(path.force, path.position)
        lost = taken - _integral(path_F, path_z)
        end = path_z[keep][-1]
        if path_F[keep][-1] != 0:  # the path ends in a jump out of contact
            path = Curve(np.append(path.position, end), np.append(path.force, 0.0))
        return Curve(path.position, path.force, self.lost + max(lost, 0.0))


def side_by_side(curves: Sequence[Curve]) -> Curve:
    """Return the curve of pads on a rigid plate: their forces add up at equal positions.

    The curves begin at the same position.
    """
    if len(curves) == 1:
        return curves[0]
    knots = np.unique(np.concatenate([each.position for each in curves]))[::-1]
    knots = knots[knots <= curves[0].start]
    if knots.size > MOST_KNOTS:
        ends = np.unique([each.end for each in curves])
        some = knots[:: knots.size // MOST_KNOTS + 1]
        knots = np.unique(np.concatenate([some, ends]))[::-1]
    before = np.sum([each.at(knots) for each in curves], axis=0)
    behind = np.sum([each.after(knots) for each in curves], axis=0)
    behind[0] = before[0]
    jumps = before != behind
    position = np.concatenate([knots, knots[jumps]])
    force = np.concatenate([before, behind[jumps]])
    order = np.argsort(np.concatenate([np.arange(knots.size), np.flatnonzero(jumps) + 0.5]))
    return Curve(position[order], force[order], sum(each.lost for each in curves))


def _integral(F: Array, z: Array) -> float:
    """Return the integral of F dz along a path."""
    return float(np.sum((F[1:] + F[:-1]) / 2 * np.diff(z)))


# Number of starts of a family, and largest ratio of neighbouring works.
_STARTS, _RATIO, _MOST_WORKS = 5, 1.15, 7
# Starts closer than this fraction of the travel are one, and margin of the starts over their
# range.
_ONE, _MARGIN = 1e-9, 0.25
# Additional depth of elastic curves over their travel: pads of a small work start deeper.
_DEEPER = 0.3
# Number of common points of interpolated curves.
_POINTS = 400


@dataclass(frozen=True, eq=False)
class PadCurve:
    """The curve of one pad with its tier.

    Attributes
    ----------
    curve : Curve
        Force by position of the plate, relative to the first touch of pad and counterface.
    depth : float
        Depth of the relaxed start [m].
    radius : float
        Contact radius of the relaxed start [m].
    band : float
        Relative half width of the interval of the pull-off force.
    method : str
        "steady cracks" or "simulation".
    """

    curve: Curve
    depth: float
    radius: float
    band: float
    method: str


@dataclass(frozen=True)
class Pull:
    """How one pad is pulled.

    Attributes
    ----------
    pad : Problem
        The pad; its protocol is replaced.
    speed : float
        Speed of the drive [m/s].
    stiffness : float or None
        Spring of its own [N/m]; None if rigid.
    shared : float
        Compliance per force of one pad of what it shares with the others [m/N].
    accuracy, time_limit : float
        Of a simulation.
    """

    pad: Problem
    speed: float
    stiffness: float | None = None
    shared: float = 0.0
    accuracy: float = DEFAULT_ACCURACY
    time_limit: float | None = None

    @property
    def is_elastic(self) -> bool:
        """Whether the pad follows one curve from every start."""
        return self.pad.groups().modulus_ratio == 1

    def with_work(self, factor: float) -> Pull:
        """Return the same pull with a factor on the work of adhesion."""
        if factor == 1:
            return self
        law: Any = self.pad.traction
        changed = replace(law, work_of_adhesion=factor * law.work_of_adhesion)
        return replace(self, pad=replace(self.pad, traction=changed))


# a pull, its yield and a dead load of one array need the same curves
@lru_cache(maxsize=128)
def pad_curve(pull: Pull, start: AtDepth | AtForce) -> PadCurve:
    """Compute the curve of one pad from a relaxed start, by the best tier.

    Raises
    ------
    ValueError
        If no relaxed contact exists at the start.
    SimulationError
        If the simulation stops before its end.
    """
    soft = pull.shared + (0.0 if pull.stiffness is None else 1 / pull.stiffness)
    # an elastic pad is put behind its spring afterwards
    spring = None if pull.is_elastic or soft == 0 else 1 / soft
    problem = replace(pull.pad, protocol=Retraction(start, pull.speed, stiffness=spring))
    si = problem.scales()
    try:
        found = crack_contact(problem)
        peak = found.depth_at_pull_off, found.pull_off_force
        band, method = found.band, CRACKS
    except OutOfRange:
        found = solve(
            problem, accuracy=pull.accuracy, estimate_error=False, time_limit=pull.time_limit
        )
        best = pull_off(found)
        peak = best.depth, best.force
        band, method = pull.accuracy, SIMULATION
    depth, force = found.depth * si.length, found.force * si.force
    near = int(np.argmin(force))
    if peak[0] is not None and peak[1] is not None and -peak[1] * si.force < force[near]:
        # the tier interpolates its pull-off between the points of its curve
        at = peak[0] * si.length
        place = near + int(at <= depth[near])
        depth, force = np.insert(depth, place, at), np.insert(force, place, -peak[1] * si.force)
    own = None if pull.is_elastic else pull.stiffness
    position = depth if own is None else depth + force / own
    # round-off and the detachment within a step must not move the plate back
    position = np.minimum.accumulate(position)
    if force[-1] != 0:
        position, force = np.append(position, position[-1]), np.append(force, 0.0)
    curve = Curve(position, force)
    if pull.is_elastic:
        curve = curve.behind(pull.stiffness)
    radius = float(found.contact_radius[0] * si.radius)
    return PadCurve(curve, float(depth[0]), radius, float(band), method)


@dataclass(frozen=True, eq=False)
class Family:
    """Curves of one pad by start and work of adhesion.

    Attributes
    ----------
    works : ndarray
        Factors on the work of adhesion, ascending.
    curves : tuple of tuple of PadCurve
        For each work the curves by their start, ascending; one for an elastic pad.
    is_elastic : bool
        Whether a curve is valid from every start above its end.
    """

    works: Array
    curves: tuple[tuple[PadCurve, ...], ...]
    is_elastic: bool

    @property
    def band(self) -> float:
        """Largest relative half width of the intervals of the pull-off forces."""
        return max(each.band for row in self.curves for each in row)

    @property
    def radius(self) -> float:
        """Largest contact radius at the start [m]."""
        return max(each.radius for row in self.curves for each in row)

    @property
    def method(self) -> str:
        """Tiers of the curves."""
        return " and ".join(sorted({each.method for row in self.curves for each in row}))

    @property
    def deepest(self) -> float:
        """Deepest position at the start of all works [m]."""
        return min(row[-1].curve.start for row in self.curves)

    @property
    def span(self) -> float:
        """Longest travel of a curve [m]."""
        return max(each.curve.start - each.curve.end for row in self.curves for each in row)

    def curve(self, start: float, work: float = 1.0) -> Curve:
        """Return the curve of a pad from a position at the start [m] with a factor on its work."""
        low, share = _between(self.works, work)
        rows = [self._of_row(self.curves[low], start)]
        if share > 0:
            rows.append(self._of_row(self.curves[low + 1], start))
        return _blend(rows, np.array([1 - share, share][: len(rows)]), start)

    def start_forces(self, starts: Array, works: Array) -> Array:
        """Return the forces of pads at rest [N] at positions [m]; 0 before they touch."""
        rows = np.array([self._rest(row, starts) for row in self.curves])
        nodes = np.arange(starts.size)
        at = np.interp(works, self.works, np.arange(self.works.size, dtype=float))
        low = np.minimum(at.astype(int), max(self.works.size - 2, 0))
        high = np.minimum(low + 1, self.works.size - 1)
        force = rows[low, nodes] + (at - low) * (rows[high, nodes] - rows[low, nodes])
        return np.where(starts < 0, 0.0, force)

    def _rest(self, row: Sequence[PadCurve], starts: Array) -> Array:
        """Return the forces at rest of one work; linear beyond the starts."""
        if self.is_elastic:
            only = row[-1].curve
            x, F = only.position[:2], only.force[:2]
            beyond = F[0] + (starts - x[0]) * (F[1] - F[0]) / (x[1] - x[0])
            return np.where(starts > x[0], beyond, only.at(starts))
        x = np.array([each.curve.start for each in row])
        F = np.array([each.curve.force[0] for each in row])
        inside = np.clip(starts, x[0], x[-1])
        slope = (F[-1] - F[-2]) / (x[-1] - x[-2]) if x.size > 1 else 0.0
        return _weights(x, inside) @ F + slope * (starts - inside)

    def _of_row(self, row: Sequence[PadCurve], start: float) -> Curve:
        if self.is_elastic:
            curve = row[-1].curve
            if start > curve.start + _ONE * (curve.start - curve.end):
                raise InputError(f"a pad would start {start:.4g} m deep, beyond its curve")
            later = curve.position < start
            position = np.append(start, curve.position[later])
            first = curve.at(np.array([start]))
            return Curve(position, np.append(first, curve.force[later]), curve.lost)
        nodes = np.array([each.curve.start for each in row])
        weights = _weights(nodes, np.array([start]))[0]
        return _blend([each.curve for each in row], weights, start)


def family(
    pull: Pull,
    *,
    force: float,
    rises: Sequence[float] | Array,
    works: Sequence[float] | Array,
    deeper: float = 0.0,
    tell: Callable[[float], None] = lambda share: None,
) -> Family:
    """Compute the curves of one pad around the start under a force.

    Parameters
    ----------
    pull : Pull
        Pad, speed and spring.
    force : float
        Mean force of the relaxed starts [N].
    rises, works : sequence of float
        Positions of the pads relative to their mean [m], and factors on their works.
    deeper : float
        Length by which the starts reach deeper than the force and the rises suggest [m].
    tell : callable
        Called with the completed share.
    """
    if not min(works) > 0:
        raise InputError(f"works of adhesion must be positive, got a factor of {min(works):.3g}")
    least, most = min(works), max(works)
    count = int(np.ceil(np.log(most / least) / np.log(_RATIO))) + 1
    nodes = np.geomspace(least, most, int(np.clip(count, 2, _MOST_WORKS)))
    if most <= least * (1 + 1e-6):
        nodes = np.array([least])
    middle = pad_curve(pull, AtForce(force))
    span = middle.curve.start - middle.curve.end
    low, high = min(rises), max(rises)
    margin = _MARGIN * (high - low)
    is_one = high - low <= _ONE * span
    if is_one and nodes.size == 1 and deeper == 0:
        return Family(nodes, ((middle,),), pull.is_elastic)
    deepest = middle.depth + high + margin + deeper
    if pull.is_elastic:
        starts = np.array([deepest + _DEEPER * span])
    elif is_one:
        starts = middle.depth + 0.1 * span * np.array([-1.0, 1.0]) + np.array([0.0, deeper])
    else:
        least = max(middle.depth + low - margin, 0.0)
        # Chebyshev's places, with both ends
        share = (1 - np.cos(np.pi * np.arange(_STARTS) / (_STARTS - 1))) / 2
        starts = least + share * (deepest - least)
    rows = []
    for i, work in enumerate(nodes):
        changed = pull.with_work(float(work))
        row = []
        for j, depth in enumerate(starts):
            row.append(pad_curve(changed, AtDepth(float(depth))))
            tell((i * starts.size + j + 1) / (nodes.size * starts.size))
        rows.append(tuple(row))
    return Family(nodes, tuple(rows), pull.is_elastic)


def _between(nodes: Array, value: float) -> tuple[int, float]:
    """Return the node below a value and its share of the way to the next one."""
    if nodes.size == 1:
        return 0, 0.0
    low = int(np.clip(np.searchsorted(nodes, value, side="right") - 1, 0, nodes.size - 2))
    return low, float((value - nodes[low]) / (nodes[low + 1] - nodes[low]))


def _weights(nodes: Array, values: Array) -> Array:
    """Return the weights of Lagrange's interpolation between nodes, a row for each value."""
    weights = np.ones((values.size, nodes.size))
    for i, node in enumerate(nodes):
        for other in np.delete(nodes, i):
            weights[:, i] *= (values - other) / (node - other)
    return weights


def _blend(curves: Sequence[Curve], weights: Array, start: float) -> Curve:
    """Interpolate between curves at equal fractions of their travel."""
    close = np.flatnonzero(np.abs(weights - 1) < _ONE)
    if close.size:
        only = curves[int(close[0])]
        return only.moved(start - only.start)
    parts = np.unique(np.concatenate([(c.start - c.position) / (c.start - c.end) for c in curves]))
    if parts.size > 2 * _POINTS:
        parts = np.unique(np.append(parts[:: parts.size // _POINTS], 1.0))
    travels = np.array([each.start - each.end for each in curves])
    forces = [
        each.at(each.start - parts * travel) for each, travel in zip(curves, travels, strict=True)
    ]
    position = start - parts * float(weights @ travels)
    return Curve(np.append(position, position[-1]), np.append(weights @ np.array(forces), 0.0))
