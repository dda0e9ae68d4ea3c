"""Discretised surface of a soft solid below an indenter: nodes, stiffness, gap and interface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.model.geometry import Body
from viscotack.model.geometry.hats import hat_areas, panel_areas
from viscotack.model.traction import Traction
from viscotack.simulate.interface import Interface

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


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


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
    fading = law.energy(gap / _NODES) / at_node
    return 1 + p * float(_WEIGHTS @ (_NODES ** (-1 - p) * fading))
