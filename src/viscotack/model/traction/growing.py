r"""Traction laws whose tension grows with the opening speed of the gap.

A growing law combines a law of the gap at rest, :math:`\sigma_0(h)`, with a growth G of the
opening speed:

.. math:: \sigma(h, \dot h) = \sigma_0(h) + \max(\sigma_0(h), 0) \, G(\max(\dot h, 0)), \quad
          G(0) = 0, \quad G' > 0 .

Only attraction and opening are affected: repulsion, and closing surfaces, follow the law at rest.
The tension is continuous in gap and speed and tends to that at rest for slow opening.
The interface dissipates, :math:`(\sigma - \sigma_0) \dot h \geq 0`. Its stored energy is that of
the law at rest; the rest of the work is heat.

As functions of the gap alone these classes return the law at rest, which relaxed contacts and
starts use; :func:`viscotack.model.traction.grows` identifies them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Quantity
from viscotack.model.traction.resting import OverRest

# Fraction of the reference speed below which a power law is proportional to the speed.
_SLOW = 1e-6
# Number of Newton iterations for a reference speed.
_ROUNDS = 30

ReferenceSpeed = Annotated[
    float,
    Quantity(
        "m/s", "v0", "opening speed by which growth is measured", above=0, example="213.5 um/s"
    ),
]


@dataclass(frozen=True)
class _Growing(OverRest):
    """Common part of laws that grow with the opening speed, except their growth."""

    reference_speed: ReferenceSpeed

    def growth(self, opening_speed: npt.ArrayLike) -> Array:
        """Return the relative growth of the tension at opening speeds [m/s]; 0 while closing."""
        return self._growth(np.maximum(np.asarray(opening_speed, float) / self.reference_speed, 0))

    def growth_slope(self, opening_speed: npt.ArrayLike) -> Array:
        """Return the derivative of the growth by the speed [s/m]; 0 while closing."""
        u = np.asarray(opening_speed, float) / self.reference_speed
        return np.where(u > 0, self._slope(np.maximum(u, 0)), 0.0) / self.reference_speed

    _excess = growth

    @property
    def own_time(self) -> float:
        """Time in which a gap opens by h_0 at the reference speed [s]."""
        return self.equilibrium_gap / self.reference_speed

    def _in_units(self, time: float, length: float) -> dict[str, float]:
        return {"reference_speed": self.reference_speed * time / length}

    def _growth(self, u: Array) -> Array:
        raise NotImplementedError

    def _slope(self, u: Array) -> Array:
        raise NotImplementedError


@dataclass(frozen=True)
class GentSchultz(_Growing):
    r"""Tension that grows with a power of the opening speed, after Gent and Schultz.

    .. math:: G(v) = \left( \frac{v}{v_0} \right)^n \left( \frac{v}{v + v_c} \right)^{1-n},
              \quad v_c = 10^{-6} \, v_0

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Constants of the law at rest [J/m^2] and [m]; positive.
    reference_speed : float
        v_0 [m/s], positive: the opening speed at which the tension is doubled.
    exponent : float
        n, in (0, 1].
    base : LennardJones, Exponential, Dugdale or Tabulated
        The reduced law at rest. :meth:`of` accepts one in SI.

    Notes
    -----
    A power below 1 has an infinite slope at zero speed, in contrast to thermally activated bonds:
    far below the speed at which force matters they open as often as they form, and resist in
    proportion to the speed. The second factor describes this. It is 1 except at speeds of about
    10^-6 v_0 and less; above 10^-3 v_0 it changes G by less than 10^-3.

    Gent and Schultz found the power law for the energy of a crack against ITS speed. Here it
    relates to the local opening speed of the gap, from which the crack's energy follows: for an
    elastic bulk the power is the same, but the reference speed differs (docs/traction-laws.md).

    References
    ----------
    Gent & Schultz (1972), J. Adhesion 3, 281; Maghami, PhD thesis (2025), Eq. 2.19 and 4.28.

    Examples
    --------
    >>> from viscotack import LennardJones
    >>> rest = LennardJones(work_of_adhesion=0.1523, equilibrium_gap=200e-9)
    >>> law = GentSchultz.of(rest, reference_speed=1e-3, exponent=0.5)
    >>> float(law.growth(1e-3).round(4)), float(law.growth(-1e-3))
    (1.0, 0.0)
    """

    word: ClassVar[str] = "gent-schultz"

    exponent: Annotated[
        float, Quantity("1", "n", "power of the opening speed", above=0, most=1, example="0.4154")
    ]

    def _growth(self, u: Array) -> Array:
        return power_growth(u, self.exponent)

    def _slope(self, u: Array) -> Array:
        return (u + _SLOW) ** (self.exponent - 2) * (self.exponent * u + _SLOW)


def power_growth(ratio: npt.ArrayLike, exponent: npt.ArrayLike) -> Array:
    """Return G of :class:`GentSchultz` laws at opening speeds relative to v0, not negative."""
    u = np.asarray(ratio, dtype=float)
    return u * (u + _SLOW) ** (np.asarray(exponent, dtype=float) - 1)


def reference_speed(
    growth: npt.ArrayLike, opening_speed: npt.ArrayLike, exponent: npt.ArrayLike
) -> Array:
    """Return v0 of the :class:`GentSchultz` law with a given growth at an opening speed.

    Parameters
    ----------
    growth : array_like
        G, not negative; 0 gives an infinite reference speed.
    opening_speed : array_like
        Opening speed, positive, in any unit; the result has the same unit.
    exponent : array_like
        n, in (0, 1].

    Examples
    --------
    >>> speed = float(reference_speed(0.3, 1e-4, 0.4))
    >>> law = GentSchultz(0.1, 1e-7, reference_speed=speed, exponent=0.4)
    >>> f"{law.growth(1e-4):.3f}"
    '0.300'
    """
    G, n = np.asarray(growth, dtype=float), np.asarray(exponent, dtype=float)
    grown = G > 0
    log_growth = np.log(np.where(grown, G, 1.0))
    # the growth is below both of its asymptotic powers; Newton in logarithms, with slope n to 1
    log_u = np.maximum(log_growth / n, log_growth - (n - 1) * np.log(_SLOW))
    for _ in range(_ROUNDS):
        u = np.exp(log_u)
        misfit = log_u + (n - 1) * np.log(u + _SLOW) - log_growth
        log_u = log_u - misfit / (1 + (n - 1) * u / (u + _SLOW))
    return np.where(grown, np.asarray(opening_speed, dtype=float) * np.exp(-log_u), np.inf)


@dataclass(frozen=True)
class Eyring(_Growing):
    r"""Tension that grows with the logarithm of the opening speed, like thermally activated bonds.

    .. math:: G(v) = s \, \mathrm{arsinh} \frac{v}{v_0}

    The growth is proportional to the speed below v_0, and rises by s per factor of e above it.

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Constants of the law at rest [J/m^2] and [m]; positive.
    reference_speed : float
        v_0 [m/s], positive: crossover from thermal activation to force.
    sensitivity : float
        s, positive.
    base : LennardJones, Exponential, Dugdale or Tabulated
        The reduced law at rest. :meth:`of` accepts one in SI.

    References
    ----------
    Eyring (1936), doi:10.1063/1.1749836; of bonds, Evans & Ritchie (1997),
    doi:10.1016/S0006-3495(97)78802-7.

    Examples
    --------
    >>> from viscotack import LennardJones
    >>> rest = LennardJones(work_of_adhesion=0.1523, equilibrium_gap=200e-9)
    >>> law = Eyring.of(rest, reference_speed=1e-6, sensitivity=0.2)
    >>> f"{law.growth(1e-3):.2f}"
    '1.52'
    """

    word: ClassVar[str] = "eyring"

    sensitivity: Annotated[
        float, Quantity("1", "s", "growth for every factor of e in speed", above=0, example="0.2")
    ]

    def _growth(self, u: Array) -> Array:
        return self.sensitivity * np.arcsinh(u)

    def _slope(self, u: Array) -> Array:
        return self.sensitivity / np.sqrt(1 + u * u)
