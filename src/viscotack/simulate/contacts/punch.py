r"""Contact of a flat punch in plane strain: surface, node placement and relaxed initial state.

Lengths along the surface are in :math:`a_0 = \pi E_0^* \Delta\gamma_0/(2 \sigma_0^2)`. With
:math:`\hat\sigma = \sigma_0 h_0/\Delta\gamma_0`, a pressure of 1 dg/h0 on a length a_0 moves the
surface by :math:`\pi/(2 \hat\sigma^2)` h0 times the influence for E* = 1.

Cracks start at the ends of the punch, so the nodes are finest there and follow the crack inwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.geometry import Body, Layer
from viscotack.model.geometry.panels import hat_areas, panel_areas
from viscotack.model.protocol import Apart, AtDepth, AtForce, Start
from viscotack.model.traction import Traction, effective_range
from viscotack.simulate.contacts.contact import Relaxed
from viscotack.simulate.contacts.revolution import depth_where
from viscotack.simulate.equilibrium import check_open, descend
from viscotack.simulate.machine import Hold
from viscotack.simulate.mesh import Grading
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Surface, interface, relaxed_stiffness

# Number of nodes used to evaluate the compliance of a body that is not a layer.
_COARSE = 33
# Tolerance of the depth of a start by force, as a fraction of the travel.
_DEPTH_TOLERANCE = 1e-8


@dataclass(frozen=True)
class PunchContact:
    """A punch of this half width [a0] on a body with lengths in a0; see `contact.Contact`."""

    size: float
    body: Body
    law: Traction

    @property
    def span(self) -> float:
        """The range of the law [h0]."""
        return effective_range(self.law)

    @cached_property
    def thickness(self) -> float:
        """Thickness of the layer [a0], for other bodies of an equally compliant sliding layer."""
        if isinstance(self.body, Layer):
            return self.body.thickness
        nodes = self.size * np.linspace(0.0, 1.0, _COARSE)
        return float(np.sum(self.body.influence(nodes, "plane")[0]))

    @property
    def travel(self) -> float:
        """Travel scale [h0]: a thin layer is stretched by about sqrt(3 b/a0) ranges at pull-off."""
        return self.span * (1 + float(np.sqrt(3 * min(self.thickness, self.size))))

    @property
    def edge_unit(self) -> float:
        """Lengths are given in a0."""
        return 1.0

    @property
    def zone(self) -> float:
        """Length over which the gap opens at a slow crack [a0], at most that of the layer.

        Independent springs have no decay length; the zone is then that of the crack.
        """
        crack = 1.5 * (self.law.strength * self.span) ** 2 / np.pi
        return min(crack, 2 * self.body.decay_length or crack)

    def surface(self, nodes: npt.NDArray) -> Surface:
        """Return the body with these nodes [a0]."""
        strength, area = self.law.strength, hat_areas(nodes, "plane")
        face = interface(self.law, area, panel_areas(nodes, "plane"))
        relaxed = relaxed_stiffness(self.body, "plane", nodes, face.smoothing)  # for E* = 1
        return Surface(
            position=nodes,
            area=area,
            stiffness=relaxed * (2 * strength**2 / np.pi),
            rigid_gap=np.ones(len(nodes)),
            unit=1 / (2 * self.size * strength),  # a0 dg/h0 in 2 a sigma0
            flank=0.0,
            whole=self.size,
            interface=face,
        )

    def grading(self, settings: Settings, depth: float) -> Grading:
        """Return the grading of the nodes; the depth does not matter to it."""
        return settings.grading_to_end(self.zone, self.law, self.size, self.body)

    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed:
        """Return the relaxed state of a dimensionless start, the whole punch in contact.

        Raises
        ------
        ValueError
            If no such contact exists.
        """
        if isinstance(start, Apart):
            return self._at_depth(1 - start.gap, settings, apart=True)
        if isinstance(start, AtDepth):
            return self._at_depth(start.depth, settings)
        assert isinstance(start, AtForce)

        resolved = self.size - self.grading(settings, 0.0).half_width

        def excess(depth: float) -> float:
            found = self._at_depth(depth, settings)
            if found.edge < resolved:
                # under a given force such a long crack is unstable; only coarse nodes would pin it
                raise InputError("the punch has detached")
            return found.force - start.force

        tolerance, wanted = (
            _DEPTH_TOLERANCE * self.travel,
            f"a mean stress of {start.force:g} sigma0",
        )
        depth = depth_where(excess, 0.0, self.travel, tolerance, wanted)
        if depth is None:
            raise InputError(
                f"no relaxed contact bears {wanted}: the punch detaches before; start with more"
            )
        return self._at_depth(depth, settings)

    def deepest(self, start: Start) -> float:
        """Return the approximate depth [h0] of a start, for an elastic foundation."""
        if isinstance(start, AtForce):
            give = np.pi / (2 * self.law.strength) * min(self.thickness, self.size)
            return give * start.force
        # the ligament at the end of a move does not determine a depth
        return start.depth if isinstance(start, AtDepth) else 0.0

    def relaxed_pull_off(self, edge: float) -> float:
        """Return 0, because the force of a punch has no second peak.

        The contact does not grow with the depth. The tension therefore grows at a constant rate
        until the crack runs, and the crack does not stop. None of 150 random punches
        had a second peak.
        """
        return 0.0

    def _at_depth(self, depth: float, settings: Settings, *, apart: bool = False) -> Relaxed:
        surface = self.surface(self.grading(settings, depth).nodes(self.size, self.size))
        guess = np.full(len(surface.position), 1 - depth if apart else 1.0)
        if apart and guess[0] <= self.law.edge_gap:
            raise InputError(f"surfaces {1 - depth:g} h0 apart are in contact; start farther away")
        balance = descend(surface, self.law, surface.rigid_gap, 1.0, guess, Hold(np.inf, depth))
        if not balance.stable:
            of = f"thickness {self.thickness:g} a0"
            check_open(surface, self.law, balance.gap, depth, of)
        edge = surface.edge(balance.gap, self.law.edge_gap)
        if not balance.stable or np.isnan(edge) != apart:
            raise InputError(
                f"no relaxed contact exists at a depth of {depth:g} h0 (thickness "
                f"{self.thickness:g} a0): the punch has detached there; start deeper"
                if not apart
                else f"surfaces {1 - depth:g} h0 apart (thickness {self.thickness:g} a0) jump "
                "into contact at rest; start farther away"
            )
        force = surface.force(self.law, balance.gap)
        return Relaxed(surface, balance.gap, depth, force, edge, self.size)
