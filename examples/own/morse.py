"""A Morse law, as a user would add one: one file, no edit of viscotack.

viscotack simulate sphere --law morse:3 --with examples/own/morse.py --tabor 1
--modulus-ratio 0.1 --exponent 0.8 --preload 5 --rate 10
"""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack import Quantity
from viscotack.cards import conform
from viscotack.model.traction.law import EquilibriumGap, WorkOfAdhesion


@dataclass(frozen=True)
class Morse:
    r"""The potential of Morse between two surfaces.

    .. math:: \varphi(h) = \Delta\gamma_0 \left(e^{-2x} - 2 e^{-x}\right), \quad
              x = b\,(h/h_0 - 1)

    Parameters
    ----------
    work_of_adhesion : float
        Work to separate unit area from the equilibrium gap [J/m^2]; positive.
    equilibrium_gap : float
        Gap of zero traction [m]; positive.
    steepness : float
        b; positive. The peak tension is b dg0/(2 h0), at h0 (1 + ln 2/b).

    References
    ----------
    Morse (1929), doi:10.1103/PhysRev.34.57.
    """

    word: ClassVar[str] = "morse"

    work_of_adhesion: WorkOfAdhesion
    equilibrium_gap: EquilibriumGap
    steepness: Annotated[
        float, Quantity("1", "b", "steepness of the law over h0", above=0, example="3")
    ]

    def __post_init__(self) -> None:
        conform(self)

    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the traction [Pa], positive in tension, at a gap [m]."""
        e = self._fading(gap)
        return 2 * self.steepness * self._scale * (e - e * e)

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the energy of unit area [J/m^2] at a gap [m]: 0 far apart."""
        e = self._fading(gap)
        return self.work_of_adhesion * (e * e - 2 * e)

    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from a gap [m] to infinity [J/m]."""
        e = self._fading(gap)
        length = self.equilibrium_gap / self.steepness
        return self.work_of_adhesion * length * (e * e / 2 - 2 * e)

    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the derivative of the traction by the gap [Pa/m]."""
        e = self._fading(gap)
        return 2 * self.steepness**2 * self._scale / self.equilibrium_gap * (2 * e * e - e)

    @property
    def strength(self) -> float:
        """Largest tension [Pa]."""
        return self.steepness * self._scale / 2

    @property
    def edge_gap(self) -> float:
        """Gap of the largest tension [m]; the contact edge is there."""
        return self.equilibrium_gap * (1 + float(np.log(2)) / self.steepness)

    def reduced(self) -> "Morse":
        """Return the dimensionless law: traction in dg0/h0, gap in h0."""
        return replace(self, work_of_adhesion=1.0, equilibrium_gap=1.0)

    @property
    def _scale(self) -> float:
        return self.work_of_adhesion / self.equilibrium_gap

    def _fading(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        h = np.asarray(gap, dtype=float)
        return np.exp(-self.steepness * (h / self.equilibrium_gap - 1))
