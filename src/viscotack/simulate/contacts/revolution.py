r"""Contact of revolution: node placement and relaxed initial state.

Lengths along the surface are in :math:`\beta`, of the profile as
:mod:`viscotack.model.problem.revolution` has it; for a sphere :math:`\beta = (R^2
\Delta\gamma_0/E_0^*)^{1/3}`. Gaps and displacements are in h0, pressures in dg/h0 and forces in
dg beta^2/h0: a force F on the nodes moves the surface by mu^2 B F, B being the compliance of the
body with lengths in beta, for E* = 1.

The search for the relaxed contact starts from the exact JKR surface and minimises the energy. The
fine nodes are then moved to the edge found, until edge and nodes agree. An edge outside the fine
zone would be pinned by the coarse nodes there.

**Search for the depth at which a relaxed contact has a given force or radius.** Both quantities
increase with depth above their minimum, which is the force minimum or the end of the contact
branch, whichever is deeper. Smaller depths have larger values or no contact.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy import inf
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from viscotack.errors import InputError
from viscotack.model.geometry import Body, HalfSpace, Sphere
from viscotack.model.geometry.panels import hat_areas, panel_areas
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Start
from viscotack.model.traction import Traction, effective_range
from viscotack.simulate.contacts.contact import Relaxed
from viscotack.simulate.equilibrium import ClosedGap, check_open, descend
from viscotack.simulate.machine import Hold
from viscotack.simulate.mesh import Grading
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Surface, flank_share, interface, least_gap, relaxed_stiffness
from viscotack.theory.elastic import indenter

# Contact radii of the outputs are in (pi R^2 dg/E0*)^(1/3), this many beta.
_RADIUS_UNIT = np.pi ** (1 / 3)
_MOST_MESHES = 200
# Tolerance of the depth of a start by force or radius, as a fraction of the travel.
_DEPTH_TOLERANCE = 1e-6
# At a small Tabor number the gap opens over this part of the distance over which the tip rises by
# the range of the law.
_RISING = 0.2 / np.sqrt(2)
# Overlap of the surfaces, in ranges of the law, above which contact exists without adhesion.
_FIRM = 0.2
# The edge has converged when it lies within this fraction of the fine half width from its centre.
_CENTRED = 0.25


@dataclass(frozen=True)
class RevolutionContact(ABC):
    """A shape on a body, at this Tabor number; see :class:`.contact.Contact`.

    Subclasses implement the methods up to `flank_power`: the profile and its JKR solution.
    """

    tabor: float
    law: Traction
    body: Body = field(default=HalfSpace(), kw_only=True)

    @abstractmethod
    def rise(self, radius: Any) -> Any:
        """Return how far [h0] the indenter is above its lowest point at a radius [beta]."""

    @abstractmethod
    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] at which the indenter has risen by this much [h0]."""

    @abstractmethod
    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""

    @abstractmethod
    def jkr_depth(self, radius: float) -> float:
        """Return the JKR depth [h0] at a contact radius [beta]."""

    @abstractmethod
    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0]; past its end the last there was."""

    @abstractmethod
    def jkr_radius_at_force(self, force: float) -> float:
        """Return the JKR contact radius [beta] at a force [R dg]; past its end the last."""

    @abstractmethod
    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""

    @abstractmethod
    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] with which the relaxed solid pulls off at this edge."""

    @abstractmethod
    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return r/f' over that of a sphere, and r f'/f, of the reduced profile f at a radius."""

    @property
    def span(self) -> float:
        """The range of the law [h0]."""
        return effective_range(self.law)

    @property
    def travel(self) -> float:
        """Travel scale [h0]: about mu h0 for large Tabor numbers, the law's range for small ones.

        On a thin body it is smaller, by the ratio of the elongation by adhesion to a half-space.
        """
        return self.tabor * self._drawn + self.span

    @cached_property
    def _drawn(self) -> float:
        """Elongation by adhesion at contact radius beta, over that of a half-space, at most 1."""
        if self.body == HalfSpace():
            return 1.0
        solid: Any = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
        out = indenter.drawn(1.0, shape=Sphere(1.0), body=self.body, **solid)
        return min(1.0, float(out) / np.sqrt(2 * np.pi))

    @property
    def edge_unit(self) -> float:
        """Contact radii are given in (pi R^2 dg/E0*)^(1/3)."""
        return _RADIUS_UNIT

    @property
    def zone(self) -> float:
        """Length over which the gap opens at a relaxed edge [beta].

        The zone of a crack is 0.75 beta over the square of the range-corrected Tabor number. At
        small Tabor numbers this would exceed the contact; the gap then opens over the distance in
        which the indenter rises by about the range of the law. On a thin body the gap opens over
        the decay length of the body; independent springs have no decay length.
        """
        crack = 0.75 / (self.tabor / self.span) ** 2
        thin = 2 * self.body.decay_length or np.inf
        return float(min(crack, _RISING * self.radius_of_rise(self.span), thin))

    def surface(self, nodes: npt.NDArray) -> Surface:
        """Return the body with these nodes [beta].

        Beyond the last node r the profile is continued as a power law with the exponent
        q = r f'/f at r. The area between two gaps is 1/mu times their difference for a sphere. For
        another shape the factor at r is r/f'; farther out it follows the power law.
        """
        gap, area = 1 + self.rise(nodes), hat_areas(nodes, "revolution")
        face = interface(self.law, area, panel_areas(nodes, "revolution"))
        relaxed = relaxed_stiffness(self.body, "revolution", nodes, face.smoothing)  # for E* = 1
        share, q = self.flank_power(float(nodes[-1]))
        return Surface(
            position=nodes,
            area=area,
            stiffness=relaxed / self.tabor**2,
            rigid_gap=gap,
            unit=2 * self.tabor / (3 * np.pi),  # dg beta^2/h0 in 1.5 pi R dg
            flank=4 / 3 * share * flank_share(self.law, gap[-1], q),  # 4/3: 2 pi R times the energy
            whole=float("nan"),
            interface=face,
        )

    def grading(self, settings: Settings, depth: float) -> Grading:
        """Return the grading of the nodes for a largest depth [h0]."""
        # Nodes pin the edge with an energy that falls exponentially with their number per zone. The
        # energy difference between neighbouring edge positions falls like 1/mu^2.
        catching = 1 + 0.4 * float(np.log10(max(self.tabor / self.span / 10, 1.0)))
        edge = self.jkr_radius(depth)
        # Measure the reach from the plane, or from the edge if adhesion lifts it far above.
        rise = settings.reach * self.span + max(depth, self.rise(edge), 0.0)
        outer = max(self.radius_of_rise(rise), 2.5 * edge)
        fine = settings.grading(self.zone, self.law, outer, more=catching)
        return replace(fine, widest=settings.widest(self.body))

    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed:
        """Return the relaxed state of a dimensionless start; by force, the load-stable contact.

        Raises
        ------
        ValueError
            If no such contact exists.
        """
        if isinstance(start, Apart):
            return self._apart(start, settings)
        if isinstance(start, AtDepth):
            return self._at_depth(start.depth, settings)
        if isinstance(start, AtRadius):
            wanted, unit = start.contact_radius, _RADIUS_UNIT
            first = self.jkr_depth(wanted * unit)
            return self._where(lambda x: x.edge / unit, wanted, "contact radius", first, settings)
        return self._where(lambda x: x.force, start.force, "force", self.deepest(start), settings)

    def deepest(self, start: Start) -> float:
        """Return the approximate depth [h0] of a start, by JKR."""
        if isinstance(start, AtDepth):
            return start.depth
        if isinstance(start, AtForce):
            return self.jkr_depth(self.jkr_radius_at_force(1.5 * np.pi * start.force))
        return self.jkr_depth(start.contact_radius * _RADIUS_UNIT)

    def _apart(self, start: Apart, settings: Settings) -> Relaxed:
        depth = 1 - start.gap
        surface = self.surface(self.grading(settings, 0.0).nodes(0.0, 0.0))
        guess = np.maximum(surface.rigid_gap - depth, self.law.edge_gap)
        balance = descend(surface, self.law, surface.rigid_gap, 1.0, guess, Hold(np.inf, depth))
        if not balance.stable or not np.isnan(surface.edge(balance.gap, self.law.edge_gap)):
            raise InputError(
                f"surfaces {start.gap:g} h0 apart (Tabor number {self.tabor:g}) jump into contact "
                "at rest; start farther away"
            )
        force = surface.force(self.law, balance.gap)
        return Relaxed(surface, balance.gap, depth, force, float("nan"), 0.0)

    def _at_depth(self, depth: float, settings: Settings, offset: float = 0.0) -> Relaxed:
        """Return the contact at this depth [h0]; the search starts at the JKR edge plus offset."""
        law = self.law
        grading = self.grading(settings, depth)
        edge = (
            max(self.jkr_radius(depth), self.bare_radius(max(depth + _FIRM * self.span, 0.0)))
            + offset
        )
        surface, gap = None, None
        for _ in range(_MOST_MESHES):
            nodes = grading.nodes(edge, edge)
            if surface is None or gap is None:
                guess = 1 + self.jkr_gap(nodes, edge)
            else:
                guess = np.maximum(CubicSpline(surface.position, gap)(nodes), least_gap(self.span))
            surface = self.surface(nodes)
            balance = descend(surface, law, surface.rigid_gap, 1.0, guess, Hold(np.inf, depth))
            gap = balance.gap
            if not balance.stable:
                check_open(surface, law, gap, depth, f"Tabor number {self.tabor:g}")
                break
            found = surface.edge(gap, law.edge_gap)
            if np.isnan(found):
                break
            if abs(found - edge) < _CENTRED * grading.half_width:
                return Relaxed(surface, gap, depth, surface.force(law, gap), found, edge)
            edge = found
        raise InputError(
            f"no relaxed contact exists at a depth of {depth:g} h0 (Tabor number {self.tabor:g}): "
            "the surfaces do not hold each other there; start deeper"
        )

    def _where(
        self,
        quantity: Callable[[Relaxed], float],
        wanted: float,
        name: str,
        first_depth: float,
        settings: Settings,
    ) -> Relaxed:
        """Return the contact at which a quantity that grows with depth has the wanted value."""
        found: dict[float, Relaxed] = {}

        def excess(depth: float) -> float:
            # The edge differs from JKR by about the same offset at all depths: reuse the last one.
            last = list(found.values())[-1:]
            offset = sum(x.lattice - self.jkr_radius(x.depth) for x in last)
            offset = offset if self.tabor > 1 else 0.0
            found[depth] = self._at_depth(depth, settings, offset)
            return quantity(found[depth]) - wanted

        scale, what = self.travel, f"a {name} of {wanted:g} (dimensionless)"
        depth = depth_where(excess, first_depth, scale, _DEPTH_TOLERANCE * scale, what)
        if depth is None:
            least = min((quantity(contact) for contact in found.values()), default=np.nan)
            raise InputError(
                f"no relaxed contact has {what}; the least there is, at the end of the branch in "
                f"contact, is {least:.4g}"
            )
        return found[depth]


# First step away from a guess, and growth factor of the following steps.
_FIRST_STEP, _LONGER = 0.05, 1.6
# Maximum number of steps; together they exceed any possible depth of a contact.
_MOST_STEPS = 40
# Fraction of the longer side of a bracket used in a golden-section step.
_GOLDEN = 0.381966
# A minimum has converged when its neighbours exceed it by less than this, in the unit of the
# excess.
_FLAT = 1e-7
# Substitute for the excess where the surfaces are pressed shut. It is larger than any real value,
# finite, and increases with depth, so that the search returns to smaller depths.
_SHUT = 1e9


def depth_where(
    excess: Callable[[float], float], guess: float, scale: float, tolerance: float, wanted: str
) -> float | None:
    """Return the zero of an excess at a depth above its minimum, None if there is no zero.

    Parameters
    ----------
    excess : callable
        Value at a depth minus the wanted value. It raises `ClosedGap` if the surfaces are pressed
        shut, another `InputError` if there is no contact.
    guess : float
        Initial depth.
    scale, tolerance : float
        Depth scale of the excess, and absolute tolerance of the depth.
    wanted : str
        Description of the wanted quantity, for the error message.

    Raises
    ------
    ValueError
        If the surfaces are pressed shut before the wanted value is reached.
    """
    found: dict[float, float] = {}
    shut: dict[float, ClosedGap] = {}

    def seen(depth: float) -> float:
        if depth not in found:
            try:
                found[depth] = float(excess(depth))
            except ClosedGap as reason:
                shut[depth], found[depth] = reason, _SHUT + depth
            except InputError:
                found[depth] = inf
        return found[depth]

    low = _not_above_zero(seen, found, guess, scale, tolerance)
    if low is None:
        return None
    high, step = low, _FIRST_STEP * scale
    while seen(high) <= 0:
        known = [depth for depth in found if depth > high]
        low, high, step = high, min(known, default=high + step), _LONGER * step
    root: float = brentq(seen, low, high, xtol=tolerance, maxiter=100)  # type: ignore[assignment]
    for deeper, reason in shut.items():
        if deeper - root < 2 * tolerance:  # the search ran into it
            raise InputError(f"{wanted} is not reached: {reason}") from reason
    return root


def _not_above_zero(
    seen: Callable[[float], float],
    found: dict[float, float],
    guess: float,
    scale: float,
    tolerance: float,
) -> float | None:
    """Return a depth with an excess of zero or less, None if its minimum is positive."""
    at = guess
    for way in (-1, 1):  # second pass deeper: the guess may lie below the minimum or out of contact
        step = way * _FIRST_STEP * scale
        for _ in range(_MOST_STEPS):
            apart = way > 0 and seen(at) == inf
            if seen(at) <= 0 or not (seen(at + step) < seen(at) or apart):
                break
            at, step = at + step, _LONGER * step
    while seen(at) > 0:
        below = max(depth for depth in found if depth < at)
        above = min(depth for depth in found if depth > at)
        flat = max(seen(below), seen(above)) - seen(at) < _FLAT
        if flat or above - below < tolerance:
            return None
        longer = max(above - at, below - at, key=abs)
        other = at + _GOLDEN * longer
        at = other if seen(other) < seen(at) else at
    return at
