"""The interface on nodes: the energy of a traction law, the forces that follow, their tangent.

A law that changes over many nodes is taken at the nodes, each with its area: for a smooth law this
is as good as any rule. A law with a step, like the end of Dugdale's, would pull the edge from node
to node: there the mean of the energy over each panel takes its place, and the forces on the nodes
are its derivatives, however sharp the step. Both have errors of second order, which the stiffness
of the surface makes up for (:func:`viscotack.bem.surface.stiffness`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from viscotack.traction import Traction, softening

# The tension of a law that the nodes can follow falls by no more [strength squared over work].
_MOST_SOFTENING = 3.0


# Gaps that differ by less [h0] are next to equal.
_EVEN = 1e-3
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_POINTS, _WEIGHTS = (_POINTS + 1) / 2, _WEIGHTS / 2


class Band(NamedTuple):
    """A symmetric matrix with the diagonal, shape (N,), and what is beside it, shape (N - 1,)."""

    diagonal: npt.NDArray
    beside: npt.NDArray | None = None


class Interface(Protocol):
    """What balance and books ask of the interface; gaps are those at the nodes [h0].

    Attributes
    ----------
    smoothing : float
        The panel squared over this is what smooths the curvature of pressures and displacements.
    """

    smoothing: ClassVar[float]

    def energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the energy [dg times the unit of area]."""
        ...

    def tension(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        """Return the derivative of the energy by the gaps: nodal forces, tension positive."""
        ...

    def tangent(self, law: Traction, gap: npt.NDArray) -> Band:
        """Return the second derivatives."""
        ...


@dataclass(frozen=True, eq=False)
class AtNodes:
    """The law at each node, with its area."""

    smoothing: ClassVar[float] = 24.0

    area: npt.NDArray

    def energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the energy [dg times the unit of area]."""
        return float(self.area @ law.energy(gap))

    def tension(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        """Return the derivative of the energy by the gaps: nodal forces, tension positive."""
        return self.area * law.traction(gap)

    def tangent(self, law: Traction, gap: npt.NDArray) -> Band:
        """Return the second derivatives."""
        return Band(self.area * law.stiffness(gap))


@dataclass(frozen=True, eq=False)
class OnPanels:
    r"""The law over each panel, exactly, for a gap that changes linearly with the area there.

    With :math:`\Phi' = \varphi` the energy of a panel from gap a to gap b is its area times

    .. math:: m(a, b) = \frac{\Phi(b) - \Phi(a)}{b - a}

    and the derivatives of m are differences as well. Where a and b are next to equal they have no
    digits left, and the rule of Gauss with three points takes their place.

    Against the law at the nodes, forces that are means over panels feel the curvature of the
    pressure by another twelfth of the panel squared, and so do gaps: 1/24 becomes 1/8 on each side.
    """

    smoothing: ClassVar[float] = 8.0

    panels: npt.NDArray

    def energy(self, law: Traction, gap: npt.NDArray) -> float:
        """Return the energy [dg times the unit of area]."""
        return float(self.panels @ self._mean(law, gap))

    def tension(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        """Return the derivative of the energy by the gaps: nodal forces, tension positive."""
        step, even = self._steps(gap)
        mean, energy = self._mean(law, gap), law.energy(gap)
        first, last = (mean - energy[:-1]) / step, (energy[1:] - mean) / step
        if even.any():
            share, rule = law.traction(_between(gap, even)), _WEIGHTS[:, None]
            first[even] = (rule * (1 - _POINTS[:, None]) * share).sum(axis=0)
            last[even] = (rule * _POINTS[:, None] * share).sum(axis=0)
        return _at_nodes(self.panels * first, self.panels * last)

    def tangent(self, law: Traction, gap: npt.NDArray) -> Band:
        """Return the second derivatives."""
        step, even = self._steps(gap)
        mean, energy, pull = self._mean(law, gap), law.energy(gap), law.traction(gap)
        square = step * step
        first = (2 * (mean - energy[:-1]) / step - pull[:-1]) / step
        last = (pull[1:] - 2 * (energy[1:] - mean) / step) / step
        both = (energy[1:] + energy[:-1] - 2 * mean) / square
        if even.any():
            k, t, w = law.stiffness(_between(gap, even)), _POINTS[:, None], _WEIGHTS[:, None]
            first[even] = (w * (1 - t) ** 2 * k).sum(axis=0)
            last[even] = (w * t**2 * k).sum(axis=0)
            both[even] = (w * t * (1 - t) * k).sum(axis=0)
        diagonal = _at_nodes(self.panels * first, self.panels * last)
        return Band(diagonal, self.panels * both)

    def _mean(self, law: Traction, gap: npt.NDArray) -> npt.NDArray:
        step, even = self._steps(gap)
        # energy_beyond falls by what lies between
        mean = -np.diff(law.energy_beyond(gap)) / step
        if even.any():
            mean[even] = _WEIGHTS @ law.energy(_between(gap, even))
        return mean

    @staticmethod
    def _steps(gap: npt.NDArray) -> tuple[npt.NDArray, npt.NDArray]:
        step = np.diff(gap)
        even = np.abs(step) < _EVEN
        return np.where(even, 1.0, step), even


def resolved(law: Traction) -> bool:
    """Return whether nodes can follow a law, or must leave it to the panels between them."""
    return softening(law) <= _MOST_SOFTENING


def interface(law: Traction, area: npt.NDArray, panels: npt.NDArray) -> Interface:
    """Return the interface on nodes with these areas, and these areas between them."""
    return AtNodes(area) if resolved(law) else OnPanels(panels)


def _between(gap: npt.NDArray, panels: npt.NDArray) -> npt.NDArray:
    a, b = gap[:-1][panels], gap[1:][panels]
    return a + np.outer(_POINTS, b - a)


def _at_nodes(first: npt.NDArray, last: npt.NDArray) -> npt.NDArray:
    return np.append(first, 0.0) + np.append(0.0, last)
