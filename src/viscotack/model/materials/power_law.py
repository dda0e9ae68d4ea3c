r"""Modified power law: a broad spectrum with four constants, in two forms.

The two classes share the names `exponent` and `tau0` but are DIFFERENT materials: with the same
numbers they are not reciprocal (they differ by factors up to 8 at k = 0.1, up to
2000 at k = 5e-4). Simulations, the crack theory and the published fit of a silicone (Eq. 4.27 of
Maghami, PhD thesis (2025)) use the retardation form.

Functions without a closed form in one form follow from the other: its spectrum is a sum of nodes
(exact to round-off), and sums of exponentials are interconverted exactly.
"""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.model.materials.checks import like_input, nonnegative
from viscotack.model.materials.constants import (
    Exponent,
    GlassyModulus,
    PoissonRatio,
    RelaxationTime,
    RetardationTime,
    RubberyModulus,
)
from viscotack.model.materials.interconversion import reciprocal
from viscotack.model.materials.material import Complex, Real, Solid
from viscotack.model.materials.modes import ROUNDING, Modes, compressed
from viscotack.model.materials.spectrum import FINE, coarse_step, crept, nodes, summed, transform


@dataclass(frozen=True, kw_only=True)
class RetardationPowerLaw(Solid):
    r"""Solid with a power-law spectrum of retardation times; the default in simulations.

    .. math::

        L(\tau) = \frac{C_0 - C_\infty}{\Gamma(n)} \left(\frac{\tau}{\tau_0}\right)^n
        e^{-\tau/\tau_0} , \qquad
        E_0 C(t) = 1 - \frac{2 (1 - k)}{\Gamma(n)} \hat t^{n/2} \mathbf{K}_n(2 \sqrt{\hat t})

    (Eq. 4.6 and 4.10), with k = E0/Einf and t = tau0 times t-hat.

    Parameters
    ----------
    rubbery_modulus : float
        Long-time Young's modulus E0 = 1/C0 [Pa], positive.
    glassy_modulus : float
        Short-time Young's modulus [Pa], not below the rubbery one.
    exponent : float
        n, in (0, 3]: small for a broad spectrum; about 1.6 resembles a standard solid.
    tau0 : float
        Characteristic retardation time [s], positive.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    Creep compliance and complex functions have relative errors below 1e-13 (real and imaginary
    part each) over 25 decades of time and frequency and for k down to 1e-6; the relaxation
    modulus below 1e-12.

    References
    ----------
    Maghami, PhD thesis (2025), Eq. 4.6-4.10 and Eq. 18-25. After Williams (1964), Structural
    analysis of viscoelastic materials, AIAA Journal 2, 785-808.

    Examples
    --------
    Silicone (PDMS 10:1), Eq. 4.27; storage modulus at 1 kHz:

    >>> pdms = RetardationPowerLaw(
    ...     rubbery_modulus=1.458e6, glassy_modulus=3.089e9, exponent=0.2207, tau0=0.01876,
    ...     poisson_ratio=0.5,
    ... )
    >>> f"{pdms.complex_modulus(2 * np.pi * 1e3).real / 1e6:.4f} MPa"
    '3.3531 MPa'
    >>> f"{pdms.creep(1e-6) * pdms.rubbery_modulus:.4f}"
    '0.1487'
    """

    word: ClassVar[str] = "power-law"

    rubbery_modulus: RubberyModulus
    glassy_modulus: GlassyModulus
    exponent: Exponent
    tau0: RetardationTime
    poisson_ratio: PoissonRatio

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], from glassy to rubbery, at times [s] (Eq. 4.9)."""
        t = nonnegative("time", time, "s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        return like_input(Cinf + (C0 - Cinf) * crept(self.exponent, t / self.tau0))

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], from glassy to rubbery, at times [s].

        This is the reciprocal of the creep in the sense of E*(s) C*(s) = 1, not Eq. 4.4.
        """
        t = nonnegative("time", time, "s") / self.tau0
        k = self.modulus_ratio
        if k == 1:
            return like_input(np.full(t.shape, self.rubbery_modulus))
        # the algebra of a Prony series, with times in place of rates
        weights, tau = nodes(self.exponent, smallest=_smallest(t, self), step=FINE)
        E, relaxation_time = reciprocal(k, (1 - k) * weights, tau)
        relaxing = summed(lambda ratio: np.exp(-ratio), E, t, relaxation_time)
        return like_input(self.rubbery_modulus * (1 + relaxing))

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return C' - i C'' [1/Pa] at angular frequencies [rad/s] (Eq. 4.7)."""
        w = nonnegative("omega", omega, "rad/s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        with np.errstate(divide="ignore", over="ignore"):
            inverse = 1 / (w * self.tau0)
        return like_input(Cinf + (C0 - Cinf) * np.conj(transform(self.exponent, inverse)))

    def _modes(self, shortest: float, longest: float, tolerance: float) -> Modes:
        n, k, tau0 = self.exponent, self.modulus_ratio, self.tau0
        step, error = coarse_step(n, longest=longest / tau0, tolerance=0.6 * tolerance / (1 - k))
        # modes that have relaxed to exp(-40) at the shortest time are instantaneous
        weights, tau = nodes(n, smallest=shortest / tau0 / 40, step=step)
        window = shortest, longest, 0.4 * tolerance
        error = (1 - k) * error + 1e-15
        return compressed(k, (1 - k) * weights, tau0 * tau, *window, error=error)


@dataclass(frozen=True, kw_only=True)
class RelaxationPowerLaw(Solid):
    r"""Solid with a power-law spectrum of relaxation times.

    .. math::

        H(\tau) = \frac{E_\infty - E_0}{\Gamma(n)} \left(\frac{\tau_0}{\tau}\right)^n
        e^{-\tau_0/\tau} , \qquad
        R(t) = E_0 + \frac{E_\infty - E_0}{(1 + t/\tau_0)^n}

    (Eq. 4.1 and 4.4). With the same numbers this is NOT the material of
    :class:`RetardationPowerLaw`.

    Parameters
    ----------
    rubbery_modulus : float
        Long-time Young's modulus E0 [Pa], positive.
    glassy_modulus : float
        Short-time Young's modulus Einf [Pa], not below the rubbery one.
    exponent : float
        n, in (0, 3]: minus the slope of the relaxation in double-logarithmic axes.
    tau0 : float
        Characteristic RELAXATION time [s], positive: the spectrum is cut off below it.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    Relaxation modulus and complex functions have relative errors below 1e-13 (real and imaginary
    part each) over 25 decades of time and frequency and for k down to 1e-6; the creep
    compliance below 1e-12.

    References
    ----------
    Maghami, PhD thesis (2025), Eq. 4.1-4.5 and Eq. 8-14. After Williams (1964), Structural
    analysis of viscoelastic materials, AIAA Journal 2, 785-808.

    Examples
    --------
    >>> solid = RelaxationPowerLaw(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, exponent=0.6, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> f"{solid.relaxation(1e-3) / 1e6:.4f} MPa, {solid.creep(1e-3) * 1e6:.4f} 1/MPa"
    '6.9378 MPa, 0.1381 1/MPa'
    """

    word: ClassVar[str] = "relaxation-power-law"

    rubbery_modulus: RubberyModulus
    glassy_modulus: GlassyModulus
    exponent: Exponent
    tau0: RelaxationTime
    poisson_ratio: PoissonRatio

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], from glassy to rubbery, at times [s] (Eq. 4.4)."""
        t = nonnegative("time", time, "s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        return like_input(E0 + (Einf - E0) / (1 + t / self.tau0) ** self.exponent)

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], from glassy to rubbery, at times [s].

        This is the reciprocal of the relaxation in the sense of E*(s) C*(s) = 1, not Eq. 4.9.
        """
        t = nonnegative("time", time, "s") / self.tau0
        k = self.modulus_ratio
        if k == 1:
            return like_input(np.full(t.shape, 1 / self.rubbery_modulus))
        with np.errstate(divide="ignore", over="ignore"):
            inverse = 1 / t
        C, tau = self._retardation(smallest=_smallest(inverse, self), step=FINE)
        crept = summed(lambda ratio: -np.expm1(-ratio), C, t, tau)
        return like_input((k + crept) / self.rubbery_modulus)

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s] (Eq. 4.2)."""
        w = nonnegative("omega", omega, "rad/s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        return like_input(E0 + (Einf - E0) * transform(self.exponent, w * self.tau0))

    def _modes(self, shortest: float, longest: float, tolerance: float) -> Modes:
        # the relative error of R - E0 is uniform in time and equals that of the creep at long times
        step, _ = coarse_step(self.exponent, longest=np.inf, tolerance=tolerance)
        smallest = _smallest(np.array([self.tau0 / longest]), self)
        C, tau = self._retardation(smallest=smallest, step=step)
        reference, reference_tau = self._retardation(smallest=smallest, step=step / 2)
        window = shortest, longest, tolerance / 2
        modes = compressed(self.modulus_ratio, C, self.tau0 * tau, *window, error=0.0)
        t = np.geomspace(shortest, longest, 2 + int(np.log(longest / shortest) / (step / 8)))
        exact = summed(lambda ratio: -np.expm1(-ratio), reference, t / self.tau0, reference_tau)
        missed = np.max(np.abs(modes.creep(t) - self.modulus_ratio - exact))
        return replace(modes, error=1.05 * float(missed) + ROUNDING)

    def _retardation(self, *, smallest: float, step: float) -> tuple[Array, Array]:
        """Return weights and ascending retardation times, relative to tau0, of E0 C(t)."""
        k = self.modulus_ratio
        weights, rate = nodes(self.exponent, smallest=smallest, step=step)
        C, retardation_rate = reciprocal(1.0, (1 / k - 1) * weights, rate)
        return C[::-1], 1 / retardation_rate[::-1]


def _smallest(u: Array, material: RetardationPowerLaw | RelaxationPowerLaw) -> float:
    """Return the node below which the spectrum is replaced by its mean, for times u.

    A node contributes to second order in its distance from u. All together are negligible
    if their weight is below the rounding of the floor (k, or 1 relative to 1/k).
    """
    asked = u[(u > 0) & np.isfinite(u)]
    nearest = 1e-8 * float(np.min(asked)) if asked.size else 1e-8
    return max(nearest, (1e-17 * material.modulus_ratio) ** (1 / material.exponent))
