"""The meshed surface of a soft solid that faces an indenter: all that balance and memory need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.bem.interface import Interface
from viscotack.geometry import Body
from viscotack.geometry.hats import hat_areas, panel_areas
from viscotack.traction import Traction

_potrf, _potri = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)

# The smooth pressure that sets the own compliance of the first nodes goes over so many of them, as
# far as their distances do not grow by this factor, and sets it for a part of them: towards its end
# it is not smooth.
_BUMP, _WIDER, _LEVELLED = 30, 1.5, 1 / 3


@dataclass(frozen=True, eq=False)
class Surface:
    """Nodes, what holds them, and what the indenter leaves between itself and them.

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
        Where the edge is when all nodes are in contact; nan where that cannot be.
    interface : Interface
        The law on these nodes.
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
        r"""Return displacements [h0] that need no force on the nodes beyond the last loaded one.

        With i the nodes up to there and o those beyond, :math:`S_{oo} d_o = -S_{oi} d_i`: the
        surface beyond the load. A spline that is drawn on puts forces there, which slow modes
        store.

        Parameters
        ----------
        last : float
            Last loaded place [unit of the mesh].
        displacement : ndarray, shape (M, N)
            Displacements of the relaxed solid [h0], positive outwards; those beyond do not matter.
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
        """Return the normal force [output unit], compression positive, with that of the flank."""
        return self.unit * float(np.sum(self.nodal(law, gap))) + self.flank_force(law, gap)

    def flank_force(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the force [output unit] on the flank beyond the last node.

        A law that differs from node to node says what it is at the rim.
        """
        law = getattr(law, "rim", law)
        return self.flank * float(law.energy(gap[-1])) if self.flank else 0.0

    def flank_energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the interface energy [output force times h0] of the flank beyond the last node."""
        return self.flank * float(law.energy_beyond(gap[-1])) if self.flank else 0.0

    def edge(self, gap: npt.NDArray, edge_gap: float) -> float:
        """Return the contact edge, where the gap last passes edge_gap; nan without one."""
        below = np.flatnonzero(gap < edge_gap)
        if len(below) == 0:
            return float("nan")
        if below[-1] == len(gap) - 1:
            return self.whole
        return self._passage(gap, edge_gap, int(below[-1]))

    def inner_edges(self, gap: npt.NDArray, edge_gap: float) -> tuple[float, ...]:
        """Return the places within the contact edge where the gap passes edge_gap, ascending.

        Where there are any the contact has a hole, or several parts.
        """
        below = gap < edge_gap
        passed = np.flatnonzero(below[1:] != below[:-1])
        within = passed[:-1] if not below[-1] else passed
        return tuple(self._passage(gap, edge_gap, int(i)) for i in within)

    def _passage(self, gap: npt.NDArray, edge_gap: float, i: int) -> float:
        """Return where the gap passes edge_gap between a node and the next."""
        r, g = self.position, gap - edge_gap
        linear = r[i] - g[i] * (r[i + 1] - r[i]) / (g[i + 1] - g[i])
        if i == 0 or i + 2 >= len(r):
            return float(linear)
        # The cubic through four nodes, by Newton from the chord: a linear edge would move in jerks
        # from node to node, and its speed would be noise.
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
    exists exactly where the state is stable, and the energy audit closes. At an axis, where areas
    grow from node to node, that alone would cost a fourth of the pressure of the first node on any
    mesh, and 1 % of the second's. So the compliances of the first nodes with themselves are those
    that balance, beside all others, a smooth pressure (:func:`_levelled`). Under a sphere the
    pressure at the axis is then within 2 % on any mesh. Under a cone, where it is unbounded, that
    of the first node is a third above the mean there.

    Parameters
    ----------
    body : Body
        In the unit of length of the nodes.
    symmetry : {"revolution", "plane"}
        Of the shape that presses.
    nodes : ndarray, shape (N,)
        Ascending from 0.
    smoothing : float
        What the interface needs, see :func:`stiffness`.
    """
    G = body.influence(nodes, symmetry)
    if symmetry == "revolution":
        G = _levelled(G, nodes, hat_areas(nodes, symmetry))
    with np.errstate(divide="ignore"):  # springs side by side
        distant = 1 / (1 + (np.diff(nodes) / body.decay_length) ** 2)
    return stiffness(G, panel_areas(nodes, symmetry), smoothing, distant)


def _levelled(influence: npt.NDArray, radius: npt.NDArray, area: npt.NDArray) -> npt.NDArray:
    """Return the influence matrix with diagonal entries that suit its symmetric part at the axis.

    A smooth bump of pressure around the axis displaces the nodes as collocation has it, exactly but
    for its straight lines. What the symmetric compliance misses of that at the first nodes is put
    on their diagonal: no other entry changes, and the matrix stays symmetric.
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

    Collocation gives G: displacement *at* node i under the hat at node j. Two things are mended.

    The discrete contact needs an energy, so the compliance B = G/A of nodal *forces* is replaced by
    its symmetric part.

    And pressures drawn as straight lines from node to node are too large where they are convex:
    over a panel of width h by :math:`h^2 p''/12` in the mean, an error of second order, the largest
    there is at the edge of a contact. Half of it is taken off the pressures and, so that the matrix
    stays symmetric, half off the displacements: with the smoothing
    :math:`W = 1 - \tfrac{1}{24} h^2 \partial^2`, here by differences that conserve the force,
    :math:`B \to W B W^T` has an error of third order on equal nodes, and a fiftieth of the error.
    An interface that takes means over panels has more to make up for, and says how much.

    Parameters
    ----------
    influence : ndarray, shape (N, N)
        G [length], from nodes that ascend from the axis.
    panels : ndarray, shape (N - 1,)
        Area between neighbours, half of it belonging to each of them.
    smoothing : float
        What the interface needs, 24 where it takes the law at the nodes.
    distant : float or ndarray, shape (N - 1,)
        1 where a pressure is felt far beyond its panel, 0 where the solid answers on the spot, like
        springs side by side: there the straight lines do no harm.

    Returns
    -------
    ndarray, shape (N, N)
        Symmetric to the last bit, and positive definite.

    Raises
    ------
    ArithmeticError
        If the nodes are too close to each other for the digits there are.
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
    lower = np.tril(lower)
    return lower + np.tril(lower, -1).T


def _smoothed(rows: npt.NDArray, moved: npt.NDArray, area: npt.NDArray) -> npt.NDArray:
    """Return W times a matrix: what leaves a node over a panel arrives at its neighbour."""
    flux = moved[:, None] * np.diff(rows, axis=0)
    smooth = rows.copy()
    smooth[:-1] -= flux / area[:-1, None]
    smooth[1:] += flux / area[1:, None]
    return smooth
