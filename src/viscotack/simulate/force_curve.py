r"""Force by position of pads pulled at a set speed, and of pads on springs and side by side.

A curve is the path of one pad: positions that never increase, and forces, linear between them. It
ends with the force 0. Two operations give every array without elastic interaction:

- Behind a spring k the drive is at :math:`z = x + F/k`. Where z would have to increase, no state in
  equilibrium exists at a smaller z: the pad jumps, at constant z, to the first later point of its
  path with a smaller z. The jump loses the energy :math:`-\int F\, dz` over the skipped path, which
  is the energy released by the spring less the work that the pad absorbs.
- Side by side on a rigid plate the forces add up at equal z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from viscotack.arrays import Array

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
