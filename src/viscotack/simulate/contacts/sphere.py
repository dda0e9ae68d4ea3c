"""Contact of a sphere and the half-space, with the closed-form JKR solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.simulate.contacts.revolution import RevolutionContact
from viscotack.theory import jkr

# In these units JKR lengths are in beta, depths and gaps in mu h0, forces in R dg.
_JKR_UNITS = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}


@dataclass(frozen=True)
class SphereContact(RevolutionContact):
    """A sphere; see :class:`viscotack.simulate.contacts.contact.Contact`."""

    def rise(self, radius: Any) -> Any:
        """Return how far [h0] the indenter is above its lowest point at a radius [beta]."""
        return self.tabor * radius * radius / 2

    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] at which the indenter has risen by this much [h0]."""
        return float(np.sqrt(2 * rise / self.tabor))

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        return float(np.sqrt(depth / self.tabor))

    def jkr_depth(self, radius: float) -> float:
        """Return the JKR depth [h0] at a contact radius [beta]."""
        return self.tabor * float(jkr.depth(radius, **_JKR_UNITS))

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0]; past its end the last there was."""
        last = jkr.instability(**_JKR_UNITS)
        # at the minimum of the depth its inverse has the square root of round-off
        if depth / self.tabor <= last.depth:
            return float(last.contact_radius)
        return float(jkr.contact_radius_at_depth(depth / self.tabor, **_JKR_UNITS))

    def jkr_radius_at_force(self, force: float) -> float:
        """Return the JKR contact radius [beta] at a force [R dg]; past its end the last."""
        weakest = -jkr.pull_off_force(radius=1.0, work_of_adhesion=1.0)
        return float(jkr.contact_radius_at_force(max(force, weakest), **_JKR_UNITS))

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""
        return self.tabor * np.asarray(jkr.gap(nodes, contact_radius=radius, **_JKR_UNITS))

    def bare_force(self, radius: float) -> float:
        """Return the force [R dg] that presses a contact of this radius [beta] by Hertz."""
        return 4 / 3 * radius**3

    @property
    def critical_share(self) -> float:
        """Pull-off force over `bare_force` at its radius: 1 by JKR, whatever the work."""
        return 1.0

    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] with which the relaxed solid pulls off at this edge.

        A JKR contact pulls off when the Hertz force at its radius equals the pull-off force. This
        holds for any work of adhesion, so also for a crack that needs more work. The edge, defined
        at the largest tension, lies outside such a contact, where the indenter has risen by half
        the range of the law. The force is 0 without an edge.
        """
        pressed = self.rise(edge) - 0.5 * self.span if edge > 0 else 0.0
        if not pressed > 0:
            return 0.0
        force = self.bare_force(self.radius_of_rise(pressed))
        return self.critical_share * force / (1.5 * np.pi)

    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return 1, and the exponent 2 of a paraboloid."""
        return 1.0, 2.0
