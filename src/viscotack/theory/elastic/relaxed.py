r"""Relaxed JKR contact at the start of a test: at a depth, under a force or with a radius.

JKR holds for forces of short range. The relaxed
contact of a traction law of finite range, which exists slightly beyond the end of JKR's branch, is
computed by the simulation (``viscotack.simulate``) and approximated by a surrogate
(:meth:`viscotack.prediction.surrogate.model.Surrogate.start_depth`). The adhesion map
(:mod:`viscotack.theory.elastic.adhesion_map`) shows the difference between the two.

Source: as :mod:`viscotack.theory.elastic.jkr`, :mod:`viscotack.theory.elastic.profiles` and
:mod:`viscotack.theory.elastic.indenter`, whose formulas are used.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.model.geometry import (
    Body,
    Cone,
    HalfSpace,
    Layer,
    PowerLawProfile,
    Shape,
    Sphere,
    detail,
    end,
    equivalent_radius,
)
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Start
from viscotack.theory._checks import ROUND_OFF, positive
from viscotack.theory._roots import least

from . import indenter, jkr, on_layer, profiles
from .jkr import Point

_SPHERE, _HALF_SPACE = Sphere(1.0), HalfSpace()
# Range of radii of the search, over the length beta, and their number.
_RADII, _COUNT = (1e-4, 1e6), 600
_TOLERANCE = 1e-13
# Their number on another body than the half-space, and per detail of a shape.
_FEWER, _PER_DETAIL = 200, 8
# Radii among which the strongest contact is searched for, over the largest one, and their number.
_SMALLEST, _LOOKS = 1e-3, 60
# Factor on a radius at which the theory must still hold.
_BESIDE_END = 1.05
# Logarithms of the ends, over beta, between which the minima of a shape without details lie.
_NEAR = (-5.0, 5.0)


def contact(
    start: Start | Apart,
    *,
    shape: Shape,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Point | None:
    r"""Compute the relaxed JKR contact of a start; None if there is none, or for surfaces apart.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        Depth [m], force [N, compression positive] or contact radius [m].
    shape : shape of revolution
        A sphere and a power law by their closed forms, any other shape by quadrature.
    contact_modulus, work_of_adhesion : float
        Relaxed :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    body : Body
        The deformable body.

    Returns
    -------
    Point or None
        Contact radius [m], depth [m] and force [N]. By depth and by radius: the contact that is
        stable with a rigid drive; None below the depth or the radius of the depth minimum. By
        force: the contact of the larger radius, stable under a dead load; None below the force
        minimum. If a shape has several contacts, the largest is returned.

    Raises
    ------
    InputError
        If modulus or work of adhesion is not positive and finite, or the contact is too wide
        for the theory of its layer, as in :func:`.indenter.depth`.

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
    theory, case = _theory(shape, body, solid)
    if isinstance(start, AtRadius):
        fold, _ = ends(shape, body=body, **solid)
        a = start.contact_radius if start.contact_radius >= fold.contact_radius else None
    elif theory is jkr:
        # None past the end of the branch
        if isinstance(start, AtDepth):
            last, of = jkr.instability(**case).depth, jkr.contact_radius_at_depth
        else:
            last, of = jkr.pull_off(**case).force, jkr.contact_radius_at_force
        is_past = start.value < np.asarray(last) * (1 + ROUND_OFF)
        a = None if is_past else float(np.asarray(of(start.value, **case)))
    else:
        by = theory.depth if isinstance(start, AtDepth) else theory.force
        value = start.depth if isinstance(start, AtDepth) else start.force
        radii = _radii(shape, body, adhesion_length(shape, **solid))
        a = _largest_among(radii, partial(by, **case), value)
    if a is None:
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        deep = start.depth if isinstance(start, AtDepth) else float(theory.depth(a, **case))
        load = start.force if isinstance(start, AtForce) else float(theory.force(a, **case))
    return Point(a, deep, load)


