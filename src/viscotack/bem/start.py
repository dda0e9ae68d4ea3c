r"""The relaxed contact from which the retraction starts, by depth, force or contact radius.

The search begins at the exact JKR surface (in units in which R = E* = dg = 1 lengths are in beta and
displacements in mu h0), goes downhill in energy, and puts the fine nodes where the edge was found, until
edge and nodes agree: an edge outside the fine zone would be pinned by the coarse nodes there.
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
from viscotack.bem.mesh import Grading, edge_zone
from viscotack.protocol import AtDepth, AtForce, AtRadius
from viscotack.traction import Traction

# Contact radii of the outputs are in (pi R^2 dg/E0*)^(1/3), this many beta.
RADIUS_UNIT = np.pi ** (1 / 3)
_MOST_MESHES = 40


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A relaxed contact: its surface, gap [h0], depth [h0], force and contact radius (outputs' units).

    The lattice is the radius [beta] around which its fine nodes lie, a contact edge within a zone.
    """

    surface: Surface
    gap: npt.NDArray
    depth: float
    force: float
    contact_radius: float
    lattice: float


def _jkr_depth(a: float) -> float:
    """Return the JKR depth [mu h0] at a contact radius [beta]."""
    return a * a - np.sqrt(2 * np.pi * a)


def _jkr_radius(depth: float) -> float:
    """Return the JKR contact radius [beta] on the stable branch at a depth [mu h0]."""
    turn = (np.pi / 8) ** (1 / 3)  # the smallest depth, where the branch ends
    if depth <= _jkr_depth(turn):
        return turn
    return float(brentq(lambda a: _jkr_depth(a) - depth, turn, np.sqrt(abs(depth)) + 4.0))


def _jkr_gap(r: npt.NDArray, a: float, tabor: float) -> npt.NDArray:
    """Return the gap [h0] around a JKR contact: h0 in contact, then Hertz plus a flat punch."""
    x = np.maximum(r / a, 1.0)
    opening = np.arccos(1 / x)
    hertz = a * a / np.pi * (np.sqrt(x * x - 1) + (x * x - 2) * opening)
    punch = np.sqrt(2 * np.pi * a) * 2 / np.pi * opening
    return 1 + tabor * (hertz + punch)


def relaxed_at_depth(
    depth: float, law: Traction, tabor: float, grading: Callable[[float], Grading]
) -> Relaxed:
    """Return the relaxed contact at this depth [h0], on the branch in contact.

    Raises
    ------
    ValueError
        If no contact exists at this depth: the surfaces have let go of each other.
    """
    zone, mesh_of = edge_zone(tabor), grading(depth)
    edge = max(_jkr_radius(depth / tabor), np.sqrt(max(depth + 0.2, 0.0) / tabor))
    surface, gap = None, None
    for _ in range(_MOST_MESHES):
        nodes = mesh_of.nodes(edge, edge)
        if surface is None or gap is None:
            guess = _jkr_gap(nodes, edge, tabor)
        else:
            guess = np.maximum(CubicSpline(surface.radius, gap)(nodes), 0.8)
        surface = half_space(nodes, tabor)
        balance = descend(surface, law, surface.rigid_gap - depth, 1.0, guess)
        gap = balance.gap
        found = surface.edge(gap, law.edge_gap)
        if not balance.stable or np.isnan(found):
            break
        if abs(found - edge) < 0.5 * zone:
            force = surface.force(law, gap)
            return Relaxed(surface, gap, depth, force, found / RADIUS_UNIT, edge)
        edge = found
    raise ValueError(
        f"no relaxed contact exists at a depth of {depth:g} h0 (Tabor number {tabor:g}): the surfaces "
        "do not hold each other there; start deeper"
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
        found[depth] = relaxed_at_depth(depth, law, tabor, grading)
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
            f"no relaxed contact has a {name} of {wanted:g}; the least that was found is {least:.4g}"
        ) from None
    if low == high:
        return found[low]
    depth = float(brentq(error, low, high, xtol=1e-9 * scale, rtol=1e-9, maxiter=100))
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
        first = tabor * _jkr_depth(wanted * RADIUS_UNIT)
        return _root(
            lambda x: x.contact_radius, wanted, "contact radius", first, law, tabor, grading
        )
    # P/(pi R dg) = 4/3 a^3 - sqrt(8 a^3): a^(3/2) is the larger root of a quadratic.
    root = (np.sqrt(8) + np.sqrt(max(8 + 8 * start.force, 0.0))) * 3 / 8
    first = tabor * _jkr_depth(root ** (2 / 3) * RADIUS_UNIT)
    return _root(lambda x: x.force, start.force, "force", first, law, tabor, grading)
