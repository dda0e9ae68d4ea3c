"""Discretised interface: energy of a traction law, nodal forces and their tangent.

A smooth law, which changes over many nodes, is evaluated at the nodes, each with its area. A law
with a step, like the end of Dugdale's law, would pin the edge at the nodes. For such a law the
energy is averaged over each panel, and the nodal forces are the derivatives of this mean, however
sharp the step. Both methods have errors of second order, which are corrected in the stiffness of
the surface (:func:`viscotack.simulate.surface.stiffness`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

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
