r"""The relaxed contact from which the retraction starts, by depth, force or contact radius.

The search begins at the exact JKR surface, goes downhill in energy, and puts the fine nodes where
the edge was found, until edge and nodes agree: an edge outside the fine zone would be pinned by the
coarse nodes there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from viscotack.bem.equilibrium import descend
from viscotack.bem.halfspace import Surface, half_space
from viscotack.bem.mesh import JKR_UNITS, Grading, jkr_radius
from viscotack.protocol import AtDepth, AtForce, AtRadius
from viscotack.theory import jkr
from viscotack.traction import Traction

# Contact radii of the outputs are in (pi R^2 dg/E0*)^(1/3), this many beta.
RADIUS_UNIT = np.pi ** (1 / 3)
_MOST_MESHES = 200
# A start by force or radius is found to this part of (mu + 1) h0 in depth.
_DEPTH_TOLERANCE = 1e-6
# The edge has been found when it lies within this part of the fine zone around its nodes.
_CENTRED = 0.25


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A relaxed contact: surface, gap and depth [h0], force and contact radius (outputs' units).

    The lattice is the radius [beta] around which its fine nodes lie, a contact edge within a zone.
    """

    surface: Surface
    gap: npt.NDArray
    depth: float
    force: float
    contact_radius: float
    lattice: float


def relaxed_at_depth(
    depth: float,
    law: Traction,
    tabor: float,
    grading: Callable[[float], Grading],
    offset: float = 0.0,
) -> Relaxed:
    """Return the relaxed contact at this depth [h0], on the branch in contact.

    The edge is first looked for at an offset [beta] from that of JKR.

    Raises
    ------
    ValueError
        If no contact exists at this depth: the surfaces have let go of each other.
    """
    mesh_of = grading(depth)
    edge = max(jkr_radius(depth / tabor), np.sqrt(max(depth + 0.2, 0.0) / tabor)) + offset
    surface, gap = None, None
    for _ in range(_MOST_MESHES):
        nodes = mesh_of.nodes(edge, edge)
        if surface is None or gap is None:
            guess = 1 + tabor * np.asarray(jkr.gap(nodes, contact_radius=edge, **JKR_UNITS))
        else:
            guess = np.maximum(CubicSpline(surface.radius, gap)(nodes), 0.8)
        surface = half_space(nodes, tabor)
        balance = descend(surface, law, surface.rigid_gap - depth, 1.0, guess)
        gap = balance.gap
        found = surface.edge(gap, law.edge_gap)
        if not balance.stable or np.isnan(found):
            break
        if abs(found - edge) < _CENTRED * mesh_of.half_width:
            force = surface.force(law, gap)
            return Relaxed(surface, gap, depth, force, found / RADIUS_UNIT, edge)
        edge = found
    raise ValueError(
        f"no relaxed contact exists at a depth of {depth:g} h0 (Tabor number {tabor:g}): "
        "the surfaces do not hold each other there; start deeper"
    )


def _root(
    quantity: Callable[[Relaxed], float],
    wanted: float,
    name: str,
    first_depth: float,
    law: Traction,
    tabor: float,
    grading: Callable[[float], Grading],
) -> Relaxed:
    """Return the relaxed contact at which a quantity that grows with depth has the wanted value."""
    found: dict[float, Relaxed] = {}

    def error(depth: float) -> float:
        # The mesh shifts edges by about the same at all depths: look where the last one was.
        last = list(found.values())[-1:]
        offset = sum(x.lattice - jkr_radius(x.depth / tabor) for x in last)
        found[depth] = relaxed_at_depth(depth, law, tabor, grading, offset if tabor > 1 else 0.0)
        return quantity(found[depth]) - wanted

    scale = tabor + 1.0
    low = high = first_depth
    try:
        span = 0.05 * scale
        while error(low) > 0:
            high, low, span = low, low - span, 1.6 * span
        span = 0.05 * scale
        while error(high) < 0:
            low, high, span = high, high + span, 1.6 * span
    except ValueError:
        least = min((quantity(contact) for contact in found.values()), default=np.nan)
        raise ValueError(
            f"no relaxed contact has a {name} of {wanted:g} (dimensionless); going down in depth "
            f"from the JKR contact, the least that was met is {least:.4g}: start with more"
        ) from None
    if low == high:
        return found[low]
    depth: float = brentq(error, low, high, xtol=_DEPTH_TOLERANCE * scale, maxiter=100)  # type: ignore[assignment]
    return found[depth] if depth in found else relaxed_at_depth(depth, law, tabor, grading)


def relaxed(
    start: AtDepth | AtForce | AtRadius,
    law: Traction,
    tabor: float,
    grading: Callable[[float], Grading],
) -> Relaxed:
    """Return the relaxed contact of a dimensionless start.

    Parameters
    ----------
    start : AtDepth [h0], AtForce [1.5 pi R dg0] or AtRadius [(pi R^2 dg0/E0*)^(1/3)]
        By force: the larger, load-stable contact.
    law : Traction
        Reduced traction law.
    tabor : float
        Tabor number.
    grading : callable
        Gives the grading of the nodes for a depth [h0].

    Raises
    ------
    ValueError
        If no such contact exists.
    """
    if isinstance(start, AtDepth):
        return relaxed_at_depth(start.depth, law, tabor, grading)
    if isinstance(start, AtRadius):
        wanted = start.contact_radius
        first = tabor * float(jkr.depth(wanted * RADIUS_UNIT, **JKR_UNITS))
        return _root(
            lambda x: x.contact_radius, wanted, "contact radius", first, law, tabor, grading
        )
    weakest = -jkr.pull_off_force(radius=1.0, work_of_adhesion=1.0)
    edge = jkr.contact_radius_at_force(max(1.5 * np.pi * start.force, weakest), **JKR_UNITS)
    first = tabor * float(jkr.depth(edge, **JKR_UNITS))
    return _root(lambda x: x.force, start.force, "force", first, law, tabor, grading)
