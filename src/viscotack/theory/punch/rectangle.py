r"""Rectangular flat punch: bounds on a half-space, and an estimate on a thin layer.

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

Sources: elliptical punch, Johnson, Contact Mechanics (1985), section 3.4; the bounds, this package.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from viscotack.errors import InputError
from viscotack.geometry import Base, Layer
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.elastic import disc

from . import crossover


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

    The area times the mean stresses of a strip of the half width b and of a disc of the radius b on
    the same layer. These are no bounds: corners open first, and the ends of a long rectangle are
    those of no strip. A layer is thin up to a thickness of b, so that an end acts over a length of
    about b.

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
        If the layer is thicker than half the width.

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
    if not thickness <= b:
        raise InputError(
            f"a layer of {thickness:.4g} m is thicker than half the width of the rectangle, "
            f"{b:.4g} m: bounds are known on a half-space, and an estimate on thinner layers; "
            "leave out the thickness if it exceeds the length several times"
        )
    solid = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    strip = float(crossover.pull_off_stress(thickness, half_width=b, base=base, **solid))
    round_ = disc.pull_off_force(contact_radius=b, body=Layer(thickness, base), **solid)
    stresses = sorted((strip, float(round_) / (np.pi * b**2)))
    return Interval(*(4 * a * b * stress for stress in stresses))
