r"""A rigid map of heights on a soft body: units, and the tail beyond the map.

Lengths along the surface are in :math:`\ell = E_0^* h_0^2/\Delta\gamma_0`, gaps and depths in h0,
tractions in dg/h0, so that a traction p moves the relaxed solid by :math:`\hat G \hat p` without a
factor. A sphere of Tabor number mu has the rigid gap :math:`1 + x^2/(2\mu^3)`.

A map that continues as a paraboloid of radius R beyond its square attracts the solid there as well.
By Derjaguin the tension there is, with the half width L of the square, the gap :math:`g_0` at the
apex at depth 0 and the energy :math:`\varphi` of the law,

.. math:: T = -8 R \int_0^{\pi/4}
          \varphi\Big(g_0 + \frac{L^2}{2 R \cos^2\theta} - \delta\Big) d\theta .
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from viscotack.model.protocol import AtDepth, Start
from viscotack.model.surfaces.heights import rms_curvature
from viscotack.model.traction import Traction, effective_range
from viscotack.simulate.grid.plane import Device, Plane

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_ANGLES, _WEIGHTS = (_POINTS + 1) * np.pi / 8, _WEIGHTS * np.pi / 8


@dataclass(frozen=True, eq=False)
class MapContact:
    """A rigid map of heights on a soft body.

    Parameters
    ----------
    plane : Plane
        The surface of the body.
    rigid_gap : ndarray, shape (N,)
        Gap [h0] at depth 0 over the undeformed surface; 1 at the highest point.
    law : Traction
        Reduced traction law.
    force : float
        Unit of force [dg l^2/h0].
    beyond : float or None
        Radius R of the paraboloid in which the map continues [l^2/h0]; None if nothing does.
    apex : float
        Gap [h0] at depth 0 at the apex of that paraboloid.
    """

    plane: Plane
    rigid_gap: npt.NDArray
    law: Traction
    force: float
    beyond: float | None = None
    apex: float = 1.0

    def on(self, device: Device) -> MapContact:
        """Return the contact with its fields on another device."""
        return replace(self, plane=replace(self.plane, device=device))

    def coarser(self) -> MapContact:
        """Return the contact on pixels twice as large, each with the largest gap of its four."""
        rows, columns = (side // 2 for side in self.plane.shape)
        gap = self.rigid_gap.reshape(self.plane.shape)[: 2 * rows, : 2 * columns]
        return self._on_larger(gap.reshape(rows, 2, columns, 2).max((1, 3)))

    def every_second(self, row: int, column: int) -> MapContact:
        """Return the contact on pixels twice as large, of every second row and column from some."""
        rows, columns = (side - side % 2 for side in self.plane.shape)
        gap = self.rigid_gap.reshape(self.plane.shape)
        return self._on_larger(gap[row:rows:2, column:columns:2])

    def _on_larger(self, gap: npt.NDArray) -> MapContact:
        plane = replace(self.plane, shape=gap.shape, pixel=2 * self.plane.pixel)
        return replace(self, plane=plane, rigid_gap=gap.ravel())

    @property
    def span(self) -> float:
        """The range of the law [h0]."""
        return effective_range(self.law)

    @cached_property
    def free(self) -> npt.NDArray:
        """The rigid gap on the device of the plane."""
        return self.plane.field(self.rigid_gap)

    @property
    def area(self) -> float:
        """Area of a pixel [l^2]."""
        return self.plane.pixel**2

    @property
    def unit(self) -> float:
        """Force [output unit] per force on a pixel [dg l^2/h0]."""
        return 1 / self.force

    @cached_property
    def travel(self) -> float:
        """Depth [h0] over which a contact of an asperity changes."""
        gap = self.rigid_gap.reshape(self.plane.shape)
        curvature = rms_curvature(gap, self.plane.pixel, self.plane.periodic)
        drawn = 0.0 if curvature == 0 else curvature ** (-1 / 3)
        return self.span + min(drawn, float(np.ptp(self.rigid_gap)))

    @property
    def edge_unit(self) -> float:
        """Unit of the contact radius of the outputs."""
        return 1.0

    def deepest(self, start: Start) -> float:
        """Return about the depth [h0] of a relaxed contact, at least."""
        if isinstance(start, AtDepth):
            return start.depth
        return float(np.ptp(self.rigid_gap)) + self.travel

    def relaxed_pull_off(self, edge: float) -> float:
        """Return infinity: what is left of a contact on a map bounds no force."""
        return np.inf

    def force_under(self, tension: npt.NDArray, depth: float) -> float:
        """Return the force [output unit] under tensions [dg/h0] of the pixels, with the tail."""
        return self.tail_force(depth) - self.unit * self.area * float(tension.sum())

    def tail_force(self, depth: float) -> float:
        """Return the force [output unit] on the paraboloid beyond the map, tension negative."""
        if self.beyond is None:
            return 0.0
        energy = self.law.energy(self._tail_gap(depth))
        return 8 * self.beyond * float(_WEIGHTS @ energy) / self.force

    def tail_energy(self, depth: float) -> float:
        """Return the interface energy beyond the map [output force times h0]."""
        if self.beyond is None:
            return 0.0
        energy = self.law.energy_beyond(self._tail_gap(depth))
        return 8 * self.beyond * float(_WEIGHTS @ energy) / self.force

    def _tail_gap(self, depth: float) -> npt.NDArray:
        assert self.beyond is not None
        half = self.plane.pixel * min(self.plane.shape) / 2
        return np.maximum(
            self.apex + (half / np.cos(_ANGLES)) ** 2 / (2 * self.beyond) - depth, 0.5
        )
