r"""Curves of one pad at a set speed, by its start and its work of adhesion.

A viscoelastic pad that starts deeper, or holds more, follows another curve. The family has curves
at a few starts and works, each of them computed by the best tier: steady cracks where they cover
the pad, else a simulation. Between them it interpolates force and travel at equal fractions of
the travel, by a polynomial in the start and linearly in the work. An elastic pad has one curve for
each work, that of the deepest start.

A spring of its own under each pad belongs to the pad: a viscoelastic pad is computed behind it, so
that its speed is that of the plate less the extension of its spring. An elastic one is put behind
it afterwards, which is exact.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import AtDepth, AtForce, Retraction
from viscotack.result.observables import pull_off
from viscotack.simulate import solve
from viscotack.simulate.crack_contact import crack_contact
from viscotack.simulate.force_curve import Curve
from viscotack.simulate.in_series import CRACKS, SIMULATION

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

    def posed(self, start: AtDepth | AtForce) -> Problem:
        """Return the problem of one pad; an elastic one without its spring."""
        soft = self.shared + (0.0 if self.stiffness is None else 1 / self.stiffness)
        spring = None if self.is_elastic or soft == 0 else 1 / soft
        return replace(self.pad, protocol=Retraction(start, self.speed, stiffness=spring))


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
    problem = pull.posed(start)
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
    if peak[0] is not None and peak[1] is not None:
        depth, force = _with_peak(depth, force, peak[0] * si.length, -peak[1] * si.force)
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


def _with_peak(depth: Array, force: Array, at: float, least: float) -> tuple[Array, Array]:
    """Insert the pull-off that the tier interpolates between the points of its curve."""
    near = int(np.argmin(force))
    if least >= force[near]:
        return depth, force
    place = near + int(at <= depth[near])
    return np.insert(depth, place, at), np.insert(force, place, least)


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
            return _cut(row[-1].curve, start)
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
    nodes = nodes_between(min(works), max(works), _RATIO, _MOST_WORKS)
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


def nodes_between(low: float, high: float, ratio: float, most: int) -> Array:
    """Return values in geometric progression between which curves are interpolated."""
    if high <= low * (1 + 1e-6):
        return np.array([low])
    count = int(np.ceil(np.log(high / low) / np.log(ratio))) + 1
    return np.geomspace(low, high, int(np.clip(count, 2, most)))


def _between(nodes: Array, value: float) -> tuple[int, float]:
    """Return the node below a value and its share of the way to the next one."""
    if nodes.size == 1:
        return 0, 0.0
    low = int(np.clip(np.searchsorted(nodes, value, side="right") - 1, 0, nodes.size - 2))
    return low, float((value - nodes[low]) / (nodes[low + 1] - nodes[low]))


def _cut(curve: Curve, start: float) -> Curve:
    """Return an elastic curve from a position on it."""
    if start > curve.start + _ONE * (curve.start - curve.end):
        raise InputError(f"a pad would start {start:.4g} m deep, beyond its curve")
    later = curve.position < start
    first = curve.at(np.array([start]))
    position = np.append(start, curve.position[later])
    return Curve(position, np.append(first, curve.force[later]), curve.lost)


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
