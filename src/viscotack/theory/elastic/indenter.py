r"""JKR for any rigid indenter of revolution, by quadrature of its profile.

With the slope f' of the profile, the adhesionless contact of radius a has the depth and the force

.. math:: D(a) = a \int_0^{\pi/2} f'(a \sin\theta)\, d\theta, \quad
          P(a) = 2 E^* a^2 \int_0^{\pi/2} \sin^2\theta\, f'(a \sin\theta)\, d\theta

(Sneddon (1965), doi:10.1016/0020-7225(65)90019-4), and with adhesion, Eq. 2.10 and 2.11 of Maghami,
PhD thesis (2025), depth and force fall by :math:`\sqrt{2 \pi a \Delta\gamma_0/E^*}` and
:math:`\sqrt{8 \pi a^3 \Delta\gamma_0 E^*}`. For power laws :mod:`.profiles` has closed forms. On
another body than the half-space they follow from its influence matrix (:mod:`.on_body`).
Range: short-range adhesion, small slopes, and a contact without holes. Where the slope falls
outwards (:func:`viscotack.geometry.detail`) depth and force are those of a contact that was pressed
together to its edge; they may have several branches, and several minima
(:mod:`viscotack.theory.elastic.wavy`).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.geometry import Body, HalfSpace, detail
from viscotack.theory._checks import Number, Values, plain, positive
from viscotack.theory.elastic import on_body

# Gauss-Legendre nodes in the angle: exact to round-off for smooth profiles.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
# One such panel is for so many details of a profile; beyond so many panels there are no more.
_DETAILS, _MOST_PANELS = 1.0, 64
# Slopes that are looked up at once.
_AT_ONCE = 1_000_000
_HALF_SPACE = HalfSpace()


class Flank(Protocol):
    """A profile that says how steep it is."""

    def gap(self, position: Values) -> Array: ...  # noqa: D102
    def flank(self, position: Values) -> Array: ...  # noqa: D102


def bare_depth(contact_radius: Values, *, shape: Flank, body: Body = _HALF_SPACE) -> Number:
    """Return the depth [m] at which a contact has this radius [m] without adhesion."""
    a = positive(contact_radius=contact_radius)
    if body != _HALF_SPACE:
        return plain(on_body.bare_depth(a, shape, body))
    return plain(a * _mean(shape, a, 0))


def depth(
    contact_radius: Values,
    *,
    shape: Flank,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Number:
    """Return the depth [m] of a contact of this radius [m], with adhesion.

    Examples
    --------
    A sphere of 1 mm has JKR's:

    >>> from viscotack.geometry import Sphere
    >>> solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
    >>> f"{depth(1e-4, shape=Sphere(1e-3), **solid) * 1e6:.3f} um"
    '4.395 um'
    """
    a = positive(contact_radius=contact_radius)
    if body == _HALF_SPACE:
        drawn = np.sqrt(2 * np.pi * a * work_of_adhesion / contact_modulus)
    else:
        drawn = on_body.drawn(a, shape, body, work_of_adhesion / contact_modulus)
    return plain(bare_depth(a, shape=shape, body=body) - drawn)


def force(
    contact_radius: Values,
    *,
    shape: Flank,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Number:
    """Return the force [N] of a contact of this radius [m], positive in compression."""
    a, E = positive(contact_radius=contact_radius), contact_modulus
    if body != _HALF_SPACE:
        return plain(E * on_body.force(a, shape, body, work_of_adhesion / E))
    bare = 2 * E * a**2 * _mean(shape, a, 2)
    return plain(bare - np.sqrt(8 * np.pi * a**3 * work_of_adhesion * E))


def gap(
    position: Values,
    *,
    contact_radius: float,
    shape: Flank,
    contact_modulus: float,
    work_of_adhesion: float,
    body: Body = _HALF_SPACE,
) -> Array:
    r"""Return the gap [m] around a contact at a distance from the axis [m]; 0 within.

    .. math:: g(r) = f(r) - \delta + \frac{2}{\pi} \int_0^a
              \frac{\delta - D(t)}{\sqrt{r^2 - t^2}}\, dt
    """
    a = float(contact_radius)
    r = np.maximum(np.asarray(position, dtype=float), a)
    solid: Any = {"contact_modulus": contact_modulus, "work_of_adhesion": work_of_adhesion}
    deep = float(depth(a, shape=shape, body=body, **solid))
    if body != _HALF_SPACE:
        around = on_body.gap(np.ravel(r), a, deep, shape, body)
        return np.maximum(np.reshape(around, np.shape(r)), 0.0)
    # t = a sin(angle) takes the root off the edge of the contact where r is near it
    angle, weight = _angles(shape, a)
    t = a * np.sin(angle)
    hollow = np.asarray(bare_depth(t, shape=shape)) * a * np.cos(angle) * weight
    lifted = deep * np.arcsin(a / r) - (hollow / np.sqrt(r[..., None] ** 2 - t**2)).sum(axis=-1)
    return np.maximum(shape.gap(r) - deep + 2 / np.pi * lifted, 0.0)


def _mean(shape: Flank, a: npt.NDArray, power: int) -> npt.NDArray:
    """Return the integral of the slope over the angle, with a power of its sine."""
    angle, weight = _angles(shape, float(np.max(a, initial=0.0)))
    sine = np.sin(angle)
    weight = weight * sine**power
    radii = np.ravel(a)
    parts = np.array_split(radii, -(-radii.size * sine.size // _AT_ONCE) or 1)
    means = [np.asarray(shape.flank(np.multiply.outer(part, sine))) @ weight for part in parts]
    return np.reshape(np.concatenate(means), np.shape(a))


def _angles(shape: Flank, radius: float) -> tuple[Array, Array]:
    """Return angles and weights for a contact of this radius at most."""
    panels = np.ceil(radius / (_DETAILS * detail(shape)))
    return _rule(int(np.clip(panels, 1, _MOST_PANELS)))


@lru_cache(maxsize=_MOST_PANELS)
def _rule(panels: int) -> tuple[Array, Array]:
    """Return the nodes and the weights of so many panels from 0 to pi/2."""
    width = np.pi / 2 / panels
    angle = width * (np.arange(panels)[:, None] + (_NODES + 1) / 2)
    return np.ravel(angle), np.tile(width / 2 * _WEIGHTS, panels)
