"""What a layer lies on: a rigid base, to which it is bonded or on which it slides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Checked, Quantity


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
