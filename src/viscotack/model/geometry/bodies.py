r"""Elastic bodies: the half-space, and a layer on a rigid base.

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

import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.model.geometry.bases import Base, Frictionless


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
        """Return G[i, j], the displacement at node i under hat j (:mod:`.hats`), for E* = 1.

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