def ends(
    shape: Shape, *, contact_modulus: float, work_of_adhesion: float, body: Body = _HALF_SPACE
) -> tuple[Point, Point]:
    r"""Compute the contacts of the smallest depth and of the smallest force, the limits of JKR.

    A rigid drive detaches at the first, a dead load at the second. For a shape without closed forms
    radii near its length :math:`\beta` are searched, to five digits.

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter.
    contact_modulus, work_of_adhesion : float
        Relaxed :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    body : HalfSpace, Layer or a user-defined body
        Elastic body.

    Returns
    -------
    tuple of Point
        Contact radius [m], depth [m] and force [N] of the least depth and of the least force.

    Raises
    ------
    InputError
        If modulus or work of adhesion is not positive and finite, or the contact is too wide
        for the theory of its layer, as in :func:`.indenter.depth`.

    Examples
    --------
    >>> least_depth, least_force = ends(Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.15)
    >>> f"{least_depth.depth * 1e6:.2f} um, {least_force.force * 1e3:.2f} mN"
    '-4.89 um, -3.53 mN'
    """
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    theory, case = _theory(shape, body, solid)
    if theory is not indenter:
        return theory.instability(**case), theory.pull_off(**case)
    depth, force = curve(shape, body=body, **solid)
    length = adhesion_length(shape, **solid)
    if np.isinf(detail(shape)) and isinstance(body, HalfSpace):
        brackets = [length * np.exp(_NEAR)] * 2
    else:
        looks = _radii(shape, body, length)
        least_at = [int(np.argmin(function(looks))) for function in (depth, force)]
        brackets = [looks[[max(i - 1, 0), min(i + 1, looks.size - 1)]] for i in least_at]
    radii = [least(*each) for each in zip((depth, force), brackets, strict=True)]
    if isinstance(body, Layer) and not on_layer.is_power(body):
        force(max(radii) * _BESIDE_END)  # an error if the least lies beyond the radii of the theory
    fold, end = (Point(a, float(depth(a)), float(force(a))) for a in radii)
    return fold, end


def strongest(
    shape: Shape,
    *,
    largest: float,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Point:
    r"""Compute the contact of the smallest force among those up to a radius.

    It is the pull-off of a contact that begins there and only shrinks, or of a disc of this radius.

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter.
    largest : float
        Largest contact radius [m], positive.
    contact_modulus, work_of_adhesion : float
        Relaxed :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    body : HalfSpace, Layer or a user-defined body
        Elastic body.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N, negative in tension].

    Raises
    ------
    InputError
        If a number is not positive and finite, or the contact is too wide for the theory of its
        layer, as in :func:`.indenter.depth`.

    Examples
    --------
    >>> lens = dict(contact_modulus=2e6, work_of_adhesion=0.15)
    >>> small, large = (strongest(Sphere(5e-3), largest=a, **lens) for a in (1e-4, 1e-3))
    >>> f"{small.force * 1e3:.2f} mN, {large.force * 1e3:.2f} mN"
    '-2.21 mN, -3.53 mN'
    """
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    positive(largest=largest, **solid)
    depth, force = curve(shape, body=body, **solid)
    radii = largest * np.geomspace(_SMALLEST, 1.0, _LOOKS)
    if np.isfinite(detail(shape)):
        many = int(np.clip(_PER_DETAIL * largest / detail(shape), 2, _FEWER))
        radii = np.unique(np.append(radii, largest * np.arange(1, many + 1) / many))
    values = np.asarray(force(radii))
    at = int(np.argmin(values))
    near = radii[max(at - 1, 0)], radii[min(at + 1, radii.size - 1)]
    found = least(force, near)
    a = found if force(found) < values[at] else float(radii[at])
    return Point(a, float(depth(a)), float(force(a)))


def contact_in_groups(
    start: Start | Apart, *, tabor: float, shape: Shape = _SPHERE, body: Body = _HALF_SPACE
) -> Point | None:
    r"""Compute the contact of :func:`contact` for a start and a shape of dimensionless groups.

    The contact is in the units in which R, :math:`E_0^*` and :math:`\Delta\gamma_0` are 1.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        Depth [h0], force [:math:`\tfrac32 \pi R \Delta\gamma_0`, compression positive] or
        contact radius [:math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`].
    tabor : float
        Tabor number, positive.
    shape : shape of revolution
        Indenter with R = 1.
    body : Body
        Elastic body; the thickness of a layer is in :math:`\beta`.

    Raises
    ------
    InputError
        If the Tabor number is not positive and finite, or the contact is too wide for the theory of
        its layer, as in :func:`.indenter.depth`.

    Examples
    --------
    >>> f"{contact_in_groups(AtDepth(10.0), tabor=3.24).contact_radius:.3f}"
    '2.682'
    """
    positive(tabor=tabor)
    match start:
        case Apart():
            return None
        case AtDepth():
            scaled = AtDepth(start.depth / tabor)
        case AtForce():
            scaled = AtForce(start.force * (1.5 * np.pi))
        case AtRadius():
            scaled = AtRadius(start.contact_radius * np.pi ** (1 / 3))
    return contact(scaled, shape=shape, contact_modulus=1.0, work_of_adhesion=1.0, body=body)


def radius_without_adhesion(start: Start | Apart, *, tabor: float, exponent: float = 2.0) -> float:
    r"""Estimate the radius of a large start [:math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`].

    This is the Hertz radius, approximate for an exponent of the profile other than 2. It is
    explicit, so starts that are too large can be rejected before anything is solved.

    Parameters
    ----------
    start : AtDepth, AtForce, AtRadius or Apart
        In the units of :func:`contact_in_groups`.
    tabor : float
        Tabor number, positive.
    exponent : float
        Exponent of the profile, 2 for a sphere, positive.

    Raises
    ------
    InputError
        If Tabor number or exponent is not positive and finite.

    Examples
    --------
    >>> f"{radius_without_adhesion(AtDepth(1e6), tabor=3.24):.0f}"
    '379'
    """
    positive(tabor=tabor, exponent=exponent)
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
    shape: Shape, *, contact_modulus: float, work_of_adhesion: float, body: Body = _HALF_SPACE
) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    r"""Return JKR's depth [m] and force [N] as functions of the contact radius [m].

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter.
    contact_modulus, work_of_adhesion : float
        Relaxed :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    body : HalfSpace, Layer or a user-defined body
        Elastic body.

    Examples
    --------
    >>> depth, force = curve(Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.15)
    >>> f"{depth(3e-4) * 1e6:.2f} um, {force(3e-4) * 1e3:.2f} mN"
    '6.11 um, 0.13 mN'
    """
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    theory, case = _theory(shape, body, solid)
    return partial(theory.depth, **case), partial(theory.force, **case)


