"""Traction laws by a formula of the gap: Lennard-Jones, Dugdale and exponential."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.cards import Quantity
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


@dataclass(frozen=True)
class Dugdale(LawOfGap):
    r"""Dugdale law: constant tension over a finite range, with a stiff wall at contact.

    With :math:`u = h/h_0` the ideal law has the tension
    :math:`\sigma_0 = \Delta\gamma_0/h_0` for :math:`1 < u < 2`, so the range is h_0 and the
    energy is the work of adhesion; surfaces touch at u = 1. Simulations need a continuous
    tension: here it rises from 0 at u = 1 to :math:`\sigma_0` along a parabola of width r
    (``rise``), and falls to 0 along two parabolas of total width f (``fall``) around u = 2 + r/3,
    which preserves the energy. Below u = 1 the wall is a spring of stiffness :math:`2 \sigma_0/(r
    h_0)`.

    Parameters
    ----------
    work_of_adhesion : float
        Delta-gamma_0, work to separate unit area from the equilibrium gap [J/m^2]; positive.
    equilibrium_gap : float
        h_0 [m], positive: both the gap of touching surfaces and the range of the tension,
        equal to work of adhesion over strength.
    rise, fall : float
        Widths r in (0, 0.5] and f in (0, 1], relative to h_0; smaller values are closer to Dugdale.

    Notes
    -----
    With this h_0 the Tabor number mu and the Maugis parameter are related by
    lambda = (9/(2 pi))^(1/3) mu = 1.127 mu. The force of a simulated contact agrees with
    Maugis' within about 1 in 1000 for a fall of 0.5 if the wall is stiff enough: a rise of 1e-4
    is sufficient for lambda above 0.5, and a tenth of that at 0.05. With a fall of 1 the error is
    up to 3 in 1000. If the fall is smaller than the change of the gap between nodes, the edge jumps
    from node to node; a higher accuracy setting refines the nodes.

    References
    ----------
    Maugis (1992), doi:10.1016/0021-9797(92)90285-T.

    Examples
    --------
    >>> law = Dugdale(work_of_adhesion=0.15, equilibrium_gap=0.15 / 100e3)
    >>> f"{law.equilibrium_gap * 1e6:.2f} um, {law.strength / 1e3:.0f} kPa"
    '1.50 um, 100 kPa'
    """

    word: ClassVar[str] = "dugdale"

    rise: Annotated[
        float, Quantity("1", "r", "width over h0 of the rise of the tension", above=0, most=0.5)
    ] = 1e-4
    fall: Annotated[
        float, Quantity("1", "f", "width over h0 of the fall of the tension", above=0, most=1)
    ] = 0.5

    def traction(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the traction [Pa], positive in tension, at a gap [m] of any shape."""
        r, f = self.rise, self.fall
        wall, rising, _ = self._up(gap)
        early, late, _ = self._down(gap)
        up = 2 * wall / r + rising * (2 - rising / r) / r
        down = 2 * early**2 / f**2 + 2 * late * (f - late) / f**2
        return self.strength * (up - down)

    def energy(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the energy per area [J/m^2] at a gap [m]: 0 at infinity, minimum at h_0."""
        r, f = self.rise, self.fall
        wall, rising, risen = self._up(gap)
        early, late, gone = self._down(gap)
        up = wall**2 / r + rising**2 * (1 - rising / (3 * r)) / r + risen
        down = 2 * early**3 / (3 * f**2) + late / 2 + late**2 / f - 2 * late**3 / (3 * f**2) + gone
        return self.work_of_adhesion * (up - down - 1)

    def energy_beyond(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from a gap [m] to infinity [J/m]; 0 beyond the range.

        Multiplied by 2 pi R it is the energy of a sphere's flank that begins at this gap
        (Derjaguin).
        """
        so_far = self._energy_until(np.minimum(checked_gap(gap), self._end))
        left = self._energy_until_end - so_far
        return self.work_of_adhesion * self.equilibrium_gap * left

    def stiffness(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the derivative of the traction by the gap [Pa/m]; negative where it softens."""
        r, f = self.rise, self.fall
        _, rising, _ = self._up(gap)
        early, late, _ = self._down(gap)
        down = np.where(late > 0, 2 / f - 4 * late / f**2, 4 * early / f**2)
        return self.strength / self.equilibrium_gap * (2 * (1 - rising / r) / r - down)

    @property
    def strength(self) -> float:
        """Constant tension [Pa], work of adhesion over range."""
        return self.work_of_adhesion / self.equilibrium_gap

    @property
    def edge_gap(self) -> float:
        """Gap at which the tension is first constant [m]; defines the contact edge."""
        return (1 + self.rise) * self.equilibrium_gap

    @property
    def _end(self) -> float:
        """Gap above which the tension is zero [m]."""
        return self.equilibrium_gap * (2 + self.rise / 3 + self.fall / 2)

    @cached_property
    def _energy_until_end(self) -> float:
        return float(self._energy_until(self._end))

    def _up(self, gap: npt.ArrayLike) -> tuple[npt.NDArray, npt.NDArray, npt.NDArray]:
        """Return how far a gap is into the wall (not positive), up the rise and beyond [h_0]."""
        x = checked_gap(gap) / self.equilibrium_gap - 1
        return np.minimum(x, 0), np.clip(x, 0, self.rise), np.maximum(x - self.rise, 0)

    def _down(self, gap: npt.ArrayLike) -> tuple[npt.NDArray, npt.NDArray, npt.NDArray]:
        """Return how far a gap is down the two halves of the fall, and beyond it [h_0]."""
        half = self.fall / 2
        y = checked_gap(gap) / self.equilibrium_gap - 2 - self.rise / 3
        return np.clip(y + half, 0, half), np.clip(y, 0, half), np.maximum(y - half, 0)

    def _energy_until(self, gap: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the integral of the energy from h_0 to a gap, dimensionless."""
        r, f = self.rise, self.fall
        wall, rising, risen = self._up(gap)
        early, late, gone = self._down(gap)
        up = (wall**3 + rising**3) / (3 * r) - rising**4 / (12 * r**2)
        up = up + 2 * r * risen / 3 + risen**2 / 2
        down = early**4 / (6 * f**2) + f * late / 12 + late**2 / 4 + late**3 / (3 * f)
        down = down - late**4 / (6 * f**2) + f * gone / 2 + gone**2 / 2
        return up - down - (wall + rising + risen)


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
