"""The solid of Cole and Cole, as a user would add one: one file, no edit of viscotack.

It is the solid that viscotack.model.materials has as FractionalZener, written anew.

viscotack simulate sphere --material cole-cole:0.6 --with examples/own/cole_cole.py
--modulus-ratio 0.1 --tabor 3 --preload 20 --rate 30
"""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack import Quantity
from viscotack.model.materials import Modes
from viscotack.model.materials.constants import (
    GlassyModulus,
    PoissonRatio,
    RetardationTime,
    RubberyModulus,
)
from viscotack.model.materials.material import Solid
from viscotack.model.materials.modes import FINEST, compressed, reciprocal

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ColeCole(Solid):
    r"""A spring in series with a spring and a springpot side by side.

    .. math:: C^*(\omega) = C_\infty + \frac{C_0 - C_\infty}{1 + (i \omega \tau_0)^a}, \quad
              w(\tau) = \frac{\sin \pi a}{2 \pi (\cosh(a \ln \tau/\tau_0) + \cos \pi a)}

    with w the weight of the retardation times per unit of ln tau (Cole and Cole).

    Parameters
    ----------
    rubbery_modulus, glassy_modulus : float
        Long-time and short-time Young's modulus [Pa].
    tau0 : float
        Retardation time [s].
    order : float
        Order a of the springpot, in (0, 0.95]; 1 would be the standard solid.
    poisson_ratio : float
        Between 0 and 0.5.

    References
    ----------
    Cole & Cole (1941), doi:10.1063/1.1750906, for the spectrum.
    """

    word: ClassVar[str] = "cole-cole"

    rubbery_modulus: RubberyModulus
    glassy_modulus: GlassyModulus
    tau0: RetardationTime
    order: Annotated[
        float, Quantity("1", "a", "order of the springpot", above=0, most=0.95, example="0.6")
    ]
    poisson_ratio: PoissonRatio

    def complex_compliance(self, omega: npt.ArrayLike) -> npt.NDArray[np.complex128]:
        """Return C' - i C'' [1/Pa] at angular frequencies [rad/s]."""
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        x = np.asarray(omega, dtype=float) * self.tau0
        with np.errstate(invalid="ignore"):
            passed = np.where(np.isinf(x), 0.0, 1 / (1 + (1j * x) ** self.order))
        return Cinf + (C0 - Cinf) * passed

    def creep(self, time: npt.ArrayLike) -> Array:
        """Return the creep compliance [1/Pa] at times [s]."""
        t = np.asarray(time, dtype=float)
        weight, tau = self._nodes(self._step(FINEST))
        crept = -np.expm1(-t[..., None] / tau) @ weight
        k = self.modulus_ratio
        return (k + (1 - k) * crept) / self.rubbery_modulus

    def relaxation(self, time: npt.ArrayLike) -> Array:
        """Return the relaxation modulus [Pa] at times [s]: the reciprocal of the creep."""
        t = np.asarray(time, dtype=float)
        k = self.modulus_ratio
        weight, tau = self._nodes(self._step(FINEST))
        stiff, relaxing = reciprocal(k, (1 - k) * weight, tau)
        return self.rubbery_modulus * (1 + np.exp(-t[..., None] / relaxing) @ stiff)

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        """Return the creep in exponential modes for shortest <= time <= longest [s].

        Nodes may use half of the tolerance, and `compressed` a quarter at each end.
        """
        k, tolerance = self.modulus_ratio, max(tolerance, FINEST)
        weight, tau = self._nodes(self._step(tolerance))
        return compressed(
            k,
            (1 - k) * weight,
            tau,
            shortest=shortest,
            longest=longest,
            tolerance=tolerance / 2,
            error=tolerance / 2,
        )

    def reduced(self) -> "ColeCole":
        """Return the dimensionless twin: rubbery modulus 1, tau0 1, Poisson ratio 0."""
        return replace(
            self,
            rubbery_modulus=1.0,
            glassy_modulus=self.glassy_modulus / self.rubbery_modulus,
            tau0=1.0,
            poisson_ratio=0.0,
        )

    def _step(self, tolerance: float) -> float:
        """Return a step of ln tau: nodes err by 2 exp(-2 pi d/step) and some more.

        The integrands are analytic for |Im ln tau| < d.
        """
        width = min(np.pi / 2, np.pi * (1 - self.order) / self.order)
        return min(0.5, 2 * np.pi * width / np.log(100 / tolerance))

    def _nodes(self, step: float) -> tuple[Array, Array]:
        """Return weights that add up to 1, and retardation times [s]: the rule of trapezoids."""
        a = self.order
        y = np.arange(-45 / a, 45 / a + step, step)
        weight = np.sin(np.pi * a) / (2 * np.pi * (np.cosh(a * y) + np.cos(np.pi * a)))
        return weight / weight.sum(), self.tau0 * np.exp(y)
