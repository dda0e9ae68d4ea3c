r"""Laws of traction whose tension grows with the opening speed or with the time in contact.

Such a law has a law of the gap alone at rest, :math:`\sigma_0(h)`, and multiplies its tensions,
not its pressures. It stores the energy of the law at rest; what its tension does beyond is heat.
:func:`grows` identifies those whose excess depends on the opening speed, :func:`ages` those whose
excess depends on the time in contact.

**Traction laws whose tension grows with the opening speed of the gap.** A growing law combines a
law of the gap at rest, :math:`\sigma_0(h)`, with a growth G of the opening speed:

.. math:: \sigma(h, \dot h) = \sigma_0(h) + \max(\sigma_0(h), 0) \, G(\max(\dot h, 0)), \quad
          G(0) = 0, \quad G' > 0 .

Only attraction and opening are affected: repulsion, and closing surfaces, follow the law at rest.
The tension is continuous in gap and speed and tends to that at rest for slow opening.
The interface dissipates, :math:`(\sigma - \sigma_0) \dot h \geq 0`. Its stored energy is that of
the law at rest; the rest of the work is heat.

**Traction laws whose tension grows with the time in contact.** Bonds form while two surfaces touch:
the longer the contact, the more it holds. An ageing law combines a law of the gap at rest,
:math:`\sigma_0(h)`, with a growth G of the time t that a point of the surface has been in contact:

.. math:: \sigma(h, t) = \sigma_0(h) + \max(\sigma_0(h), 0) \, G(t), \quad G(0) = 0, \quad
          G' \geq 0 .

So the work of adhesion after the time t is :math:`\Delta\gamma_0 (1 + G(t))`, of unchanged range.
A point comes into contact when its gap falls below that of the largest tension. Its time stands
still when the gap has grown beyond, and is zero again once the bonds are broken, where the law at
rest has less than 1 % of its work left. So surfaces that come together feel the law at rest, and a
repeated contact ages from the beginning. The interface dissipates: what its tension does beyond
that at rest is heat (:mod:`viscotack.simulate.growth`).

As functions of the gap alone these classes return the law at rest, which relaxed contacts and
starts use; :func:`grows` and :func:`ages` identify them.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError, OutOfRange
from viscotack.model.traction.formulas import LennardJones
from viscotack.model.traction.law import EquilibriumGap, Traction, WorkOfAdhesion
from viscotack.units import positive


@dataclass(frozen=True)
class OverRest:
    """Common part of these laws: everything except their constants and their excess.

    The constants that contain a time are converted by `_in_units`. As functions of the gap alone
    these classes are the law at rest, which relaxed contacts and starts use.
    """

    work_of_adhesion: WorkOfAdhesion
    equilibrium_gap: EquilibriumGap
    base: Traction = field(default=LennardJones(1.0, 1.0), kw_only=True)

    @classmethod
    def of(cls, base: Traction, **constants: float) -> Self:
        """Return the law with a given law at rest, with its other constants in SI."""
        kind: Any = cls
        return kind(
            work_of_adhesion=base.work_of_adhesion,
            equilibrium_gap=base.equilibrium_gap,
            base=base.reduced(),
            **constants,
        )

    def __post_init__(self) -> None:
        conform(self)
        base = self.base
        if has_rest(base) or not hasattr(base, "energy_beyond"):
            raise InputError(
                f"base must be a law of the gap alone, got {base!r}; for example LennardJones(1, 1)"
            )
        if base.work_of_adhesion != 1 or base.equilibrium_gap != 1:
            raise InputError(
                f"base must be a reduced law, of work 1 and gap 1, got {base!r}; use "
                f"{type(self).__name__}.of(law, ...) for a law in SI"
            )

    @property
    def at_rest(self) -> Any:
        """The law of the gap alone."""
        base: Any = self.base
        w, h0 = self.work_of_adhesion, self.equilibrium_gap
        return replace(base, work_of_adhesion=w, equilibrium_gap=h0)

    def traction(self, gap: npt.ArrayLike, at: npt.ArrayLike = 0.0) -> Array:
        """Return the traction [Pa], positive in tension, at gaps [m].

        `at` is the opening speed [m/s] or the time in contact [s] by which the tension grows.
        """
        tension = self.at_rest.traction(gap)
        return tension + np.maximum(tension, 0) * self._excess(at)

    def stiffness(self, gap: npt.ArrayLike, at: npt.ArrayLike = 0.0) -> Array:
        """Return the derivative of the traction by the gap [Pa/m]; `at` as for the traction."""
        law = self.at_rest
        attracts = law.traction(gap) > 0
        return law.stiffness(gap) * (1 + attracts * self._excess(at))

    def _excess(self, at: npt.ArrayLike, /) -> Array:
        """Return the relative growth of the tension."""
        raise NotImplementedError

    def energy(self, gap: npt.ArrayLike) -> Array:
        """Return the stored energy per area [J/m^2], that of the law at rest."""
        return self.at_rest.energy(gap)

    def energy_beyond(self, gap: npt.ArrayLike) -> Array:
        """Return the integral of that energy from a gap [m] to infinity [J/m]."""
        return self.at_rest.energy_beyond(gap)

    @property
    def strength(self) -> float:
        """Largest tension at rest [Pa]."""
        return self.base.strength * self.work_of_adhesion / self.equilibrium_gap

    @property
    def edge_gap(self) -> float:
        """Gap of the largest tension at rest [m]; defines the contact edge."""
        return self.base.edge_gap * self.equilibrium_gap

    @property
    def own_time(self) -> float:
        """Time of the law itself [s], the unit of time of a problem without another."""
        raise NotImplementedError

    def reduced(self, time_unit: float = 1.0) -> Self:
        """Return the law with work 1, gap 1 and a unit of time [s]."""
        law: Any = self
        timed = self._in_units(time_unit, self.equilibrium_gap)
        return replace(law, work_of_adhesion=1.0, equilibrium_gap=1.0, **timed)

    def scaled(self, work_of_adhesion: float, equilibrium_gap: float, time_unit: float) -> Self:
        """Convert a reduced law to SI."""
        law: Any = self
        timed = self._in_units(1 / time_unit, 1 / equilibrium_gap)
        return replace(
            law, work_of_adhesion=work_of_adhesion, equilibrium_gap=equilibrium_gap, **timed
        )

    def _in_units(self, time: float, length: float) -> dict[str, float]:
        """Return the constants that contain a time, in other units of time and length."""
        raise NotImplementedError


def has_rest(law: Any) -> bool:
    """Return whether the tension of a law, or a class of laws, may exceed that of one at rest."""
    return hasattr(law, "at_rest")


def grows(law: Any) -> bool:
    """Return whether a law, or a class of laws, depends on the opening speed."""
    return hasattr(law, "growth_slope")


def ages(law: Any) -> bool:
    """Return whether a law, or a class of laws, depends on the time in contact."""
    return hasattr(law, "growth_after")


def at_rest(law: Any) -> Any:
    """Return the law of the gap alone: that at rest, or the law itself."""
    return law.at_rest if has_rest(law) else law


def reduced(law: Any, time_unit: float) -> Any:
    """Return the dimensionless law, with this unit of time [s]."""
    return law.reduced(time_unit) if isinstance(law, OverRest) else law.reduced()


def in_si(law: Any, work_of_adhesion: float, equilibrium_gap: float, time_unit: float) -> Any:
    """Convert a reduced law to SI."""
    if isinstance(law, OverRest):
        return law.scaled(work_of_adhesion, equilibrium_gap, positive("time_unit", time_unit, "s"))
    return replace(law, work_of_adhesion=work_of_adhesion, equilibrium_gap=equilibrium_gap)


def check_of_gap_alone(law: Any, what: str) -> None:
    """Raise an error for a law that depends on more than the gap."""
    if has_rest(law):
        on = "opening speed" if grows(law) else "time in contact"
        raise OutOfRange(
            f"the law {type(law).word} grows with the {on}, but {what} supports laws of "
            "the gap only; simulate it, or use its law at rest"
        )


def check_ageless(law: Any, what: str) -> None:
    """Raise an error for a law that depends on the time in contact."""
    if ages(law):
        check_of_gap_alone(law, what)


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
