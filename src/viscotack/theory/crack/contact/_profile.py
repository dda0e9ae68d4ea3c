r"""Depth of each annulus of an axisymmetric contact, by Abel's transform.

.. math:: g(s) = s \int_0^s \frac{f'(r)}{\sqrt{s^2 - r^2}} dr

is the depth at which a contact without adhesion has radius s; a contact of radius a and depth
D carries :math:`P = 2 \int_0^a (D - g(s)) ds`, and the energy release rate at its edge is
:math:`(D - g(a))^2/2 \pi a`, with lengths along the surface in :math:`\beta`, heights in
:math:`\beta^2/R` and forces in R dg, in which E* and dg are 1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache
from typing import Any

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.geometry import Base, HalfSpace, Layer, Sphere, detail
from viscotack.theory._roots import halved
from viscotack.theory.elastic import indenter
from viscotack.theory.elastic.relaxed import largest_radius

# Radii between which a user-defined shape is tabulated [beta], and rows per decade.
_RADII, _ROWS = (1e-6, 1e4), 60
# The same of a shape on a layer.
_ON_LAYER, _ROWS_ON_LAYER = (1e-4, 1e4), 20


class Profile(ABC):
    """Contacts of a reduced shape: depth without adhesion, drawn depth and force.

    Radii are in beta, depths in beta^2/R and forces in R dg.
    """

    @abstractmethod
    def depth(self, radius: Any) -> Any:
        """Return the depth of a contact without adhesion."""

    @abstractmethod
    def drawn(self, radius: Any) -> Any:
        """Return by how much a work of adhesion of 1 draws a contact out."""

    @abstractmethod
    def force(self, radius: Any, depth: Any) -> Any:
        """Return the force of a contact of this radius and depth."""

    def relaxed_depth(self, radius: Any) -> Any:
        """Return the depth of a relaxed adhesive contact (JKR)."""
        return self.depth(radius) - self.drawn(radius)

    def relaxed_force(self, radius: Any) -> Any:
        """Return the force of a relaxed adhesive contact (JKR)."""
        return self.force(radius, self.relaxed_depth(radius))

    @property
    def elastic_radius(self) -> Any:
        """Radius of the largest tension of a relaxed contact."""
        return _strongest(self)


class HalfSpaceProfile(Profile):
    """Depths g of the annuli of a reduced shape of revolution, and their integral."""

    def __init__(self, shape: Any) -> None:
        q = 2.0 if shape.word == "sphere" else getattr(shape, "exponent", None)
        if q is not None:
            # r^q/q, of slope 1 at distance 1
            factor = (
                np.exp(scipy.special.gammaln(q / 2) - scipy.special.gammaln((q + 1) / 2))
                * np.sqrt(np.pi)
                / 2
            )
            self._power = float(q), float(factor)
            return
        self._power = None
        s = np.geomspace(*_RADII, int(_ROWS * np.log10(_RADII[1] / _RADII[0])))
        depth = np.asarray(indenter.bare_depth(s, shape=shape))
        self._depth = scipy.interpolate.CubicSpline(np.log(s), np.log(depth))
        self._inner = (s[0], depth[0] * s[0])
        total = scipy.interpolate.CubicSpline(np.log(s), depth * s).antiderivative()
        self._total = lambda a: total(np.log(a)) + self._inner[1] / 2

    def depth(self, radius: Any) -> Any:
        """Return g at radii, not negative."""
        s = radius if isinstance(radius, float) else np.asarray(radius, dtype=float)
        if self._power is not None:
            q, factor = self._power
            return factor * s**q
        return np.exp(self._depth(np.log(np.maximum(s, self._inner[0]))))

    def total(self, radius: Any) -> Any:
        """Return the integral of g from 0 to radii."""
        s = radius if isinstance(radius, float) else np.asarray(radius, dtype=float)
        if self._power is not None:
            q, factor = self._power
            return factor * s ** (q + 1) / (q + 1)
        return self._total(np.maximum(s, self._inner[0]))

    def drawn(self, radius: Any) -> Any:
        """Return by how much a work of adhesion of 1 draws a contact out."""
        return np.sqrt(2 * np.pi * np.asarray(radius))

    def force(self, radius: Any, depth: Any) -> Any:
        """Return the force of a contact of this radius and depth."""
        a = np.asarray(radius)
        return 2 * (a * depth - self.total(a))


class LayerProfile(Profile):
    r"""Contacts on a layer, where annuli are not independent.

    A contact of radius a and depth D carries :math:`P = P_1(a) - K(a) [g(a) - D]`, with the force
    without adhesion and the stiffness of a disc, and releases :math:`(D - g)^2/\Delta^2`, where
    :math:`\Delta` is by how much a work of adhesion of 1 draws it out. Depth and force are those of
    :mod:`viscotack.theory.elastic.on_layer`, tabulated.
    """

    def __init__(self, shape: Any, layer: Layer) -> None:
        if np.isfinite(detail(shape)):
            raise InputError(
                f"the contact of a {shape.word} on a layer may have several edges; simulate it"
            )
        a = np.geomspace(*_ON_LAYER, int(_ROWS_ON_LAYER * np.log10(_ON_LAYER[1] / _ON_LAYER[0])))
        bare = {"shape": shape, "body": layer, "contact_modulus": 1.0}
        columns = (
            indenter.bare_depth(a, shape=shape, body=layer),
            indenter.drawn(a, work_of_adhesion=1.0, **bare),
            indenter.stiffness(a, contact_modulus=1.0, body=layer),
            indenter.force(a, work_of_adhesion=0.0, **bare),
        )
        self._table = [scipy.interpolate.CubicSpline(np.log(a), np.log(x)) for x in columns]

    def _of(self, column: int, radius: Any) -> Any:
        return np.exp(self._table[column](np.log(np.maximum(radius, _ON_LAYER[0]))))

    def depth(self, radius: Any) -> Any:
        """Return the depth of a contact without adhesion."""
        return self._of(0, radius)

    def drawn(self, radius: Any) -> Any:
        """Return by how much a work of adhesion of 1 draws a contact out."""
        return self._of(1, radius)

    def force(self, radius: Any, depth: Any) -> Any:
        """Return the force of a contact of this radius and depth."""
        return self._of(3, radius) - self._of(2, radius) * (self.depth(radius) - depth)


class SpheresOnLayers(LayerProfile):
    r"""Contacts of spheres on layers of several thicknesses b, one for each case.

    Depth, drawn depth, stiffness and force are :math:`b^p` times functions of a/b alone, p being 2,
    1/2, 1 and 3, so the table of one layer serves all. Below its smallest a/b they are those of a
    half-space, which have the same powers.

    Parameters
    ----------
    thickness : ndarray, shape (cases,)
        Thickness of each layer [beta].
    base : Base
        Base of the layers.
    """

    _POWERS = (2.0, 0.5, 1.0, 3.0)

    def __init__(self, thickness: Array, base: Base) -> None:
        self._thickness, self._base = thickness, base
        self._unit: Any = profile_on(Sphere(1.0), Layer(1.0, base))

    def _of(self, column: int, radius: Any) -> Any:
        inside = np.maximum(radius / self._thickness, _ON_LAYER[0])
        return (radius / inside) ** self._POWERS[column] * self._unit._of(column, inside)

    @property
    def elastic_radius(self) -> Any:
        """Radius of the largest tension of a relaxed contact, of each case."""
        each, at = np.unique(self._thickness, return_inverse=True)
        return _strongest(SpheresOnLayers(each, self._base))[at]

    def radius_at_force(self, force: Array) -> Array:
        """Return the radius of the larger, stable relaxed contact under positive forces [R dg]."""
        low = self.elastic_radius
        # a half-space yields more than a layer, and JKR's radius is below this
        high = low + 3 * np.cbrt(1 + force)
        return halved(lambda a: force - self.relaxed_force(a), low, high)


def _strongest(profile: Profile) -> Any:
    """Return the radius of the largest tension of relaxed contacts, an array if of several."""
    a = np.geomspace(1e-3, 1e2, 2000)
    if isinstance(profile, SpheresOnLayers):
        return a[np.argmin(profile.relaxed_force(a[:, None]), axis=0)]
    return float(a[np.argmin(profile.relaxed_force(a))])


@lru_cache(maxsize=32)
def profile_of(shape: Any) -> HalfSpaceProfile:
    """Return the profile of a reduced shape on a half-space (cached)."""
    return HalfSpaceProfile(shape)


@lru_cache(maxsize=32)
def profile_on(shape: Any, body: HalfSpace | Layer) -> Profile:
    """Return the profile of a reduced shape on a body with lengths in beta (cached)."""
    if isinstance(body, Layer):
        return LayerProfile(shape, body)
    if body == HalfSpace():
        return profile_of(shape)
    raise InputError(f"a receding crack is known on a half-space or a layer, got a {body.word}")


def radius_at_depth(profile: Profile, depth: float) -> float:
    """Return the radius of the larger, stable relaxed contact at a depth [beta^2/R]."""
    return _found(largest_radius(profile.relaxed_depth, depth), "depth")


def radius_at_force(profile: Profile, force: float) -> float:
    """Return the radius of the larger, stable relaxed contact under a force [R dg]."""
    return _found(largest_radius(profile.relaxed_force, force), "force")


def _found(radius: float | None, name: str) -> float:
    if radius is None:
        raise InputError(
            f"no relaxed contact exists at this {name}, because a contact with short-range forces "
            "detaches earlier; start deeper"
        )
    return radius
