"""Contact of a disc and a body: mesh up to the disc edge, whole disc in contact at rest.

Lengths along the surface are in units of the disc radius. With a sharp edge, the contact covers the
whole disc until a crack from the edge detaches it in one jump: JKR has no stable smaller contact
(Kendall).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.geometry import Disc, Layer
from viscotack.model.protocol import Apart, AtForce, AtRadius, Start
from viscotack.simulate.contacts.contact import Relaxed
from viscotack.simulate.contacts.shape import ShapeContact
from viscotack.simulate.mesh import Grading
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Surface
from viscotack.theory.elastic import on_layer

# Upper bound of the depth [h0] in any test of a disc.
_DEEPEST = 1e7


@dataclass(frozen=True)
class DiscContact(ShapeContact):
    """A reduced disc; see :class:`viscotack.simulate.contacts.contact.Contact`."""

    shape: Disc

    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] of the disc, the end of its profile."""
        return self.shape.radius

    @property
    def _known(self) -> float:
        """Infinity: the edge of a disc limits its contact, not its known range."""
        return np.inf

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        if self.shape.is_sharp:
            return self.shape.radius if depth > 0 else 0.0
        return min(super().bare_radius(depth), self.shape.radius)

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0], at most that of the disc."""
        radius = self.shape.radius
        return radius if self.shape.is_sharp else min(super().jkr_radius(depth), radius)

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""
        if radius >= self.shape.radius:
            return np.zeros_like(nodes)
        return super().jkr_gap(nodes, radius)

    @property
    def _stiffness(self) -> float:
        """Return the force per depth of the whole disc, for E* = 1 [beta]."""
        if isinstance(self.body, Layer):
            return float(on_layer.stiffness(np.array(self.shape.radius), self.body))
        return 2 * self.shape.radius

    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] at the strength of the law on a contact of this radius.

        An upper bound whatever the work of adhesion, which decides the force of a disc at an edge.
        """
        if not edge > 0:
            return 0.0
        return np.pi * edge**2 * self.law.strength * 2 * self.tabor / (3 * np.pi)

    def deepest(self, start: Start) -> float:
        """Return the depth [h0] of a start; at given force that of the whole disc."""
        if isinstance(start, AtForce):
            return self.tabor * 1.5 * np.pi * start.force / self._stiffness
        return _DEEPEST if isinstance(start, AtRadius) else super().deepest(start)

    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed:
        """Return the relaxed state of a start; reject a start by radius for a sharp edge."""
        if isinstance(start, AtRadius) and self.shape.is_sharp:
            raise InputError(
                "a disc with a sharp edge is in contact as a whole: start it at a depth or a force"
            )
        return super().relaxed(start, settings)

    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return 0, because the disc has no flank, and an arbitrary exponent."""
        return 0.0, 2.0

    def surface(self, nodes: npt.NDArray) -> Surface:
        """Return the body with these nodes [beta], the last at the end of the disc."""
        return replace(super().surface(nodes), whole=self.shape.radius)

    def grading(self, settings: Settings, depth: float) -> Grading:
        """Return the grading of the nodes, which end with the disc."""
        return settings.grading_to_end(self.zone, self.law, self.shape.radius, self.body)

    def _jkr_depth(self, start: AtForce) -> float:
        return self.deepest(start)
