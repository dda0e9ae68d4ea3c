"""Exponential law: adhesion that decays over an independent length."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.cards import Quantity
from viscotack.model.traction.law import LawOfGap, checked_gap


@dataclass(frozen=True)
class Exponential(LawOfGap):
    r"""Exponential law: linear near the equilibrium gap, with an exponential tail.

    With the decay length :math:`\ell = d\,h_0`

    .. math:: \sigma(h) = \frac{\Delta\gamma_0}{\ell^2} (h - h_0)\, e^{-(h - h_0)/\ell}

    Parameters
    ----------
    work_of_adhesion : float
        Delta-gamma_0, work to separate unit area from the equilibrium gap [J/m^2]; positive.
    equilibrium_gap : float
        h_0, the gap of zero traction [m]; positive.
    decay : float
        Decay length d over h_0; positive. 0.25 gives the stiffness at h_0 of Lennard-Jones, 0.358
        the strength.

    Notes
    -----
    Valid for every gap > 0. The peak tension is Delta-gamma_0/(e l), at h_0 + l. At small gaps the
    repulsion is finite: with a decay above about 0.5, strongly compressed surfaces come far
    below h_0.

    References
    ----------
    Xu & Needleman (1994), doi:10.1016/0022-5096(94)90003-5, for normal separation.

    Examples
    --------
    >>> law = Exponential(work_of_adhesion=0.15, equilibrium_gap=1.5e-6, decay=0.25)
    >>> f"{law.strength / 1e3:.1f} kPa at {law.edge_gap * 1e6:.3f} um"
    '147.2 kPa at 1.875 um'
    """

    word: ClassVar[str] = "exponential"

    decay: Annotated[float, Quantity("1", "d", "decay length over h0", above=0, example="0.25")]

    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the traction [Pa], positive in tension, at a gap [m] of any shape."""
        x, fading = self._opening(gap)
        return self.work_of_adhesion / self._length * x * fading

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the energy per area [J/m^2] at a gap [m]: 0 at infinity, minimum at h_0."""
        x, fading = self._opening(gap)
        return -self.work_of_adhesion * (1 + x) * fading

    def energy_and_traction(
        self, gap: npt.ArrayLike
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the energy [J/m^2] and the traction [Pa] at a gap [m] in one evaluation."""
        x, fading = self._opening(gap)
        pull = self.work_of_adhesion / self._length * x * fading
        return -self.work_of_adhesion * (1 + x) * fading, pull

    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from a gap [m] to infinity [J/m]; negative far apart.

        Multiplied by 2 pi R it is the energy of a sphere's flank that begins at this gap
        (Derjaguin).
        """
        x, fading = self._opening(gap)
        return -self.work_of_adhesion * self._length * (2 + x) * fading

    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the derivative of the traction by the gap [Pa/m]; negative where it softens."""
        x, fading = self._opening(gap)
        return self.work_of_adhesion / self._length**2 * (1 - x) * fading

    @property
    def strength(self) -> float:
        """Largest tension of the law [Pa]."""
        return float(np.exp(-1)) * self.work_of_adhesion / self._length

    @property
    def edge_gap(self) -> float:
        """Gap of the largest tension [m], h_0 + l; defines the contact edge."""
        return self.equilibrium_gap + self._length

    @property
    def _length(self) -> float:
        return self.decay * self.equilibrium_gap

    def _opening(self, gap: npt.ArrayLike) -> tuple[npt.NDArray, npt.NDArray]:
        """Return the opening beyond h_0 [decay lengths], and the exponential factor there."""
        x = (checked_gap(gap) - self.equilibrium_gap) / self._length
        return x, np.exp(-x)
