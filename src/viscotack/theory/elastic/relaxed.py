r"""The JKR contact in which a test starts: relaxed, at a depth, under a force or with a radius.

JKR holds for forces of short range. Two related questions have answers elsewhere. The relaxed
contact of a traction law of finite range, which exists a little beyond the end of JKR's branch, is
computed by the simulation (``viscotack.bem``) and learned from it
(:meth:`viscotack.surrogate.model.Surrogate.start_depth`). The adhesion map
(:mod:`viscotack.theory.elastic.adhesion_map`) shows how far the two differ.

Source: as :mod:`viscotack.theory.elastic.jkr`, :mod:`viscotack.theory.elastic.profiles` and
:mod:`viscotack.theory.elastic.indenter`, whose formulas are used.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from viscotack.arrays import Array
from viscotack.geometry import Cone, PowerLawProfile, Shape, Sphere, equivalent_radius
from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Start
from viscotack.theory._checks import ROUND_OFF

from . import indenter, jkr, profiles
from .jkr import Point

_SPHERE = Sphere(1.0)

# Radii between which a contact is looked for, over the length beta, and their number.
_RADII, _COUNT = (1e-4, 1e6), 600
_TOLERANCE = 1e-13


def contact(
    start: Start | Apart, *, shape: Shape, contact_modulus: float, work_of_adhesion: float
) -> Point | None:
    r"""Compute the relaxed JKR contact of a start; None where JKR has none, and apart.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        Depth [m], force [N, compression positive] or contact radius [m].
    shape : shape of revolution
        A sphere and a power law by their closed forms, any other shape by quadrature.
    contact_modulus, work_of_adhesion : float
        Relaxed :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2].

    Returns
    -------
    Point or None
        Contact radius [m], depth [m] and force [N]. By depth and by radius: the contact that a
        rigid drive holds; None below the depth or the radius of the depth minimum. By force: the
        contact of the larger radius, which a dead load keeps; None below the force minimum. A
        shape with several contacts has the largest.

    Examples
    --------
    >>> lens = dict(shape=Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.15)
    >>> found = contact(AtForce(1e-3), **lens)
    >>> f"{found.contact_radius * 1e6:.0f} um at {found.depth * 1e6:.1f} um"
    '311 um at 7.3 um'
    >>> contact(AtForce(-4e-3), **lens) is None
    True
    """
    if isinstance(start, Apart):
        return None
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    depth, force = curve(shape, **solid)
    if isinstance(shape, Sphere):
        a = _radius_of_sphere(start, {"radius": shape.radius, **solid})
    else:
        adhesion = work_of_adhesion / contact_modulus
        beta = float(np.cbrt(equivalent_radius(shape, adhesion) ** 2 * adhesion))
        match start:
            case AtDepth():
                a = largest_radius(depth, start.depth, length=beta)
            case AtForce():
                a = largest_radius(force, start.force, length=beta)
            case AtRadius():
                radii = _radii(beta)
                least = radii[np.argmin(depth(radii))]
                a = None if start.contact_radius < least else start.contact_radius
    if a is None:
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        deep = start.depth if isinstance(start, AtDepth) else float(depth(a))
        load = start.force if isinstance(start, AtForce) else float(force(a))
    return Point(a, deep, load)


def contact_in_groups(
    start: Start | Apart, *, tabor: float, shape: Shape = _SPHERE
) -> Point | None:
    r"""Compute the contact of :func:`contact` for a start and a shape of dimensionless groups.

    The start is in h0, :math:`\tfrac32 \pi R \Delta\gamma_0` or :math:`(\pi R^2
    \Delta\gamma_0/E_0^*)^{1/3}`; the contact is in the units in which R, :math:`E_0^*` and
    :math:`\Delta\gamma_0` are 1.

    Examples
    --------
    >>> f"{contact_in_groups(AtDepth(10.0), tabor=3.24).contact_radius:.3f}"
    '2.682'
    """
    match start:
        case Apart():
            return None
        case AtDepth():
            scaled = AtDepth(start.depth / tabor)
        case AtForce():
            scaled = AtForce(start.force * (1.5 * np.pi))
        case AtRadius():
            scaled = AtRadius(start.contact_radius * np.pi ** (1 / 3))
    return contact(scaled, shape=shape, contact_modulus=1.0, work_of_adhesion=1.0)


def radius_without_adhesion(start: Start | Apart, *, tabor: float, exponent: float = 2.0) -> float:
    r"""Estimate the radius of a large start [:math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`].

    Hertz's radius, of a power law with another exponent about: nothing is solved, so that any
    number has an answer, and starts that are too large are refused before anything is.

    Examples
    --------
    >>> f"{radius_without_adhesion(AtDepth(1e6), tabor=3.24):.0f}"
    '379'
    """
    match start:
        case AtDepth():
            return float((max(start.depth, 0.0) / tabor) ** (1 / exponent) / np.cbrt(np.pi))
        case AtForce():
            return float((9 / 8 * max(start.force, 0.0)) ** (1 / (exponent + 1)))
        case AtRadius():
            return start.contact_radius
        case Apart():
            return 0.0


def curve(
    shape: Shape, *, contact_modulus: float, work_of_adhesion: float
) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return JKR's depth [m] and force [N] as functions of the contact radius [m]."""
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    match shape:
        case Sphere():
            theory, of = jkr, {"radius": shape.radius}
        case PowerLawProfile() | Cone():
            theory, of = profiles, {"exponent": shape.exponent, "coefficient": shape.coefficient}
        case _:
            theory, of = indenter, {"shape": shape}
    return partial(theory.depth, **of, **solid), partial(theory.force, **of, **solid)


def largest_radius(
    function: Callable[[Any], Any], value: float, *, length: float = 1.0
) -> float | None:
    r"""Compute the largest radius at which a depth or a force has a value; None for no such radius.

    Parameters
    ----------
    function : callable
        Of radii, ascending beyond the largest root.
    value : float
        The wanted depth or force.
    length : float
        Scale of the radii, :math:`\beta`; from 1e-4 to 1e6 of it are searched.
    """
    radii = _radii(length)
    below = np.flatnonzero(function(radii) <= value)
    if not below.size or below[-1] == radii.size - 1:
        return None
    ends = radii[below[-1]], radii[below[-1] + 1]
    return float(brentq(lambda a: function(a) - value, *ends, xtol=_TOLERANCE * length))  # type: ignore[arg-type]


def _radii(length: float) -> Array:
    return length * np.geomspace(*_RADII, _COUNT)


def _radius_of_sphere(start: Start, case: dict[str, float]) -> float | None:
    """Return the contact radius by the closed forms, None past the end of the branch."""
    fold = jkr.instability(**case)
    match start:
        case AtDepth(depth=value):
            least, found = fold.depth, jkr.contact_radius_at_depth
        case AtForce(force=value):
            least, found = jkr.pull_off(**case).force, jkr.contact_radius_at_force
        case AtRadius(contact_radius=value):
            return None if value < fold.contact_radius else value
    return None if value < least * (1 + ROUND_OFF) else float(found(value, **case))
