r"""Contact of a sphere or a power-law tip and the half-space, with the closed-form JKR solution.

**Contact of a power-law tip and the half-space: differences to the sphere.** Lengths along the
surface are in :math:`\beta` with :math:`\beta^{2q-1} = \Delta\gamma_0/(E_0^* (qA)^2)`; with
:math:`\mu = q A \beta^q/h_0` the discrete surface is that of the sphere under the rigid gap
:math:`1 + \mu r^q/q`. Depths of JKR are in :math:`\mu h_0`, as for the sphere.

The mesh is not refined at a sharp tip. The pressure of a cone is singular there like the logarithm
of the distance, on an area that is negligible for the force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import hyp2f1

from viscotack.simulate.contacts.revolution import RevolutionContact
from viscotack.simulate.contacts.shape import inverse
from viscotack.theory import jkr, profiles

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


@dataclass(frozen=True)
class ProfileContact(SphereContact):
    """A tip z = A r^q of this Tabor number; see :class:`.contact.Contact`."""

    exponent: float

    @property
    def _units(self) -> dict[str, float]:
        # lengths along the surface in beta, depths in mu h0, forces in R dg
        tip = {"exponent": self.exponent, "coefficient": 1 / self.exponent}
        return tip | {"contact_modulus": 1.0, "work_of_adhesion": 1.0}

    def rise(self, radius: float | npt.NDArray) -> float | npt.NDArray:
        """Return how far [h0] the indenter is above its lowest point at a radius [beta]."""
        return self.tabor * radius**self.exponent / self.exponent

    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] at which the indenter has risen by this much [h0]."""
        return (self.exponent * rise / self.tabor) ** (1 / self.exponent)

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        return (depth / self._bare_depth()) ** (1 / self.exponent)

    def bare_force(self, radius: float) -> float:
        """Return the force [R dg] that presses a contact of this radius [beta] by Sneddon."""
        adhesion = np.sqrt(8 * np.pi * radius**3)
        return float(profiles.force(radius, **self._units) + adhesion)

    @property
    def critical_share(self) -> float:
        """Pull-off force over `bare_force` at its radius, whatever the work of adhesion.

        That grows like a^(q+1), the part of adhesion like a^(3/2): their sum is least where it is
        this share of the first.
        """
        return (2 * self.exponent - 1) / 3

    def jkr_depth(self, radius: float) -> float:
        """Return the JKR depth [h0] at a contact radius [beta]."""
        return self.tabor * float(profiles.depth(radius, **self._units))

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0]; past its end the last there was."""
        return inverse(
            self.jkr_depth, depth, float(profiles.instability(**self._units).contact_radius)
        )

    def jkr_radius_at_force(self, force: float) -> float:
        """Return the JKR contact radius [beta] at a force [R dg]; past its end the last."""
        units = self._units
        end = float(profiles.pull_off(**units).contact_radius)
        return inverse(lambda a: float(profiles.force(a, **units)), force, end)

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        r"""Return the JKR gap [h0] around a contact of this radius [beta].

        With Sneddon's displacement outside a contact of depth :math:`\delta`,

        .. math:: u(r) = \frac{2}{\pi} \left[ \delta \arcsin\frac{a}{r}
                  - \int_0^a \frac{A \kappa t^q}{\sqrt{r^2 - t^2}}\, dt \right]
        """
        q, r = self.exponent, np.maximum(nodes, radius)
        ratio = radius / r
        hollow = self._bare_depth() * radius**q * ratio / (q + 1)
        hollow = hollow * hyp2f1(0.5, (q + 1) / 2, (q + 3) / 2, ratio**2)
        depth = self.jkr_depth(radius)
        gap = self.rise(r) - depth + 2 / np.pi * (depth * np.arcsin(ratio) - hollow)
        return np.maximum(gap, 0.0)  # but for round-off it is not negative

    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return r^(2-q), and q."""
        return radius ** (2 - self.exponent), self.exponent

    def _bare_depth(self) -> float:
        """Return the depth [h0] of a contact of radius beta without adhesion."""
        units = self._units
        return self.tabor * (float(profiles.depth(1.0, **units)) + np.sqrt(2 * np.pi))
