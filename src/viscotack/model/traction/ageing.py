r"""Traction laws whose tension grows with the time in contact.

Bonds form while two surfaces touch: the longer the contact, the more it holds. An ageing law
combines a law of the gap at rest, :math:`\sigma_0(h)`, with a growth G of the time t that a point
of the surface has been in contact:

.. math:: \sigma(h, t) = \sigma_0(h) + \max(\sigma_0(h), 0) \, G(t), \quad G(0) = 0, \quad
          G' \geq 0 .

So the work of adhesion after the time t is :math:`\Delta\gamma_0 (1 + G(t))`, of unchanged range.
A point comes into contact when its gap falls below that of the largest tension. Its time stands
still when the gap has grown beyond, and is zero again once the bonds are broken, where the law at
rest has less than 1 % of its work left. So surfaces that come together feel the law at rest, and a
repeated contact ages from the beginning. The interface dissipates: what its tension does beyond
that at rest is heat (:mod:`viscotack.simulate.ageing`).

As functions of the gap alone these classes return the law at rest, which relaxed contacts and
starts use; :func:`viscotack.model.traction.ages` identifies them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Quantity
from viscotack.model.traction.resting import OverRest

# Contact time after which a saturating growth differs from its end by e^-40, less than round-off.
_SETTLED = 40.0

ReferenceTime = Annotated[
    float,
    Quantity("s", "t0", "time in contact by which growth is measured", above=0, example="2 s"),
]


@dataclass(frozen=True)
class _Ageing(OverRest):
    """Common part of laws that grow with the time in contact, except their growth."""

    reference_time: ReferenceTime

    def growth_after(self, contact_time: npt.ArrayLike) -> Array:
        """Return the relative growth of the tension after times in contact [s], not negative."""
        return self._growth(np.asarray(contact_time, dtype=float) / self.reference_time)

    _excess = growth_after

    @property
    def settled(self) -> float:
        """Time in contact after which the tension no longer grows [s]; infinite if it always does.

        A relaxed contact has been closed for this time.
        """
        raise NotImplementedError

    @property
    def own_time(self) -> float:
        """The reference time [s]."""
        return self.reference_time

    def _in_units(self, time: float, length: float) -> dict[str, float]:
        return {"reference_time": self.reference_time / time}

    def _growth(self, t: Array) -> Array:
        raise NotImplementedError


@dataclass(frozen=True)
class LogarithmicAgeing(_Ageing):
    r"""Tension that grows with the logarithm of the time in contact.

    .. math:: G(t) = s \, \ln \left( 1 + \frac{t}{t_0} \right)

    The growth is proportional to the time below t_0, and rises by s per factor of e above it, by
    2.3 s per decade.

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Constants of the law at rest, of a contact just made, [J/m^2] and [m]; positive.
    reference_time : float
        t_0 [s], positive.
    sensitivity : float
        s, positive.
    base : LennardJones, Exponential, Dugdale or Tabulated
        The reduced law at rest. :meth:`of` accepts one in SI.

    Notes
    -----
    The growth has no end, so a relaxed contact, closed for ever, has none either: a simulation
    must start apart, approach and dwell.

    References
    ----------
    Bonds that form at activation energies of a broad range: Li, Tullis, Goldsby & Carpick (2011),
    doi:10.1038/nature10589; of friction, Dieterich (1972), doi:10.1029/JB077i020p03690.

    Examples
    --------
    >>> from viscotack import LennardJones
    >>> rest = LennardJones(work_of_adhesion=0.05, equilibrium_gap=20e-9)
    >>> law = LogarithmicAgeing.of(rest, reference_time=1.0, sensitivity=0.1)
    >>> f"{law.growth_after(1000.0):.2f}"
    '0.69'
    """

    word: ClassVar[str] = "logarithmic-ageing"

    sensitivity: Annotated[
        float, Quantity("1", "s", "growth for every factor of e in time", above=0, example="0.1")
    ]

    @property
    def settled(self) -> float:
        """Infinite: the tension grows for ever."""
        return np.inf

    def _growth(self, t: Array) -> Array:
        return self.sensitivity * np.log1p(t)


@dataclass(frozen=True)
class SaturatingAgeing(_Ageing):
    r"""Tension that grows with the time in contact towards an end, as bonds of first order form.

    .. math:: G(t) = g \, \left( 1 - e^{-t/t_0} \right)

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Constants of the law at rest, of a contact just made, [J/m^2] and [m]; positive.
    reference_time : float
        t_0 [s], positive.
    largest_growth : float
        g, positive: the work of adhesion of an old contact is 1 + g times that of a new one.
    base : LennardJones, Exponential, Dugdale or Tabulated
        The reduced law at rest. :meth:`of` accepts one in SI.

    References
    ----------
    First-order kinetics of bonds: Bell (1978), doi:10.1126/science.347575.

    Examples
    --------
    >>> from viscotack import LennardJones
    >>> rest = LennardJones(work_of_adhesion=0.05, equilibrium_gap=20e-9)
    >>> law = SaturatingAgeing.of(rest, reference_time=10.0, largest_growth=2.0)
    >>> f"{law.growth_after(10.0):.2f}"
    '1.26'
    """

    word: ClassVar[str] = "saturating-ageing"

    largest_growth: Annotated[
        float,
        Quantity("1", "g", "growth of the tension of an old contact", above=0, example="1.5"),
    ]

    @property
    def settled(self) -> float:
        """40 reference times, after which the growth differs from its end by round-off."""
        return _SETTLED * self.reference_time

    def _growth(self, t: Array) -> Array:
        return -self.largest_growth * np.expm1(-t)
