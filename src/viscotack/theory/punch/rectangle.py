r"""Rectangular flat punch: bounds on a half-space, and estimates on a thin layer.

A rigid rectangle of half length a and half width b, guided so that it does not tilt, is pulled off
an elastic half-space without friction. Its contact shrinks where the edge releases the work of
adhesion :math:`\Delta\gamma_0`; forces have a short range. The pull-off force P has bounds.

**Lower bound.** A punch of any plan at a depth :math:`\delta` is a charged plate: if a contact
contains another one and both share a point of the edge, the larger one releases less energy there,
because its surface around it is displaced more (maximum principle). So an edge cannot enter a disc
that is stable by itself. Discs of radius b are stable up to
:math:`\delta = \sqrt{2 \pi b \Delta\gamma_0/E^*}`. The contact then still contains all of them in
the rectangle, and the ellipse of half axes a and b that they contain. With the stiffness of this
ellipse and the elliptic integral K of the modulus squared :math:`1 - b^2/a^2`

.. math:: P \geq \frac{\pi E^* a}{K} \sqrt{\frac{2 \pi b \Delta\gamma_0}{E^*}} .

**Upper bound.** A shape that shrinks to its centre without changing releases
:math:`P^2 C/2 = \oint G \, (x \cdot n) \, ds`, because its compliance C is inverse to its size.
Where no part of the edge releases more than the work of adhesion the right side is at most
:math:`2 \Delta\gamma_0` times the area. Area and stiffness are at most those of the rectangle, and
its stiffness is below that of the ellipse around it, of half axes :math:`\sqrt2 a, \sqrt2 b`:

.. math:: P^2 \leq \frac{4 \Delta\gamma_0 \, 4 a b}{C}
              \leq \frac{16 \sqrt2 \, \pi E^* a^2 b \, \Delta\gamma_0}{K} .

This assumes that a ray from the centre crosses the edge of the contact once.

The force of a strip times the length, :math:`a \sqrt{8 \pi b E^* \Delta\gamma_0}`, is no bound: for
a square it is the lower one, that of the inscribed disc, and a long rectangle peels from its ends
well below it, where :math:`K > 2 \sqrt2` (from a = 4.1 b).

**Thin bonded layer.** A layer of thickness t on a rigid base, :math:`t \ll b`, is squeezed like a
film of oil: it is sheared by the pressure gradient, sticks to the base and slides under the punch.
With the shear modulus G and that of confined compression, :math:`M = 2 G (1 - \nu)/(1 - 2\nu)`,

.. math:: \nabla^2 \phi - \kappa^2 \phi = -1, \quad p = \frac{3 G \delta}{t^3} \phi, \quad
          \kappa^2 = \frac{3 G}{M t^2} = \frac{3 (1 - 2\nu)}{2 (1 - \nu) t^2},

with :math:`\phi = 0` on the edge: Poisson's equation if the layer is incompressible. The energy
:math:`P \delta/2` changes with the edge (Hadamard) by
:math:`(t^3/6G) (\partial p/\partial n)^2` per area, which is released there. It is largest in the
middle of the long sides and nothing in the corners. At a depth at which the middle releases the
work of adhesion the rectangle is still closed, so its force is a **lower bound**: with
:math:`T = \int \phi \, dA`

.. math:: P \geq \sqrt{\frac{6 G \Delta\gamma_0}{t^3}} \,
          \frac{T}{\max |\partial \phi/\partial n|} .

A shape that shrinks to its centre releases
:math:`P^2 N C/2 = \oint G \, (x \cdot n) \, ds`, with N the exponent of T and of the stiffness by
size, from 2 of a foundation of springs to 4 without compressibility. As on the half-space the
**upper bound** follows,

.. math:: P^2 \leq \frac{4 \Delta\gamma_0 \, 4 a b}{N C}
          = \frac{6 G \Delta\gamma_0}{t^3} \, \frac{8 a b \, T}{N} .

In units of :math:`a^3 \sqrt{6 G \Delta\gamma_0/t^3}` an incompressible square opens first at
0.8327 (:math:`T = 0.5623 a^4`, slope :math:`0.6753 a`) and holds at most 1.0605; the disc in it
holds :math:`\pi/4`. For long rectangles both are those of strips, the upper one
:math:`\sqrt{3/2}` times as large.

Sources: elliptical punch, Johnson, Contact Mechanics (1985), section 3.4; the torsion of a bar,
which is the film, Timoshenko and Goodier, Theory of Elasticity, section 109; the bounds, this
package.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, Bonded, Layer
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.elastic import disc

from . import crossover

# Terms of the series of a film, and largest thickness of one over b.
_TERMS, _THIN = 4000, 0.2
# Decay over a radius below which a disc is that of an incompressible film.
_SMALL = 1e-3


class Interval(NamedTuple):
    """Smallest (``least``) and largest (``most``) pull-off force [N].

    Returned by :func:`bounds` and :func:`on_layer`.
    """

    least: Number
    most: Number


def bounds(
    half_length: Values, *, half_width: Values, contact_modulus: Values, work_of_adhesion: Values
) -> Interval:
    r"""Return the bounds of the pull-off force [N] of a rectangle on a half-space.

    Parameters
    ----------
    half_length, half_width : array_like
        Half lengths of the sides a and b [m], positive, in any order.
    contact_modulus, work_of_adhesion : array_like
        :math:`E^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.

    Raises
    ------
    InputError
        If a value is not positive and finite.

    Examples
    --------
    >>> low, high = bounds(1e-4, half_width=1e-4, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> f"{low * 1e3:.2f} to {high * 1e3:.2f} mN"
    '1.12 to 1.50 mN'
    """
    one, other, E, w = positive(
        half_length=half_length,
        half_width=half_width,
        contact_modulus=contact_modulus,
        work_of_adhesion=work_of_adhesion,
    )
    a, b = np.maximum(one, other), np.minimum(one, other)
    K = scipy.special.ellipkm1((b / a) ** 2)
    least = np.pi * a / K * np.sqrt(2 * np.pi * b * w * E)
    most = a * np.sqrt(16 * np.sqrt(2) * np.pi * b * w * E / K)
    return Interval(plain(least), plain(most))


def on_layer(
    half_length: float,
    *,
    half_width: float,
    contact_modulus: float,
    work_of_adhesion: float,
    thickness: float,
    base: Base,
) -> Interval:
    r"""Return an estimate of the pull-off force [N] of a rectangle on a thin layer.

    On a frictionless base the area times the mean stresses of a strip of the half width b and of a
    disc of the radius b on the same layer. On a bonded base the bounds of the film, times the force
    of this disc over that of the film; the force of the rectangle differs by parts of the order of
    the thickness over b.

    Parameters
    ----------
    half_length, half_width : float
        Half lengths of the sides a and b [m], positive, in any order.
    contact_modulus, work_of_adhesion : float
        :math:`E^*` [Pa] and :math:`\Delta\gamma_0` [J/m^2], positive.
    thickness : float
        Thickness of the layer [m].
    base : Frictionless or Bonded
        Boundary condition of the layer on its base.

    Raises
    ------
    InputError
        If the layer is thicker than b, or a bonded one than b/5.

    Examples
    --------
    >>> from viscotack.theory.punch import Frictionless
    >>> stamp = dict(half_width=1e-4, contact_modulus=1e6, work_of_adhesion=0.05)
    >>> low, high = on_layer(2e-4, **stamp, thickness=2e-5, base=Frictionless())
    >>> f"{low * 1e3:.2f} to {high * 1e3:.2f} mN"
    '5.86 to 5.96 mN'
    """
    one, other = positive(half_length=half_length, half_width=half_width)
    a, b = max(float(one), float(other)), min(float(one), float(other))
    most = _THIN * b if isinstance(base, Bonded) else b
    if not thickness <= most:
        raise InputError(
            f"a layer of {thickness:.4g} m is thicker than half the width of the rectangle, or a "
            f"fifth of it on a bonded base, {most:.4g} m: bounds are known on a half-space, and an "
            "estimate on thinner layers; leave out the thickness if it exceeds the length several "
            "times"
        )
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    round_ = float(disc.pull_off_force(contact_radius=b, body=Layer(thickness, base), **solid))
    round_ /= np.pi * b**2
    if isinstance(base, Bonded):
        nu = base.poisson_ratio
        kappa = float(np.sqrt(1.5 * (1 - 2 * nu) / (1 - nu))) / thickness
        least, most = film_stresses(a, half_width=b, decay=kappa)
        scale = round_ / _disc_of_film(b, kappa)
        return Interval(4 * a * b * least * scale, 4 * a * b * most * scale)
    strip = float(crossover.pull_off_stress(thickness, half_width=b, base=base, **solid))
    return Interval(*(4 * a * b * stress for stress in sorted((strip, round_))))


def film_stresses(half_length: float, *, half_width: float, decay: float) -> tuple[float, float]:
    r"""Return the bounds of the mean stress of a rectangle on a thin bonded layer.

    Over :math:`\sqrt{6 G \Delta\gamma_0/t^3}`, so with the unit of a length.

    Parameters
    ----------
    half_length, half_width : float
        a and b [m], a not smaller.
    decay : float
        :math:`\kappa` [1/m]; 0 if the layer is incompressible.

    Examples
    --------
    >>> "{:.4f} to {:.4f}".format(
    ...     *(4 * stress for stress in film_stresses(1.0, half_width=1.0, decay=0.0))
    ... )
    '0.8327 to 1.0605'
    """
    a, b = half_length, half_width
    T, step = _film_force(a, b, decay), 1e-4
    larger, smaller = (_film_force(c * a, c * b, decay) for c in (1 + step, 1 - step))
    exponent = np.log(larger / smaller) / np.log((1 + step) / (1 - step))
    k, q = _rows(b, decay)
    whole = float(np.tanh(decay * b) / decay) if decay > 0 else b
    slope = whole - float(np.sum(2 / (b * q**2 * np.cosh(np.minimum(q * a, 300)))))
    return T / slope / (4 * a * b), float(np.sqrt(8 * a * b * T / exponent)) / (4 * a * b)


def _film_force(a: float, b: float, decay: float) -> float:
    """Return the integral of phi over a rectangle, by cosines across the width."""
    k, q = _rows(b, decay)
    return float(np.sum(8 / (b * k**2 * q**2) * (a - np.tanh(q * a) / q)))


def _rows(b: float, decay: float) -> tuple[Array, Array]:
    """Return wave numbers across the width, and the decay of their terms along it."""
    k = np.arange(0.5, _TERMS) * np.pi / b
    return k, np.sqrt(k**2 + decay**2)


def _disc_of_film(b: float, decay: float) -> float:
    """Return the mean stress at which a disc on a film opens, in the unit of the rectangle's."""
    x = decay * b
    if x < _SMALL:
        return b / 4
    # the mean of 1 - I0(kr)/I0(kb), over the slope at the edge
    i0, i1 = scipy.special.ive([0, 1], x)
    return float((i0 - 2 * i1 / x) / (i1 * decay))
