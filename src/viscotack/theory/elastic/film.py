r"""JKR on a layer (film, coating): pull-off, its thin limits, and when a film is a half-space.

The contact of a rigid indenter on a layer of thickness b has the energy release rate of a disc of
its radius a,

.. math:: G = \frac{E^* K'(a)\, [D(a) - \delta]^2}{4 \pi a} = \Delta\gamma_0, \quad
          P = P_1(a) - E^* K(a)\, [D(a) - \delta],

with the depth D and the force :math:`P_1` of a contact of this radius without adhesion, and the
stiffness :math:`E^* K` of the disc (:mod:`.on_layer` computes the three). The ratio of b to
:math:`\beta = (R^2 \Delta\gamma_0/E^*)^{1/3}` and the base decide: the pull-off force of a sphere
rises from :math:`1.5 \pi R \Delta\gamma_0` on a thick layer to

.. math:: 2 \pi R \Delta\gamma_0 \quad \text{(thin and compressible, or sliding)}, \qquad
          3 \pi R \Delta\gamma_0 \quad \text{(thin, bonded and incompressible)}.

A thin layer is a foundation of springs, :math:`\delta = a^2/2R - \sqrt{2 c b \Delta\gamma_0/E^*}`
with its compliance :math:`c\, b/E^*`, or a squeezed film. The second limit is reached very slowly:
it is 1.97 of :math:`1.5 \pi R \Delta\gamma_0` at :math:`b = 0.001 \beta`.

Depth and force of a contact radius are :func:`.indenter.depth` and :func:`.indenter.force` with
``body=Layer(...)``; discs are in :mod:`.disc`. Range: short-range adhesion (a large Tabor number;
on thin incompressible layers a very large one), small slopes, and a contact without friction.

Source: Lebedev & Ufliand (1958), doi:10.1016/0021-8928(58)90036-X, for the contact without
adhesion; the limits follow from the two foundations.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import scipy

from viscotack.errors import TOO_LARGE, InputError
from viscotack.model.geometry import Base, Disc, HalfSpace, Layer, Shape
from viscotack.model.geometry.panels import gauss
from viscotack.model.protocol import AtForce
from viscotack.theory._checks import Number, Values, plain, positive

from . import disc, indenter, relaxed
from .jkr import Point

# Thicknesses [beta] of the search for that of a half-space, and factor from one to the next.
_THICKEST, _THINNEST, _STEP = 60.0, 1e-3, 1.3


def pull_off(
    *, shape: Shape, body: HalfSpace | Layer, contact_modulus: float, work_of_adhesion: float
) -> Point:
    r"""Compute the contact of the smallest force, at which a dead load detaches.

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter, e.g. :class:`viscotack.model.geometry.Sphere`. A disc detaches as a whole
        (:mod:`.disc`).
    body : Layer or HalfSpace
        The film, with its thickness [m] and its base.
    contact_modulus, work_of_adhesion : float
        :math:`E^* = E/(1 - \nu^2)` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N], which is negative: tension.

    Raises
    ------
    InputError
        If a number is not positive.

    Examples
    --------
    A lens of 5 mm on a bonded film of silicone, 50 um thick, and on a half-space:

    >>> from viscotack.model.geometry import Bonded, Sphere
    >>> solid = dict(shape=Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.05)
    >>> film = Layer(50e-6, Bonded(poisson_ratio=0.5))
    >>> [f"{-pull_off(body=body, **solid).force * 1e3:.2f} mN" for body in (film, HalfSpace())]
    ['1.64 mN', '1.18 mN']
    """
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    if not isinstance(shape, Disc):
        return relaxed.ends(shape, body=body, **solid)[1]
    if not shape.is_sharp:
        return relaxed.strongest(shape, largest=shape.radius, body=body, **solid)
    out = float(np.asarray(indenter.drawn(shape.radius, shape=shape, body=body, **solid)))
    return Point(
        shape.radius,
        -out,
        -float(np.asarray(disc.pull_off_force(contact_radius=shape.radius, body=body, **solid))),
    )


def instability(
    *, shape: Shape, body: HalfSpace | Layer, contact_modulus: float, work_of_adhesion: float
) -> Point:
    r"""Compute the contact of the smallest depth, at which a rigid drive detaches.

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter, not a disc.
    body, contact_modulus, work_of_adhesion
        As in :func:`pull_off`.

    Returns
    -------
    Point
        Contact radius [m], depth [m] and force [N].

    Raises
    ------
    InputError
        If a number is not positive, or the shape is a disc.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded, Sphere
    >>> film = Layer(50e-6, Bonded(poisson_ratio=0.5))
    >>> solid = dict(shape=Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.05)
    >>> f"{instability(body=film, **solid).depth * 1e6:.2f} um"
    '-1.04 um'
    """
    _refuse_disc(shape)
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    return relaxed.ends(shape, body=body, **solid)[0]


def work_to_pull_off(
    *, shape: Shape, body: HalfSpace | Layer, contact_modulus: float, work_of_adhesion: float
) -> float:
    r"""Compute the work [J] from the contact without load to the pull-off, positive.

    .. math:: W = -\int P\, d\delta

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter, not a disc.
    body, contact_modulus, work_of_adhesion
        As in :func:`pull_off`.

    Returns
    -------
    float
        Work [J], by splines through 200 contacts, to five digits.

    Raises
    ------
    InputError
        If a number is not positive, or the shape is a disc.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded, Sphere
    >>> film = Layer(50e-6, Bonded(poisson_ratio=0.5))
    >>> solid = dict(shape=Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.05)
    >>> f"{work_to_pull_off(body=film, **solid) * 1e9:.2f} nJ"
    '0.95 nJ'
    """
    _refuse_disc(shape)
    solid: Any = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    end = pull_off(shape=shape, body=body, **solid)
    free = relaxed.contact(AtForce(0.0), shape=shape, body=body, **solid)
    # every JKR contact has a state without load, but a number such as 1e99 hides it
    if free is None:
        raise InputError(TOO_LARGE)
    a = np.linspace(float(end.contact_radius), float(free.contact_radius), 200)
    depth, force = (
        scipy.interpolate.CubicSpline(a, np.asarray(of(a)))
        for of in relaxed.curve(shape, body=body, **solid)
    )
    nodes, weight = gauss(a, 3)
    return float(-weight @ (force(nodes) * depth(nodes, 1)))


def _refuse_disc(shape: Shape) -> None:
    if isinstance(shape, Disc):
        raise InputError("a disc has one contact radius and detaches as a whole: use theory.disc")


def thin_limit(*, radius: Values, work_of_adhesion: Values, base: Base) -> Number:
    r"""Return the pull-off force [N] of a sphere on a very thin layer, a positive number.

    :math:`2 \pi R \Delta\gamma_0` if the layer is compressible or slides on its base, and
    :math:`3 \pi R \Delta\gamma_0` if it is bonded and incompressible. Thickness and modulus have no
    effect. Range: :math:`b \ll \beta`; within 1 % from b = 0.02 beta down if sliding or with a
    Poisson ratio up to 0.3, and from 2e-4 beta down if incompressible.

    Parameters
    ----------
    radius, work_of_adhesion : array_like
        R [m] and :math:`\Delta\gamma_0` [J/m^2], positive.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> from viscotack.model.geometry import Frictionless
    >>> force = thin_limit(radius=5e-3, work_of_adhesion=0.05, base=Frictionless())
    >>> f"{force * 1e3:.2f} mN"
    '1.57 mN'
    """
    R, w = positive(radius=radius, work_of_adhesion=work_of_adhesion)
    return plain((2 if base.foundation > 0 else 3) * np.pi * R * w)


def half_space_thickness(
    *,
    shape: Shape,
    base: Base,
    contact_modulus: float,
    work_of_adhesion: float,
    tolerance: float = 0.05,
) -> float:
    r"""Compute the thickness [m] from which on a layer holds as a half-space does.

    On thicker layers the pull-off force differs from that on a half-space by less than the
    tolerance. For a sphere on an incompressible bonded layer it is 2.2, 4.2 and 7.3 contact radii
    at pull-off for tolerances of 5, 1 and 0.2 %.

    Parameters
    ----------
    shape : shape of revolution
        Rigid indenter.
    base : Frictionless or Bonded
        How the layer rests on the rigid body below.
    contact_modulus, work_of_adhesion : float
        :math:`E^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    tolerance : float
        Relative difference of the force, from 1e-4 to 1.

    Returns
    -------
    float
        Thickness [m]; 0 if the force on no layer differs by so much.

    Raises
    ------
    InputError
        If the tolerance is out of range or a number not positive.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded, Sphere
    >>> lens = dict(shape=Sphere(5e-3), contact_modulus=2e6, work_of_adhesion=0.05)
    >>> thick = half_space_thickness(base=Bonded(poisson_ratio=0.5), **lens)
    >>> f"{thick * 1e6:.0f} um"
    '292 um'
    """
    if not 1e-4 <= tolerance <= 1:
        raise InputError(f"tolerance must lie between 0.0001 and 1, got {tolerance!r}")
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    length = relaxed.adhesion_length(shape, **solid)
    of = partial(pull_off, shape=shape, **solid)
    whole = of(body=HalfSpace()).force

    def excess(log: float) -> float:
        force = of(body=Layer(length * float(np.exp(log)), base)).force
        return float(abs(np.asarray(force) / whole - 1)) / tolerance - 1

    log, thinnest = np.log(_THICKEST), np.log(_THINNEST)
    while excess(log) < 0:
        log -= np.log(_STEP)
        if log < thinnest:
            return 0.0
    if log == np.log(_THICKEST):
        raise InputError(f"tolerance is too small for this layer: {tolerance:g}; give a larger one")
    found: float = scipy.optimize.brentq(excess, log, log + np.log(_STEP), xtol=1e-5)  # type: ignore[assignment]
    return length * float(np.exp(found))
