"""What the march asks of a geometry: its surface on any nodes, and where to put them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy.typing as npt

from viscotack.bem.mesh import Grading
from viscotack.bem.settings import Settings
from viscotack.bem.surface import Surface
from viscotack.protocol import Apart, Start
from viscotack.traction import Traction


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A relaxed state: gap, depth [h0], force [output unit] and contact edge, nan without one.

    The lattice is the place around which its fine nodes lie, a contact edge within a zone.
    """

    surface: Surface
    gap: npt.NDArray
    depth: float
    force: float
    edge: float
    lattice: float


class Contact(Protocol):
    """An indenter on a solid; lengths along the surface are in a unit of its own.

    Attributes
    ----------
    law : Traction
        Reduced traction law.
    span : float
        Range of the law [h0]: what it does, it does over this length.
    travel : float
        Depth [h0] over which the contact changes as a whole: what steps are measured by.
    edge_unit : float
        Unit of the outputs for the contact edge, in the unit of the mesh.
    zone : float
        Length over which the gap opens at a relaxed contact edge.
    """

    @property
    def law(self) -> Traction: ...  # noqa: D102
    @property
    def span(self) -> float: ...  # noqa: D102
    @property
    def travel(self) -> float: ...  # noqa: D102
    @property
    def edge_unit(self) -> float: ...  # noqa: D102
    @property
    def zone(self) -> float: ...  # noqa: D102
    def surface(self, nodes: npt.NDArray) -> Surface: ...  # noqa: D102
    def grading(self, settings: Settings, depth: float) -> Grading: ...  # noqa: D102
    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed: ...  # noqa: D102
    def deepest(self, start: Start) -> float: ...  # noqa: D102
    def relaxed_pull_off(self, edge: float) -> float: ...  # noqa: D102
