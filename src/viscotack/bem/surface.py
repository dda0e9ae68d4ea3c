"""The meshed surface of a soft solid that faces an indenter: all that balance and memory need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import get_lapack_funcs

from viscotack.traction import Traction

_potrf, _potri = get_lapack_funcs(("potrf", "potri"), dtype=np.float64)


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
    """

    position: npt.NDArray
    area: npt.NDArray
    stiffness: npt.NDArray
    rigid_gap: npt.NDArray
    unit: float
    flank: float
    whole: float

    def nodal(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        """Return the nodal forces, compression positive."""
        return -self.area * law.traction(gap)

    def force(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the normal force [output unit], compression positive, with that of the flank."""
        return self.unit * float(np.sum(self.nodal(law, gap))) + self.flank_force(law, gap)

    def flank_force(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the force [output unit] on the flank beyond the last node."""
        return self.flank * float(law.energy(gap[-1])) if self.flank else 0.0

    def interface_energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the interface energy [output force times h0], zero for surfaces far apart."""
        nodal = self.unit * float(self.area @ law.energy(gap))
        return nodal + (self.flank * float(law.energy_beyond(gap[-1])) if self.flank else 0.0)

    def edge(self, gap: npt.NDArray, edge_gap: float) -> float:
        """Return the contact edge, where the gap last passes edge_gap; nan without one."""
        below = np.flatnonzero(gap < edge_gap)
        if len(below) == 0:
            return float("nan")
        if below[-1] == len(gap) - 1:
            return self.whole
        i = int(below[-1])
        r, g = self.position, gap - edge_gap
        linear = r[i] - g[i] * (r[i + 1] - r[i]) / (g[i + 1] - g[i])
        if i == 0 or i + 2 >= len(r):
            return float(linear)
        # The cubic through four nodes, by Newton from the chord: a linear edge would move in jerks
        # from node to node, and its speed would be noise.
        x, y = r[i - 1 : i + 3].tolist(), g[i - 1 : i + 3].tolist()
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


def stiffness(compliance: npt.NDArray) -> npt.NDArray:
    """Return the inverse of a symmetric compliance, symmetric to the last bit."""
    factor, info = _potrf(compliance, lower=1)
    if info == 0:
        lower, info = _potri(factor, lower=1, overwrite_c=1)
    if info:
        raise ArithmeticError("the influence matrix is not positive definite: the mesh is too fine")
    lower = np.tril(lower)
    return lower + np.tril(lower, -1).T
