"""Discretised surface of a soft solid below an indenter: nodes, stiffness, gap and interface.

The interface has the energy of a traction law, nodal forces and their tangent. A smooth law, which
changes over many nodes, is evaluated at the nodes, each with its area. A law with a step, like the
end of Dugdale's law, would pin the edge at the nodes. For such a law the energy is averaged over
each panel, and the nodal forces are the derivatives of this mean, however sharp the step. Both
methods have errors of second order, which are corrected in the stiffness of the surface
(:func:`stiffness`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.model.geometry import Body
from viscotack.model.geometry.panels import hat_areas, panel_areas
from viscotack.model.traction import Traction, softening
from viscotack.model.traction.law import energy_and_traction

# Largest softening of a law evaluated at the nodes [strength squared over work].
_MOST_SOFTENING = 3.0
# Gaps that differ by less [h0] are treated as nearly equal.
_EVEN = 1e-3
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_POINTS, _WEIGHTS = (_POINTS + 1) / 2, _WEIGHTS / 2
_NO_GAPS = np.empty((3, 0))


class Band(NamedTuple):
    """Symmetric tridiagonal matrix: diagonal, shape (N,), and off-diagonal, shape (N - 1,)."""

    diagonal: npt.NDArray
    beside: npt.NDArray | None = None


@dataclass(frozen=True, eq=False)
class AtNodes:
    """Law evaluated at each node and multiplied by its area."""

    # divisor of the squared panel width in the curvature correction of the stiffness
    smoothing: ClassVar[float] = 24.0

    area: npt.NDArray

    def at(self, law: Traction, gap: npt.NDArray) -> NodeFaces:
        """Return the interface at gaps at the nodes [h0]."""
        energy, tension = energy_and_traction(law, gap)
        return NodeFaces(self.area, law, gap, float(self.area @ energy), self.area * tension)


@dataclass(frozen=True, eq=False)
class OnPanels:
    r"""Law integrated exactly over each panel, for a gap that varies linearly with area there.

    With :math:`\Phi' = \varphi` the energy of a panel from gap a to gap b is its area times

    .. math:: m(a, b) = \frac{\Phi(b) - \Phi(a)}{b - a}

    and the derivatives of m are differences as well. If a and b are nearly equal, the differences
    lose all digits and are replaced by Gauss quadrature with three points.

    Compared with the law at the nodes, means over panels add an error of 1/12 of the squared panel
    width times the curvature, for forces and for gaps. The correction 1/24 becomes 1/8 on each
    side.
    """

    smoothing: ClassVar[float] = 8.0

    panels: npt.NDArray

    def at(self, law: Traction, gap: npt.NDArray) -> PanelFaces:
        """Return the interface at gaps at the nodes [h0]."""
        step = np.diff(gap)
        even = np.abs(step) < _EVEN
        # energy_beyond decreases by the integral between the gaps
        step = np.where(even, 1.0, step)
        mean, at_nodes = -np.diff(law.energy_beyond(gap)) / step, law.energy(gap)
        between = _NO_GAPS
        if even.any():
            a, b = gap[:-1][even], gap[1:][even]
            between = a + np.outer(_POINTS, b - a)
            mean[even] = _WEIGHTS @ law.energy(between)
        first, last = (mean - at_nodes[:-1]) / step, (at_nodes[1:] - mean) / step
        if between.size:
            pull, t = law.traction(between), _POINTS[:, None]
            first[even] = _WEIGHTS @ ((1 - t) * pull)
            last[even] = _WEIGHTS @ (t * pull)
        energy = float(self.panels @ mean)
        tension = _spread(self.panels * first, self.panels * last)
        panels = step, mean, at_nodes, even, between
        return PanelFaces(self.panels, law, gap, energy, tension, *panels)


@dataclass(frozen=True, eq=False)
class NodeFaces:
    """A law at the nodes at given gaps: energy, and nodal forces, tension positive."""

    area: npt.NDArray
    law: Traction
    gap: npt.NDArray
    energy: float
    tension: npt.NDArray

    def tangent(self) -> Band:
        """Return the second derivatives of the energy by the gaps."""
        return Band(self.area * self.law.stiffness(self.gap))


@dataclass(frozen=True, eq=False)
class PanelFaces:
    """Means over panels, energies at nodes; `even` panels by their points `between`."""

    panels: npt.NDArray
    law: Traction
    gap: npt.NDArray
    energy: float
    tension: npt.NDArray
    step: npt.NDArray
    mean: npt.NDArray
    at_nodes: npt.NDArray
    even: npt.NDArray
    between: npt.NDArray

    def tangent(self) -> Band:
        """Return the second derivatives of the energy by the gaps."""
        mean, step, energy = self.mean, self.step, self.at_nodes
        pull = self.law.traction(self.gap)
        first = (2 * (mean - energy[:-1]) / step - pull[:-1]) / step
        last = (pull[1:] - 2 * (energy[1:] - mean) / step) / step
        both = (energy[1:] + energy[:-1] - 2 * mean) / (step * step)
        if self.between.size:
            k, t = self.law.stiffness(self.between), _POINTS[:, None]
            first[self.even] = _WEIGHTS @ ((1 - t) ** 2 * k)
            last[self.even] = _WEIGHTS @ (t**2 * k)
            both[self.even] = _WEIGHTS @ (t * (1 - t) * k)
        return Band(_spread(self.panels * first, self.panels * last), self.panels * both)


Interface = AtNodes | OnPanels
Faces = NodeFaces | PanelFaces


def resolved(law: Traction) -> bool:
    """Return whether a law is smooth enough to be evaluated at the nodes."""
    return softening(law) <= _MOST_SOFTENING


def interface(law: Traction, area: npt.NDArray, panels: npt.NDArray) -> Interface:
    """Return the interface for these nodal areas and panel areas."""
    return AtNodes(area) if resolved(law) else OnPanels(panels)


def _spread(first: npt.NDArray, last: npt.NDArray) -> npt.NDArray:
    return np.append(first, 0.0) + np.append(0.0, last)


# Length scales of the law in gap direction: multiples of its range, which is 1 for Lennard-Jones,
# counted from the gap of equilibrium at 1 h0, so that steps and meshes scale with the range.
# The surfaces have separated when the smallest gap exceeds this multiple of the range; the
# remaining work is the energy of the interface there.
_SEPARATED = 9.0
# Opening of the smallest gap, in ranges, above which a contact cannot hold a dead load.
_RELEASED = 29.0
# Smallest gap after interpolation to new nodes: closed by this fraction of the range, where every
# law repels strongly, but at least a tenth of h0. A steep gap may undershoot in the interpolation.
_CLOSED, _LEAST = 0.2, 0.1
# Smallest value of `room`, as a fraction of the range, for gaps below equilibrium.
_LEAST_ROOM = 0.1


def separated(gap: npt.NDArray, span: float) -> bool:
    """Return whether the surfaces have separated."""
    return float(gap.min()) > 1 + _SEPARATED * span


def released(gap: npt.NDArray, span: float) -> bool:
    """Return whether the surfaces are too far apart to hold a dead load."""
    return float(gap.min()) > 1 + _RELEASED * span


def least_gap(span: float) -> float:
    """Return the smallest gap [h0] of an initial guess."""
    return max(1 - _CLOSED * span, _LEAST)


def room(gap: npt.NDArray, span: float) -> npt.NDArray:
    """Return the change of gap [h0] over which the traction changes considerably.

    It is the gap itself for Lennard-Jones, whose traction is made of powers; for any law it is
    about the range near equilibrium, grows with the opening, and never more than the gap.
    """
    return np.minimum(gap, np.maximum(gap + (span - 1), _LEAST_ROOM * span))


_potrf, _potri = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)

# Correction of the diagonal compliances near the axis: number of nodes under the smooth test
# pressure, growth of the node distance at which it ends earlier, and fraction of these nodes that
# is corrected (near its end the test pressure is not smooth).
_BUMP, _WIDER, _LEVELLED = 30, 1.5, 1 / 3


@dataclass(frozen=True, eq=False)
class Surface:
    """Surface nodes with their elastic stiffness, rigid gap and interface.

    Attributes
    ----------
    position : ndarray, shape (N,)
        Nodes, ascending from the axis [unit of length of the contact].
    area : ndarray, shape (N,)
        Area of each node [that unit squared; of a strip, that unit].
    stiffness : ndarray, shape (N, N)
        Nodal forces [area dg/h0] that hold unit displacements [h0] of the relaxed solid; symmetric
        and positive definite.
    rigid_gap : ndarray, shape (N,)
        Gap [h0] at depth zero without displacement.
    unit : float
        Force [output unit] per nodal force; energy [that unit times h0] per nodal force times h0.
    flank : float
        Force [output unit] per energy [dg] of unit area at the last node: what the flank of the
        indenter beyond it adds (Derjaguin). Zero where the indenter ends there.
    whole : float
        Position of the edge if all nodes are in contact; nan if that is impossible.
    interface : Interface
        Discretised traction law on these nodes.
    """

    position: npt.NDArray
    area: npt.NDArray
    stiffness: npt.NDArray
    rigid_gap: npt.NDArray
    unit: float
    flank: float
    whole: float
    interface: Interface

    def free_beyond(self, last: float, displacement: npt.NDArray) -> npt.NDArray:
        r"""Return displacements [h0] with zero force on the nodes beyond the last loaded one.

        With i the nodes up to there and o the nodes beyond, :math:`S_{oo} d_o = -S_{oi} d_i`. An
        extrapolated spline would instead cause forces there, which slow modes would store.

        Parameters
        ----------
        last : float
            Position of the last loaded node [unit of the mesh].
        displacement : ndarray, shape (M, N)
            Displacements of the relaxed solid [h0], positive outwards; values beyond are ignored.
        """
        beyond = self.position > last
        if not beyond.any():
            return displacement
        rows, d = self.stiffness[beyond], displacement.copy()
        d[:, beyond] = -np.linalg.solve(rows[:, beyond], rows[:, ~beyond] @ d[:, ~beyond].T).T
        return d

    def nodal(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        """Return the nodal forces, compression positive."""
        return -self.interface.at(law, gap).tension

    def force(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the normal force [output unit] including the flank, compression positive."""
        return self.unit * float(np.sum(self.nodal(law, gap))) + self.flank_force(law, gap)

    def flank_force(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the force [output unit] on the flank beyond the last node.

        A law that differs from node to node has an attribute `rim`, the law at the last node.
        """
        law = getattr(law, "rim", law)
        return self.flank * float(law.energy(gap[-1])) if self.flank else 0.0

    def flank_energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the interface energy [output force times h0] of the flank beyond the last node."""
        return self.flank * float(law.energy_beyond(gap[-1])) if self.flank else 0.0

    def edge(self, gap: npt.NDArray, edge_gap: float) -> float:
        """Return the contact edge, the outermost crossing of edge_gap; nan without contact."""
        below = np.flatnonzero(gap < edge_gap)
        if len(below) == 0:
            return float("nan")
        if below[-1] == len(gap) - 1:
            return self.whole
        return self._passage(gap, edge_gap, int(below[-1]))

    def inner_edges(self, gap: npt.NDArray, edge_gap: float) -> tuple[float, ...]:
        """Return the crossings of edge_gap inside the contact edge, ascending.

        If the tuple is not empty, the contact has a hole or several parts.
        """
        below = gap < edge_gap
        passed = np.flatnonzero(below[1:] != below[:-1])
        within = passed[:-1] if not below[-1] else passed
        return tuple(self._passage(gap, edge_gap, int(i)) for i in within)

    def _passage(self, gap: npt.NDArray, edge_gap: float, i: int) -> float:
        """Return the position between nodes i and i + 1 at which the gap equals edge_gap."""
        r, g = self.position, gap - edge_gap
        linear = r[i] - g[i] * (r[i + 1] - r[i]) / (g[i + 1] - g[i])
        if i == 0 or i + 2 >= len(r):
            return float(linear)
        # Cubic through four nodes, solved by Newton's method from the linear estimate. Linear
        # interpolation would make the edge move unevenly from node to node, with a noisy speed.
        way = 1.0 if g[i + 1] > g[i] else -1.0
        x, y = r[i - 1 : i + 3].tolist(), (way * g[i - 1 : i + 3]).tolist()
        for order in (1, 2, 3):  # divided differences
            y[order:] = [(y[k] - y[k - 1]) / (x[k] - x[k - order]) for k in range(order, 4)]
        at = float(linear)
        for _ in range(4):
            p, d = at - x[0], at - x[1]
            e = at - x[2]
            value = y[0] + p * (y[1] + d * (y[2] + e * y[3]))
            slope = y[1] + (p + d) * y[2] + (d * e + p * e + p * d) * y[3]
            if slope <= 0:
                return float(linear)
            at -= value / slope
        return at if x[1] <= at <= x[2] else float(linear)


def relaxed_stiffness(
    body: Body, symmetry: str, nodes: npt.NDArray, smoothing: float
) -> npt.NDArray:
    """Return the nodal forces that hold unit displacements of a body with E* = 1.

    Plain collocation is symmetric only up to the discretisation error. The symmetric part of its
    compliance gives the discrete contact an energy: equilibrium is its minimum, a Cholesky factor
    exists if and only if the state is stable, and the energy balance closes. At an axis, where
    areas grow from node to node, the symmetric part alone would have an error of 25 % in the
    pressure of the first node on any mesh, and 1 % at the second. Therefore the diagonal
    compliances of the first nodes are corrected to reproduce a smooth pressure
    (:func:`_levelled`). Under a sphere the pressure at the axis is then accurate to 2 % on any
    mesh. Under a cone, where the pressure is unbounded, that of the first node exceeds the mean
    there by a third.

    Parameters
    ----------
    body : Body
        Body, in the unit of length of the nodes.
    symmetry : {"revolution", "plane"}
        Symmetry of the indenter.
    nodes : ndarray, shape (N,)
        Nodes, ascending from 0.
    smoothing : float
        Smoothing number of the interface, see :func:`stiffness`.
    """
    G = body.influence(nodes, symmetry)
    if symmetry == "revolution":
        G = _levelled(G, nodes, hat_areas(nodes, symmetry))
    with np.errstate(divide="ignore"):  # decay length 0: independent springs
        distant = 1 / (1 + (np.diff(nodes) / body.decay_length) ** 2)
    return stiffness(G, panel_areas(nodes, symmetry), smoothing, distant)


def _levelled(influence: npt.NDArray, radius: npt.NDArray, area: npt.NDArray) -> npt.NDArray:
    """Return the influence matrix with corrected diagonal entries at the axis.

    Collocation gives the displacements under a smooth pressure bump at the axis exactly, apart from
    the piecewise linear interpolation. The difference to the symmetric compliance at the first
    nodes is added to their diagonal entries. No other entry changes, so the matrix stays symmetric.
    """
    steps = np.diff(radius)
    wider = steps > _WIDER * steps[0]
    last = min(_BUMP, int(np.argmax(wider)) if wider.any() else len(steps))
    first = round(_LEVELLED * last)
    bump = (1 - (radius[:last] / radius[last]) ** 2) ** 2
    own = influence[:first, :last] @ bump
    mirrored = (influence[:last, :first] / area[:first]).T @ (area[:last] * bump)
    levelled = influence.copy()
    levelled.flat[: first * (len(radius) + 1) : len(radius) + 1] += (own - mirrored) / (
        2 * bump[:first]
    )
    return levelled


def stiffness(
    influence: npt.NDArray,
    panels: npt.NDArray,
    smoothing: float,
    distant: npt.NDArray | float = 1.0,
) -> npt.NDArray:
    r"""Return the nodal forces that hold unit displacements, for a collocated influence matrix.

    Collocation gives G, the displacement *at* node i under the hat at node j. Two corrections are
    applied.

    First, the discrete contact needs an energy. The compliance B = G/A of nodal *forces* is
    therefore replaced by its symmetric part.

    Second, piecewise linear pressures are too large where they are convex, by :math:`h^2 p''/12` in
    the mean over a panel of width h. This error of second order is the largest one at the edge of a
    contact. Half of it is subtracted from the pressures and, to keep the matrix symmetric, half
    from the displacements. With the smoothing :math:`W = 1 - \tfrac{1}{24} h^2 \partial^2`, written
    in differences that conserve the force, :math:`B \to W B W^T` has an error of third order on
    equidistant nodes, one fiftieth of the original error. An interface averaged over panels needs a
    larger correction, given by its `smoothing`.

    Parameters
    ----------
    influence : ndarray, shape (N, N)
        G [length], from nodes that ascend from the axis.
    panels : ndarray, shape (N - 1,)
        Area between neighbouring nodes, half of it assigned to each.
    smoothing : float
        Smoothing number of the interface, 24 if the law is evaluated at the nodes.
    distant : float or ndarray, shape (N - 1,)
        1 where a pressure displaces the surface far beyond its panel, 0 where the response is
        local, as for independent springs. A local response needs no correction.

    Returns
    -------
    ndarray, shape (N, N)
        Symmetric to the last bit, and positive definite.

    Raises
    ------
    ArithmeticError
        If the nodes are too close to each other for double precision.
    """
    none = np.zeros(1)
    area = (np.concatenate([panels, none]) + np.concatenate([none, panels])) / 2
    B = influence / area
    moved = panels * distant / smoothing
    B = _smoothed(_smoothed((B + B.T) / 2, moved, area).T, moved, area)
    B = (B + B.T) / 2
    factor, info = _potrf(B, lower=1)
    if info == 0:
        lower, info = _potri(factor, lower=1, overwrite_c=1)
    if info:
        raise ArithmeticError("the influence matrix is not positive definite: the mesh is too fine")
    # the factor is zero above the diagonal, and so is the inverse
    whole = lower + lower.T
    whole.flat[:: len(whole) + 1] /= 2
    return whole


def _smoothed(rows: npt.NDArray, moved: npt.NDArray, area: npt.NDArray) -> npt.NDArray:
    """Return W times a matrix; differences between neighbours conserve the total force."""
    flux = moved[:, None] * np.diff(rows, axis=0)
    smooth = rows.copy()
    smooth[:-1] -= flux / area[:-1, None]
    smooth[1:] += flux / area[1:, None]
    return smooth


_FLANK_NODES, _FLANK_WEIGHTS = np.polynomial.legendre.leggauss(40)
_FLANK_NODES, _FLANK_WEIGHTS = (_FLANK_NODES + 1) / 2, _FLANK_WEIGHTS / 2


def flank_share(law: Traction, gap: float, exponent: float) -> float:
    r"""Return the force on a flank that rises like r^q, over that of a sphere (Derjaguin).

    For a sphere the area between two gaps does not depend on the distance. The force on its flank
    is the energy of the law at the gap g of the last node [h0], times a constant. For a tip that
    rises like :math:`r^q`, this area grows like :math:`w = (h/g)^p` with :math:`p = (2-q)/q`, and
    the force is multiplied by

    .. math:: \frac{\int_g^\infty w\,\sigma\,dh}{-\varphi(g)}
              = 1 + \int_g^\infty w' \frac{\varphi(h)}{\varphi(g)}\,dh
              = 1 + p \int_0^1 x^{-1-p}\, \frac{\varphi(g/x)}{\varphi(g)}\,dx .

    For a tension that falls like :math:`h^{-3}` this is :math:`q/(\frac32 q - 1)`. For a law that
    vanishes before the last node it is 1.
    """
    at_node = float(law.energy(gap))
    if at_node == 0:
        return 1.0
    p = (2 - exponent) / exponent
    fading = law.energy(gap / _FLANK_NODES) / at_node
    return 1 + p * float(_FLANK_WEIGHTS @ (_FLANK_NODES ** (-1 - p) * fading))
