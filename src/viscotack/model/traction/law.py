"""Protocol of traction laws, and measures of their range."""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any, Protocol, Self, runtime_checkable

import numpy as np
import numpy.typing as npt

from viscotack.cards import Checked, Quantity
from viscotack.errors import InputError

WorkOfAdhesion = Annotated[
    float,
    Quantity(
        "J/m^2",
        "dg0",
        "work to separate unit area from the equilibrium gap",
        above=0,
        example="0.1523 J/m^2",
    ),
]
EquilibriumGap = Annotated[
    float, Quantity("m", "h0", "gap of zero traction", above=0, example="1.55 um")
]

# Strength of the Lennard-Jones law in work of adhesion over equilibrium gap, the unit of ranges.
_STRENGTH = 16 / (9 * 3**0.5)

# Gaps are bisected until the tension changes by less than this fraction of the strength between
# them, at most this number of times: a steeper fall is a step.
_SMALL_FALL, _HALVINGS = 0.02, 20


@runtime_checkable
class Traction(Protocol):
    """Protocol of a traction law for type checkers; a dataclass with these names is a law.

    Attributes
    ----------
    work_of_adhesion : float
        Work to separate unit area from the equilibrium gap [J/m^2].
    equilibrium_gap : float
        Gap of zero traction [m]; repulsive below, attractive above.
    strength : float
        Largest tension [Pa].
    edge_gap : float
        Smallest gap with the largest tension [m]; defines the contact edge.
    """

    @property
    def work_of_adhesion(self) -> float: ...  # noqa: D102
    @property
    def equilibrium_gap(self) -> float: ...  # noqa: D102
    @property
    def strength(self) -> float: ...  # noqa: D102
    @property
    def edge_gap(self) -> float: ...  # noqa: D102
    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]: ...  # noqa: D102
    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]: ...  # noqa: D102
    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]: ...  # noqa: D102
    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]: ...  # noqa: D102
    def reduced(self) -> "Traction": ...  # noqa: D102


@dataclass(frozen=True)
class LawOfGap(Checked):
    """Constants of a law of the gap alone, and the same law without dimensions."""

    work_of_adhesion: WorkOfAdhesion
    equilibrium_gap: EquilibriumGap

    def reduced(self) -> Self:
        """Return the dimensionless law: traction in Delta-gamma_0/h_0, gap in h_0."""
        return replace(self, work_of_adhesion=1.0, equilibrium_gap=1.0)


def checked_gap(gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return gaps as an array; raise an error unless all are positive."""
    # arrays of other libraries, such as those on a GPU, stay what they are
    h: Any = gap if getattr(gap, "dtype", None) == np.float64 else np.asarray(gap, dtype=float)
    if h.size and not h.min() > 0:
        raise InputError(f"gap must be positive, got a minimum of {h.min()} m")
    return h


def energy_and_traction(
    law: Traction, gap: npt.ArrayLike
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return energy [J/m^2] and traction [Pa] of a law, in one evaluation where it offers one."""
    both = getattr(law, "energy_and_traction", None)
    return both(gap) if both is not None else (law.energy(gap), law.traction(gap))


def effective_range(law: Traction) -> float:
    r"""Return the effective range of a law over its equilibrium gap, from its strength.

    .. math:: s = \frac{16}{9\sqrt 3} \frac{\Delta\gamma_0}{\sigma_0 h_0}

    This is the equilibrium gap of a Lennard-Jones law of the same work and strength, over h_0: 1
    for Lennard-Jones, 1.03 for Dugdale, 2.79 d for an exponential law of decay d. A contact of
    Tabor number mu with this law is about as close to JKR as one of mu/s with Lennard-Jones.

    Examples
    --------
    >>> from viscotack.model.traction import Exponential
    >>> law = Exponential(work_of_adhesion=0.15, equilibrium_gap=1.5e-6, decay=0.1)
    >>> f"{effective_range(law):.3f}"
    '0.279'
    """
    return _STRENGTH * law.work_of_adhesion / (law.strength * law.equilibrium_gap)


@lru_cache(maxsize=64)
def softening(law: Traction) -> float:
    """Return the steepest decrease of the tension with the gap, in strength squared over work.

    It determines the node spacing of a simulation: 1.19 for Lennard-Jones, 2/f for Dugdale.

    Examples
    --------
    >>> from viscotack.model.traction import LennardJones
    >>> f"{softening(LennardJones(0.1523, 1.55e-6)):.2f}"
    '1.19'
    """
    reach = effective_range(law) * law.equilibrium_gap
    gap = law.edge_gap + reach * np.concatenate([[0.0], np.geomspace(1e-4, 50.0, 400)])
    for _ in range(_HALVINGS):
        coarse = np.abs(np.diff(law.traction(gap))) > _SMALL_FALL * law.strength
        if not coarse.any():
            break
        gap = np.sort(np.append(gap, (gap[:-1] + gap[1:])[coarse] / 2))
    fall = max(-np.min(law.stiffness(gap)), -np.min(np.diff(law.traction(gap)) / np.diff(gap)))
    return float(fall) * law.work_of_adhesion / law.strength**2