def adhesion_length(shape: Shape, *, contact_modulus: float, work_of_adhesion: float) -> float:
    r"""Return the length [m] at which adhesion and elasticity balance.

    .. math:: \beta = (R^2 \Delta\gamma_0/E_0^*)^{1/3}

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter; R is its equivalent radius
        (:func:`viscotack.model.geometry.equivalent_radius`).
    contact_modulus, work_of_adhesion : float
        :math:`E_0^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.

    Raises
    ------
    InputError
        If modulus or work of adhesion is not positive and finite.

    Examples
    --------
    >>> length = adhesion_length(Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.15)
    >>> f"{length * 1e6:.0f} um"
    '123 um'
    """
    positive(contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion)
    adhesion = work_of_adhesion / contact_modulus
    return float(np.cbrt(equivalent_radius(shape, adhesion) ** 2 * adhesion))


def largest_radius(
    function: Callable[[Any], Any], value: float, *, length: float = 1.0
) -> float | None:
    r"""Compute the largest radius at which a depth or a force has a value, or None.

    Parameters
    ----------
    function : callable
        Function of radii, increasing beyond the largest root.
    value : float
        Required depth or force.
    length : float
        Scale of the radii, :math:`\beta`; from 1e-4 to 1e6 of it are searched.

    Returns
    -------
    float or None
        Radius in the unit of `length`.

    Examples
    --------
    >>> f"{largest_radius(lambda a: a**2 - 1, 3.0):.3f}"
    '2.000'
    """
    return _largest_among(length * np.geomspace(*_RADII, _COUNT), function, value)


def _largest_among(radii: Array, function: Callable[[Any], Any], value: float) -> float | None:
    """Find the largest radius of a value between ascending radii; None if there is none."""
    below = np.flatnonzero(function(radii) <= value)
    if not below.size or below[-1] == radii.size - 1:
        return None
    bracket = radii[below[-1]], radii[below[-1] + 1]
    found: Any = scipy.optimize.brentq(
        lambda a: function(a) - value, *bracket, xtol=_TOLERANCE * bracket[0]
    )
    return float(found)


def _radii(shape: Shape, body: Body, length: float) -> Array:
    """Return the radii [m] at which contacts are searched for.

    On a layer each costs milliseconds, and there is no theory of a shape with details beyond 100
    thicknesses.
    """
    low, high = length * np.array(_RADII)
    many = _COUNT if body == _HALF_SPACE else _FEWER
    is_smooth = bool(np.isinf(detail(shape)))
    if isinstance(body, Layer) and not (is_smooth and on_layer.is_power(body)):
        high = min(high, on_layer.LARGEST * body.thickness)
    if is_smooth:
        return np.geomspace(low, high, many)
    far = min(high, end(shape))
    looks = int(np.clip(_PER_DETAIL * far / detail(shape), 2, many))
    even = np.arange(1, looks + 1) * detail(shape) / _PER_DETAIL
    return np.unique(np.concatenate([np.geomspace(low, high, many // 2), even[even < high]]))


def _theory(shape: Shape, body: Body, solid: dict[str, float]) -> tuple[Any, dict[str, Any]]:
    """Choose the theory of a shape on a body, with its arguments."""
    if body != _HALF_SPACE:
        return indenter, {"shape": shape, "body": body, **solid}
    match shape:
        case Sphere():
            return jkr, {"radius": shape.radius, **solid}
        case PowerLawProfile() | Cone():
            return profiles, {"exponent": shape.exponent, "coefficient": shape.coefficient, **solid}
    return indenter, {"shape": shape, **solid}
