r"""Mesh: nodes fine around the contact edge, with growing distances away from it.

The crack at the contact edge has a process zone of about :math:`0.75\,\beta/\mu^2` while it is
slow (it grows when the crack is fast). For a large Tabor number it is a tiny part of the contact.
Equidistant nodes around the edge and geometric growth elsewhere need about log(mu) nodes instead of
mu^2. When the edge leaves the fine nodes, the solver remeshes around the new edge.

The process zone of a fast crack is longer than that of a slow one, by a factor of up to 1/k. When
it has grown by a power of two, the nodes become coarser by the same factor, and the steps longer.

Two measures keep the error of remeshing small. The fine nodes of all meshes of a run lie on one
lattice, so that no interpolation is needed where both meshes are fine. The mesh also stays fine at
the initial edge, because slow modes keep the steep displacement profile (the scar) of the relaxed
contact there while a fast crack opens it.

Growth inside the contact is slower than outside. The pressure inside is that of a crack, 1/sqrt(x)
at a distance x from the edge. Every decade of x adds the same error, of second order in the growth,
to the energy release rate. Outside the contact the pressure is almost zero.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from viscotack.errors import InputError
from viscotack.simulate.history import Snapshot

# Largest number of nodes: its matrix has 130 MB, and a run holds several matrices.
MOST_NODES = 4000
# Away from the initial edge, panels may grow faster than outside the present edge by this factor,
# up to this rate: there is no pressure, only the displacement of slow modes.
_HEALED, _FASTEST_GROWTH = 2.0, 0.25


# Nodes are replaced by finer ones where their distance is larger by this factor.
_COARSER = 1.3

# Fractions of the initial zone: threshold for finer nodes, and smallest zone resolved.
_NARROWED, _NARROWEST = 0.75, 2.0**-8


@dataclass(frozen=True)
class Grading:
    """Node distances and extent of a mesh; lengths in the unit of the contact.

    Attributes
    ----------
    spacing : float
        Distance of the nodes around the edge.
    half_width : float
        The fine zone reaches this far to both sides of the edge.
    growth_inside, growth_outside : float
        Relative growth of the distance from node to node towards the centre and outwards.
    outer_radius : float
        Last node.
    scar_spacing, scar_half_width : float
        Spacing and half width of the zone kept fine around the first edge; zero width for an
        elastic solid, which needs no such zone.
    widest : float
        Largest distance of nodes in the contact.
    """

    # whether edges inside the outermost one are possible and get fine nodes as well
    rings: ClassVar[bool] = False

    spacing: float
    half_width: float
    growth_inside: float
    growth_outside: float
    outer_radius: float
    scar_spacing: float
    scar_half_width: float
    widest: float = np.inf

    def widened(self, factor: float) -> Grading:
        """Return the grading for a crack whose zone has grown by this factor, a power of two."""
        return replace(self, spacing=self.spacing * factor, half_width=self.half_width * factor)

    def around(self, edge: float, first_edge: float) -> npt.NDArray:
        """Return fine nodes around an inner edge, on the lattice, with growing distances beside."""
        h = self.spacing
        edge = first_edge + h * round((edge - first_edge) / h)
        fine = h * np.arange(1, int(self.half_width / h) + 1)
        beside = np.concatenate([fine, fine[-1] + self._growing(edge, self.growth_outside)])
        nodes = edge + np.concatenate([-beside[::-1], [0.0], beside])
        return nodes[nodes > h / 2]

    def nodes(self, edge: float, first_edge: float) -> npt.NDArray:
        """Return the nodes, from 0 outwards, for an edge and the first edge of the run."""
        h = self.spacing
        edge = first_edge + h * round((edge - first_edge) / h)
        ways = min(self.half_width, edge) + min(self.half_width, self.outer_radius - edge)
        check_count(ways / h + 2 * self.scar_half_width / self.scar_spacing)
        inward = int(min(self.half_width, edge) / h)
        outward = int(min(self.half_width, self.outer_radius - edge + h / 4) / h)
        fine = edge + h * np.arange(-inward, outward + 1)
        if fine[0] <= 2 * h:
            fine = np.linspace(0.0, fine[-1], max(round(fine[-1] / h), 8) + 1)
            inner = np.empty(0)
        else:
            inner = fine[0] - self._inwards(fine[0], first_edge)[::-1]
            inner[0] = 0.0
        parts, end, last_step, growth = [inner, fine], fine[-1], h, self.growth_outside
        kept = int(self.scar_half_width / self.scar_spacing)
        scar = first_edge + self.scar_spacing * np.arange(-kept, kept + 1)
        if kept and scar[-1] > end + h / 2:
            if scar[0] > end + h / 2:
                growth = self._healed
                parts.append(self._bridge(end, scar[0]))
            parts.append(scar[scar > end + self.scar_spacing / 2])
            end, last_step = scar[-1], self.scar_spacing
        outwards = self._growing(self.outer_radius - end, growth, first=last_step)
        nodes = np.concatenate([*parts, end + outwards])
        check_count(len(nodes))
        return nodes

    @property
    def _healed(self) -> float:
        """Growth of the distance from node to node away from a scar."""
        return max(self.growth_outside, min(_HEALED * self.growth_outside, _FASTEST_GROWTH))

    def _inwards(self, length: float, first_edge: float) -> npt.NDArray:
        """Return growing distances from the fine zone, the last one being the length.

        Their number stays constant until the edge radius has halved, and so on. Their growth then
        changes smoothly as the edge recedes; removing one node would change the energy of the
        solid by more than a time step does.
        """
        first = max(first_edge - self.half_width, length)
        first /= 2.0 ** np.floor(np.log2(first / length))
        coarsest = self._coarsest(first)
        many = 1 + len(self._growing(first, self.growth_inside, largest=coarsest))
        h, largest = self.spacing, self._coarsest(length)

        def away(growth: float) -> npt.NDArray:
            grown = np.minimum(np.arange(1, many + 1) * np.log1p(growth), np.log(largest / h))
            return np.cumsum(h * np.exp(grown))

        # otherwise round-off in the sum leaves no bracket for the root
        if many * largest <= length or away(0.0)[-1] >= length:
            return length * np.arange(1, many + 1) / many
        growth = brentq(lambda growth: float(away(growth)[-1]) - length, 0.0, 1.0, xtol=1e-12)
        points = away(float(growth))  # type: ignore[arg-type]
        return points * (length / points[-1])

    def _coarsest(self, length: float) -> float:
        """Return the largest distance of nodes in a contact that goes so far from the middle."""
        return max(min(length / 24, self.widest), self.spacing)

    def _growing(
        self, length: float, growth: float, *, first: float | None = None, largest: float = np.inf
    ) -> npt.NDArray:
        """Return growing distances from the fine zone, the first beyond `length` being the last."""
        points, step = [0.0], self.spacing if first is None else first
        while points[-1] < length:
            step = min(step * (1 + growth), largest)
            points.append(points[-1] + step)
        return np.array(points[1:])

    def _bridge(self, start: float, end: float) -> npt.NDArray:
        """Return nodes from the fine zone to the scar, coarsest between, without the ends."""
        length, points = end - start, [0.0]
        while points[-1] < length:
            left = max(length - points[-1], 0.0)
            step = self.spacing + self.growth_outside * points[-1]
            from_scar = self.scar_spacing + self._healed * left
            points.append(points[-1] + min(step, from_scar))
        return start + np.array(points[1:-1]) * (length / points[-1])


@dataclass(frozen=True)
class EndedGrading(Grading):
    """A grading with its last node exactly at the end of the indenter.

    No panel is longer than `coarsest`.
    """

    coarsest: float = np.inf

    def nodes(self, edge: float, first_edge: float) -> npt.NDArray:
        """Return the nodes, from 0 to the end, for an edge and the first edge of the run."""
        nodes = super().nodes(edge, first_edge)
        inside = nodes < self.outer_radius - self.scar_spacing / 4
        nodes = nodes[inside]
        if self.outer_radius - nodes[-1] < 0.5 * (nodes[-1] - nodes[-2]):
            nodes = nodes[:-1]  # a short panel after long ones would not be resolved
        nodes = np.append(nodes, self.outer_radius)
        parts = np.ceil(np.diff(nodes) / self.coarsest - 1e-9).clip(min=1)
        check_count(float(parts.sum()))
        return np.interp(np.arange(parts.sum() + 1), np.append(0, np.cumsum(parts)), nodes)


def finer(nodes: npt.NDArray, own: npt.NDArray) -> npt.NDArray:
    """Merge two node sets: use the nodes `own` where they are finer.

    Examples
    --------
    >>> finer(np.array([0.0, 1.0, 1.5, 2.0, 8.0]), np.linspace(3.0, 6.0, 4))
    array([0. , 1. , 1.5, 2. , 3. , 4. , 5. , 6. , 8. ])
    """
    middle = (own[1:] + own[:-1]) / 2
    width = np.interp((nodes[1:] + nodes[:-1]) / 2, middle, np.diff(own), left=np.inf, right=np.inf)
    coarse = np.diff(nodes) > _COARSER * width
    edge = np.diff(np.concatenate([[False], coarse, [False]]).astype(int))
    kept = np.ones(len(nodes), dtype=bool)
    parts = []
    for first, last in zip(np.flatnonzero(edge == 1), np.flatnonzero(edge == -1), strict=True):
        kept[first + 1 : last] = False
        low, high = nodes[first] + width[first] / 2, nodes[last] - width[last - 1] / 2
        parts.append(own[(own > low) & (own < high)])
    return np.sort(np.concatenate([nodes[kept], *parts]))


def check_count(nodes: float) -> None:
    """Reject a mesh with too many nodes before a matrix is allocated."""
    if not nodes <= MOST_NODES:
        raise InputError(
            f"the mesh would have {nodes:.3g} nodes, and a simulation takes up to {MOST_NODES}: "
            "ask for less accuracy, a law of longer range, or a punch that is less wide beside its "
            "layer"
        )


@dataclass(frozen=True)
class Mesh:
    """Present mesh of a run, with the data for remeshing.

    Attributes
    ----------
    finest, opening : Grading, float
        Grading for the first crack, and the length over which its gap opens by
        the range of the law.
    lattice : float
        Centre of the lattice of fine nodes and of the scar: the edge at which receding started.
    grading : Grading
        Grading of the present nodes.
    edge : float
        Edge for which the last remeshing was done or attempted.
    narrows : bool
        Whether the zone may become shorter than the initial one, as with a rate-dependent law.
    """

    finest: Grading
    opening: float
    lattice: float
    grading: Grading
    edge: float
    narrows: bool = False
    inner: tuple[float, ...] = ()

    def around(self, edge: float, opening: float, inner: tuple[float, ...] = ()) -> Mesh:
        """Return the mesh around the edges for the length over which the gap opens at the outer.

        Its fine zone stays within a third of the edge.
        """
        factor = min(opening / self.opening, edge / (3 * self.finest.half_width))
        grading = self.finest
        if factor >= 2 or (self.narrows and factor < _NARROWED):
            grading = grading.widened(max(2.0 ** np.floor(np.log2(factor)), _NARROWEST))
        return replace(self, grading=grading, edge=edge, inner=inner if grading.rings else ())

    def nodes(self) -> npt.NDArray:
        """Return the nodes, from 0 outwards."""
        nodes = self.grading.nodes(self.edge, self.lattice)
        for edge in self.inner:
            nodes = finer(nodes, self.grading.around(edge, self.lattice))
        check_count(len(nodes))
        return nodes

    def too_coarse(self, opening: float) -> bool:
        """Return whether the zone has become so short that it needs finer nodes."""
        now = self.grading.half_width / self.finest.half_width
        return self.narrows and now > _NARROWEST and opening < _NARROWED * now * self.opening

    def left_by(self, edge: float, inner: tuple[float, ...] = ()) -> bool:
        """Return whether an edge has moved over half the fine half width and is not vanishing."""
        least = 2 * self.grading.spacing
        left = edge > least and not self._near(edge, (self.edge,))
        return left or (self.grading.rings and any(x > least and self._out(x) for x in inner))

    def had(self, edge: float, inner: tuple[float, ...] = ()) -> bool:
        """Return whether the edges are well within the fine nodes."""
        known = not self.grading.rings or not any(self._out(x) for x in inner)
        return self._near(edge, (self.edge,)) and known

    def _out(self, inner: float) -> bool:
        """Return whether an inner edge is out of all fine nodes."""
        return not self._near(inner, (self.edge, *self.inner))

    def _near(self, edge: float, places: tuple[float, ...]) -> bool:
        return any(not abs(edge - at) > 0.5 * self.grading.half_width for at in places)

    def strain(self, before: Snapshot, after: Snapshot) -> float:
        """Return the squared ratio of the edge travel in a step to its limit on the fine nodes."""
        pairs = [(before.edge, after.edge)]
        if self.grading.rings and len(before.inner) == len(after.inner):
            pairs += zip(before.inner, after.inner, strict=True)
        least, most = 2 * self.grading.spacing, 0.4 * self.grading.half_width
        gone = [abs(now - was) for was, now in pairs if was > least and now > 0]
        return (max(gone, default=0.0) / most) ** 2
