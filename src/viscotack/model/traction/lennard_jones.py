"""The Lennard-Jones law between half-spaces."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.model.traction.law import LawOfGap, checked_gap


@dataclass(frozen=True)
class LennardJones(LawOfGap):
    r"""Lennard-Jones 3-9 law: attraction between half-spaces and a steep repulsion.

    .. math:: \sigma(h) = \frac{8 \Delta\gamma_0}{3 h_0}
              \left[ (h_0/h)^3 - (h_0/h)^9 \right]

    Parameters
    ----------
    work_of_adhesion : float
        Delta-gamma_0, work to separate unit area from the equilibrium gap [J/m^2]; positive.
    equilibrium_gap : float
        h_0, the gap of zero traction [m]; positive.

    Notes
    -----
    Valid for every gap > 0. The peak tension is 16/(9 sqrt(3)) Delta-gamma_0/h_0, at
    3^(1/6) h_0. The contact edge is where the gap is that of the peak tension of the law in use.

    References
    ----------
    Maghami, PhD thesis (2025), Eq. 2.1 and 4.11; Greenwood (1997), doi:10.1098/rspa.1997.0070.

    Examples
    --------
    >>> law = LennardJones(work_of_adhesion=0.1523, equilibrium_gap=1.55e-6)
    >>> f"{law.strength / 1e3:.1f} kPa at {law.edge_gap * 1e6:.2f} um"
    '100.9 kPa at 1.86 um'
    """

    word: ClassVar[str] = "lennard-jones"

    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the traction [Pa], positive in tension, at a gap [m] of any shape."""
        x = self._inverse_gap(gap)
        x3 = x * x * x
        return (8 * self.work_of_adhesion / (3 * self.equilibrium_gap)) * (x3 - x3 * x3 * x3)

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the energy per area [J/m^2] at a gap [m]: 0 at infinity, minimum at h_0.

        The minimum is minus the work of adhesion. The derivative by the gap is the traction.
        """
        x2 = self._inverse_gap(gap) ** 2
        return -(self.work_of_adhesion / 3) * (4 * x2 - (x2 * x2) ** 2)

    def energy_and_traction(
        self, gap: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the energy [J/m^2] and the traction [Pa] at a gap [m] in one evaluation."""
        x = self._inverse_gap(gap)
        x2 = x * x
        x3 = x2 * x
        pull = (8 * self.work_of_adhesion / (3 * self.equilibrium_gap)) * (x3 - x3 * x3 * x3)
        return -(self.work_of_adhesion / 3) * (4 * x2 - (x2 * x2) ** 2), pull

    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from a gap [m] to infinity [J/m]; negative far apart.

        Multiplied by 2 pi R it is the energy of a sphere's flank that begins at this gap
        (Derjaguin).
        """
        x = self._inverse_gap(gap)
        x3 = x * x * x
        return -(self.work_of_adhesion * self.equilibrium_gap / 3) * (4 * x - x3 * x3 * x / 7)

    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the derivative of the traction by the gap [Pa/m]; negative where it softens."""
        x2 = self._inverse_gap(gap) ** 2
        x4 = x2 * x2
        return (8 * self.work_of_adhesion / self.equilibrium_gap**2) * (3 * x4 * x4 * x2 - x4)

    @property
    def strength(self) -> float:
        """Largest tension of the law [Pa]."""
        return 16 / (9 * 3**0.5) * self.work_of_adhesion / self.equilibrium_gap

    @property
    def edge_gap(self) -> float:
        """Gap of the largest tension [m], 3^(1/6) h_0; defines the contact edge."""
        return 3 ** (1 / 6) * self.equilibrium_gap

    def _inverse_gap(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        return self.equilibrium_gap / checked_gap(gap)
