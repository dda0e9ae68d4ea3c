r"""Laws of traction whose tension may exceed that of a law at rest.

Such a law has a law of the gap alone at rest, :math:`\sigma_0(h)`, and multiplies its tensions,
not its pressures. It stores the energy of the law at rest; what its tension does beyond is heat.
:func:`grows` identifies those whose excess depends on the opening speed, :func:`ages` those whose
excess depends on the time in contact.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.cards import conform
from viscotack.errors import InputError, OutOfRange
from viscotack.model.traction.law import EquilibriumGap, Traction, WorkOfAdhesion
from viscotack.model.traction.lennard_jones import LennardJones
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
