r"""Elastic bodies: the half-space, and a layer on a rigid base, bonded to it or sliding on it.

A body implements :meth:`Body.influence`, the surface displacements under pressures, for the
symmetries it supports, and :meth:`Body.reduced`, which returns the body in other units of length.
`word` is its name in files. Any class with these attributes is a body; docs/own.md explains one.

A pressure :math:`\cos \xi x` on a layer of the thickness b in plane strain moves its surface by
:math:`\frac{2}{E^* \xi} \, \kappa(\xi b) \cos \xi x`, and a pressure :math:`J_0(\xi r)` does
likewise. The transfer function kappa rises from the ``foundation`` :math:`c = 2 \kappa(t)/t`, t to
0, of a thin layer, which sinks by :math:`c \, p b / E^*`, to 1, the half-plane.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Protocol

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Checked, Quantity, conform
from viscotack.errors import InputError


@dataclass(frozen=True)
class Frictionless:
    r"""A rigid base on which the layer slides, or the middle plane of a symmetric sandwich.

    .. math:: \kappa(t) = \frac{\cosh 2t - 1}{\sinh 2t + 2t}

    Source: Maghami, PhD thesis (2025), Eq. 3.20, after Bentall and Johnson.

    Examples
    --------
    >>> Frictionless().foundation
    1.0
    """

    word: ClassVar[str] = "frictionless"

    @property
    def foundation(self) -> float:
        """Return the depth of a thin layer under a uniform pressure, in p b/E*: 1."""
        return 1.0

    def transfer(self, t: npt.ArrayLike) -> Array:
        """Return kappa at wave numbers t > 0 [1/b]."""
        x = np.asarray(t, dtype=float)
        e = np.exp(-2 * x)
        return np.expm1(-2 * x) ** 2 / (4 * x * e - np.expm1(-4 * x))


@dataclass(frozen=True, kw_only=True)
class Bonded(Checked):
    r"""A rigid base to which the layer is glued.

    .. math:: \kappa(t) = \frac{q \sinh 2t - 2t}{q \cosh 2t + 2t^2 + (1 + q^2)/2}, \quad
              q = 3 - 4 \nu

    A thin layer is stiffer by :math:`\zeta = (1 - \nu)^2/(1 - 2\nu)` (Maghami, PhD thesis (2025),
    appendix I), without bound as nu goes to 1/2.

    Parameters
    ----------
    poisson_ratio : float
        Of the layer, from 0 to 0.5, the same as in the contact modulus.

    Examples
    --------
    >>> f"{1 / Bonded(poisson_ratio=0.3).foundation:.3f}"
    '1.225'
    """

    word: ClassVar[str] = "bonded"

    poisson_ratio: Annotated[
        float, Quantity("1", "nu", "Poisson ratio of the layer", least=0, most=0.5, example="0.5")
    ]

    @property
    def foundation(self) -> float:
        r"""Return the depth of a thin layer under a uniform pressure, in p b/E*: 1/zeta."""
        return (1 - 2 * self.poisson_ratio) / (1 - self.poisson_ratio) ** 2

    def transfer(self, t: npt.ArrayLike) -> Array:
        """Return kappa at wave numbers t > 0 [1/b]."""
        x, q = np.asarray(t, dtype=float), 3 - 4 * self.poisson_ratio
        e = np.exp(-2 * x)
        sinh, cosh = -np.expm1(-4 * x) / 2, (1 + e**2) / 2  # both times exp(-2t)
        return (q * sinh - 2 * x * e) / (q * cosh + (2 * x**2 + (1 + q**2) / 2) * e)


Base = Frictionless | Bonded


class Body(Protocol):
    """Interface of an elastic body, for the type checker.

    Attributes
    ----------
    symmetries : tuple of str
        Of the shapes that may press it, "revolution" and "plane".
    decay_length : float
        Length along the surface over which the displacement beside a pressure dies out [m]: inf of
        a half-space, the thickness of a layer, 0 of springs side by side.
    """

    word: ClassVar[str]
    symmetries: ClassVar[tuple[str, ...]]

    @property
    def decay_length(self) -> float: ...  # noqa: D102

    def influence(self, nodes: npt.NDArray, symmetry: str) -> Array:
        """Return G[i, j], the displacement at node i under hat j (:mod:`.panels`), for E* = 1.

        Nodes ascend from 0, in the unit of length of the body. Displacement into the body is
        positive under pressure.
        """
        ...

    def reduced(self, along: float) -> Body:
        """Return the body with lengths in `along` [m]."""
        ...


@dataclass(frozen=True)
class HalfSpace:
    """Half-space: a body much thicker than the contact is wide.

    Examples
    --------
    >>> HalfSpace().decay_length
    inf
    """

    word: ClassVar[str] = "half-space"
    symmetries: ClassVar[tuple[str, ...]] = ("revolution",)

    @property
    def decay_length(self) -> float:
        """Distance beyond which a pressure does not move the surface [m]: infinite."""
        return float("inf")

    def influence(self, nodes: npt.NDArray, symmetry: str) -> Array:
        """Return the displacement at node i under hat j, for E* = 1, in the unit of the nodes."""
        from viscotack.model.geometry.half_space import influence

        return influence(nodes)

    def reduced(self, along: float) -> HalfSpace:
        """Return the half-space itself, which has no length scale."""
        return self


@dataclass(frozen=True)
class Layer:
    """An elastic or viscoelastic layer on a rigid base.

    Parameters
    ----------
    thickness : float
        Thickness b [m]; positive.
    base : Frictionless or Bonded
        How it rests on the rigid body below.

    Examples
    --------
    >>> from viscotack.model.geometry import Bonded
    >>> Layer(thickness=1e-3, base=Bonded(poisson_ratio=0.45)).base.foundation.__round__(3)
    0.331
    """

    word: ClassVar[str] = "layer"
    symmetries: ClassVar[tuple[str, ...]] = ("revolution", "plane")

    thickness: Annotated[
        float, Quantity("m", "b", "thickness of the layer", above=0, example="50 um")
    ]
    base: Base = Frictionless()

    def __post_init__(self) -> None:
        conform(self)
        if not isinstance(self.base, Base):
            raise InputError(
                f"base must be Frictionless() or Bonded(poisson_ratio=...), got {self.base!r}"
            )

    @property
    def decay_length(self) -> float:
        """The thickness [m]."""
        return self.thickness

    @property
    def poisson_ratio(self) -> float | None:
        """The Poisson ratio that it was made for, which must be the material's; None for any."""
        return getattr(self.base, "poisson_ratio", None)

    @property
    def numbers(self) -> Mapping[str, float]:
        """Dimensionless numbers of the body, by name."""
        return {"thickness": self.thickness}

    def influence(self, nodes: npt.NDArray, symmetry: str) -> Array:
        """Return the displacement at node i under hat j, for E* = 1, in the unit of the nodes."""
        if symmetry == "revolution":
            from viscotack.model.geometry.layer_of_revolution import influence

            return influence(nodes, self.thickness, self.base)
        from viscotack.model.geometry.layer import layer_influence

        return layer_influence(nodes, self.thickness, self.base)

    def reduced(self, along: float) -> Layer:
        """Return the layer with lengths in `along` [m]."""
        return Layer(self.thickness / along, self.base)
