r"""JKR theory for any rigid indenter of revolution, by numerical quadrature of its profile.

With the slope f' of the profile, the adhesionless contact of radius a has the depth and the force

.. math:: D(a) = a \int_0^{\pi/2} f'(a \sin\theta)\, d\theta, \quad
          P(a) = 2 E^* a^2 \int_0^{\pi/2} \sin^2\theta\, f'(a \sin\theta)\, d\theta

(Sneddon (1965), doi:10.1016/0020-7225(65)90019-4), and with adhesion, Eq. 2.10 and 2.11 of Maghami,
PhD thesis (2025), depth and force fall by :math:`\sqrt{2 \pi a \Delta\gamma_0/E^*}` and
:math:`\sqrt{8 \pi a^3 \Delta\gamma_0 E^*}`. For power laws :mod:`.profiles` has closed forms. On a
layer they follow from an integral equation (:mod:`.on_layer`), on another body from its influence
matrix (:mod:`.on_body`).
Range: short-range adhesion, small slopes, and a contact without holes. If the slope decreases
outwards (:func:`viscotack.model.geometry.detail`), depth and force are those of a contact without
gaps inside its edge. They may then have several branches and several minima
(:mod:`viscotack.theory.elastic.wavy`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.model.geometry import Body, HalfSpace, Layer, Shape
from viscotack.theory._checks import Number, Values, at_least, plain, positive
from viscotack.theory.elastic.profiles import angles, half_space_depth, mean_slope

_HALF_SPACE = HalfSpace()
_NO_ADHESION = "0 is no adhesion"


def bare_depth(contact_radius: Values, *, shape: Shape, body: Body = _HALF_SPACE) -> Number:
    """Return the depth [m] of a contact of this radius [m] without adhesion.

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], positive.
    shape : Shape
        Indenter of revolution, e.g. :class:`viscotack.model.geometry.Sphere`.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Depth [m], positive into the body.

    Raises
    ------
    InputError
        If the contact radius is not positive and finite, or exceeds 100 thicknesses of a layer and
        the shape has details (:func:`viscotack.model.geometry.detail`) or the layer is bonded with
        a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    >>> from viscotack.model.geometry import Sphere
    >>> f"{bare_depth(1e-4, shape=Sphere(1e-3)) * 1e6:.1f} um"
    '10.0 um'
    """
    a = positive(contact_radius=contact_radius)
    if body != _HALF_SPACE:
        return plain(_on(body).bare_depth(a, shape, body))
    return plain(half_space_depth(a, shape))


def depth(
    contact_radius: Values,
    *,
    shape: Shape,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Number:
    """Return the depth [m] of a contact of this radius [m], with adhesion.

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], positive.
    shape : Shape
        Indenter of revolution, e.g. :class:`viscotack.model.geometry.Sphere`.
    contact_modulus : float
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float
        Work of adhesion [J/m^2], not negative.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Depth [m], positive into the body.

    Raises
    ------
    InputError
        If a number is outside its range or not finite, or the contact radius exceeds 100
        thicknesses of a layer and the shape has details (:func:`viscotack.model.geometry.detail`)
        or the layer is bonded with a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    JKR depth for a sphere with a radius of 1 mm:

    >>> from viscotack.model.geometry import Sphere
    >>> solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
    >>> f"{depth(1e-4, shape=Sphere(1e-3), **solid) * 1e6:.3f} um"
    '4.395 um'
    """
    solid: Any = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    out = drawn(contact_radius, shape=shape, body=body, **solid)
    return plain(bare_depth(contact_radius, shape=shape, body=body) - out)


def drawn(
    contact_radius: Values,
    *,
    shape: Shape,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Number:
    r"""Return the decrease of depth [m] by adhesion for a contact of this radius [m].

    On a half-space it is :math:`\sqrt{2 \pi a \Delta\gamma_0/E^*}`.

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], positive.
    shape : Shape
        Indenter of revolution, e.g. :class:`viscotack.model.geometry.Sphere`.
    contact_modulus : float
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float
        Work of adhesion [J/m^2], not negative.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Depth without adhesion minus depth with adhesion [m], not negative.

    Raises
    ------
    InputError
        If a number is outside its range or not finite, or the contact radius exceeds 100
        thicknesses of a layer and the shape has details (:func:`viscotack.model.geometry.detail`)
        or the layer is bonded with a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    >>> from viscotack.model.geometry import Sphere
    >>> solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
    >>> f"{drawn(1e-4, shape=Sphere(1e-3), **solid) * 1e6:.3f} um"
    '5.605 um'
    """
    a, E, w = _checked(contact_radius, contact_modulus, work_of_adhesion)
    if body == _HALF_SPACE:
        return plain(np.sqrt(2 * np.pi * a * (w / E)))
    return plain(_on(body).drawn(a, shape, body, w / E))


def force(
    contact_radius: Values,
    *,
    shape: Shape,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Number:
    """Return the force [N] of a contact of this radius [m], positive in compression.

    Parameters
    ----------
    contact_radius : float or array_like
        Contact radius a [m], positive.
    shape : Shape
        Indenter of revolution, e.g. :class:`viscotack.model.geometry.Sphere`.
    contact_modulus : float
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float
        Work of adhesion [J/m^2], not negative.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Force [N], negative in tension.

    Raises
    ------
    InputError
        If a number is outside its range or not finite, or the contact radius exceeds 100
        thicknesses of a layer and the shape has details (:func:`viscotack.model.geometry.detail`)
        or the layer is bonded with a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    JKR force for a sphere with a radius of 1 mm:

    >>> from viscotack.model.geometry import Sphere
    >>> solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
    >>> f"{force(1e-4, shape=Sphere(1e-3), **solid) * 1e3:.3f} mN"
    '0.212 mN'
    """
    a, E, w = _checked(contact_radius, contact_modulus, work_of_adhesion)
    if body != _HALF_SPACE:
        return plain(E * _on(body).force(a, shape, body, w / E))
    bare = 2 * E * a**2 * mean_slope(shape, a, 2)
    return plain(bare - np.sqrt(8 * np.pi * a**3 * w * E))


def stiffness(
    contact_radius: Values, *, contact_modulus: Values, body: Body = _HALF_SPACE
) -> Number:
    r"""Return the force per depth [N/m] of a rigid flat disc of this radius, positive.

    On a half-space it is :math:`2 E^* a`, on a thin layer of thickness b :math:`\pi a^2 E^*/(c b)`
    with its compliance c (:attr:`viscotack.model.geometry.Bonded.foundation`), and if that is 0,
    of a bonded incompressible layer, :math:`\tfrac{3 \pi}{32} E^* a^4/b^3`.

    Parameters
    ----------
    contact_radius : float or array_like
        Radius of the disc a [m], positive.
    contact_modulus : float or array_like
        Contact modulus E* [Pa], positive.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    float or ndarray
        Stiffness [N/m].

    Raises
    ------
    InputError
        If a value is not positive and finite, or the radius exceeds 100 thicknesses of a bonded
        layer with a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded
    >>> glued = Layer(0.5e-3, Bonded(poisson_ratio=0.5))
    >>> bodies = HalfSpace(), glued
    >>> each = [stiffness(1e-3, contact_modulus=1e6, body=body) for body in bodies]
    >>> [f"{value / 1e3:.2f} kN/m" for value in each]
    ['2.00 kN/m', '18.30 kN/m']
    """
    a, E = positive(contact_radius=contact_radius, contact_modulus=contact_modulus)
    if body == _HALF_SPACE:
        return plain(2 * E * a)
    return plain(E * _on(body).stiffness(a, body))


def gap(
    position: Values,
    *,
    contact_radius: float,
    shape: Shape,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Array:
    r"""Return the gap [m] outside a contact at a distance from the axis [m]; 0 inside.

    .. math:: g(r) = f(r) - \delta + \frac{2}{\pi} \int_0^a
              \frac{\delta - D(t)}{\sqrt{r^2 - t^2}}\, dt

    Parameters
    ----------
    position : float or array_like
        Distance r from the axis [m], not negative.
    contact_radius : float
        Contact radius a [m], positive.
    shape : Shape
        Indenter of revolution, e.g. :class:`viscotack.model.geometry.Sphere`.
    contact_modulus : float
        Contact modulus E* [Pa], positive.
    work_of_adhesion : float
        Work of adhesion [J/m^2], not negative.
    body : Body
        Elastic body, by default the half-space.

    Returns
    -------
    ndarray
        Gap [m], not negative.

    Raises
    ------
    InputError
        If a number is outside its range or not finite, or the contact radius exceeds 100
        thicknesses of a layer and the shape has details (:func:`viscotack.model.geometry.detail`)
        or the layer is bonded with a Poisson ratio between 0.49 and 0.5.

    Examples
    --------
    >>> from viscotack.model.geometry import Sphere
    >>> solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
    >>> around = gap([0.5e-4, 2e-4], contact_radius=1e-4, shape=Sphere(1e-3), **solid)
    >>> [f"{value * 1e6:.2f} um" for value in around]
    ['0.00 um', '15.92 um']
    """
    a = float(contact_radius)
    r = np.maximum(np.asarray(position, dtype=float), a)
    solid: Any = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    deep = float(depth(a, shape=shape, body=body, **solid))
    if body != _HALF_SPACE:
        found = np.zeros(np.shape(r))
        found[r > a] = np.maximum(_on(body).gap(r[r > a], a, deep, shape, body), 0.0)
        return found
    # t = a sin(angle) removes the root singularity at the contact edge for r close to a
    angle, weight = angles(shape, a)
    t = a * np.sin(angle)
    hollow = np.asarray(bare_depth(t, shape=shape)) * a * np.cos(angle) * weight
    lifted = deep * np.arcsin(a / r) - (hollow / np.sqrt(r[..., None] ** 2 - t**2)).sum(axis=-1)
    return np.maximum(shape.gap(r) - deep + 2 / np.pi * lifted, 0.0)


def _checked(contact_radius: Values, contact_modulus: float, work_of_adhesion: float) -> Any:
    a, E = positive(contact_radius=contact_radius, contact_modulus=contact_modulus)
    return a, E, at_least(0, _NO_ADHESION, work_of_adhesion=work_of_adhesion)


def _on(body: Body) -> Any:
    """Return the module with the solution for a body."""
    if isinstance(body, Layer):
        from viscotack.theory.elastic import on_layer

        return on_layer
    from viscotack.theory.elastic import on_body

    return on_body
