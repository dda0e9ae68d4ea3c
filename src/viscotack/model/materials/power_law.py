r"""Modified power law: a broad spectrum with four constants, in two forms.

The two classes share the names `exponent` and `tau0` but are DIFFERENT materials: with the same
numbers they are not reciprocal (they differ by factors up to 8 at k = 0.1, up to
2000 at k = 5e-4). Simulations, the crack theory and the published fit of a silicone (Eq. 4.27 of
Maghami, PhD thesis (2025)) use the retardation form.

Functions without a closed form in one form follow from the other: its spectrum is a sum of nodes
(exact to round-off), and sums of exponentials are interconverted exactly.

**Spectrum of the modified power law, as nodes and weights.** Both forms of the material share one
density per ln u, the gamma distribution

.. math:: \frac{u^n e^{-u}}{\Gamma(n)} ,

with u = tau/tau0 for the retardation form (Eq. 4.6) and u = tau0/tau for the relaxation form
(Eq. 4.1) of Maghami, PhD thesis (2025). The trapezoidal rule in ln u approximates every integral
over it with an error of exp(-pi^2/step), because the integrands are analytic for \|Im ln u\| <
pi/2: a step of 0.2 is exact to round-off for every exponent, integers included.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.model.materials.constants import (
    Exponent,
    GlassyModulus,
    PoissonRatio,
    RelaxationTime,
    RetardationTime,
    RubberyModulus,
    like_input,
    nonnegative,
)
from viscotack.model.materials.material import Complex, Real, Solid
from viscotack.model.materials.modes import (
    ROUNDING,
    Modes,
    blockwise,
    compressed,
    maxwell,
    reciprocal,
)

FINE = 0.2  # exp(-pi^2/0.2) = 4e-22
_FIRST, _LAST = -37.0, math.log(60)  # ln u where exp(-u) is 1 to round-off, and where it is 0


def nodes(exponent: float, *, smallest: float, step: float) -> tuple[Array, Array]:
    """Return normalised weights and ascending nodes u of the spectrum.

    The first node replaces the whole spectrum below `smallest`, with its exact weight and
    mean, so that small exponents need no long tail of nodes.
    """
    n = exponent
    first = min(math.log(max(smallest, 1e-300)), _FIRST)
    y = step * np.arange(math.floor(first / step), math.ceil(_LAST / step))
    u = np.exp(y)
    weights = np.exp(n * y - u)
    # below y[0], exp(-u) is 1, so the sums over y[0] - step, y[0] - 2 step, ... are geometric
    weight = np.exp(n * y[0]) / math.expm1(n * step)
    mean = u[0] * math.expm1(n * step) / math.expm1((n + 1) * step)
    weights = np.concatenate(([weight], weights))
    return weights / np.sum(weights), np.concatenate(([mean], u))


def transform(exponent: float, x: Array) -> npt.NDArray[np.complex128]:
    r"""Average i x/(u + i x) over the spectrum, for x in [0, inf].

    .. math:: \Phi_n(s) = s e^s \mathbf{E}_n(s), \quad s = i x

    (Eq. 4.2 and 4.7), without the exponential integral of complex argument: each part is a sum
    of positive terms, with a relative error of 1e-14 for x from 1e-25 to 1e25.
    """
    mean = np.where(np.isinf(x), 1.0 + 0j, 0j)
    inside = (x > 0) & np.isfinite(x)
    if np.any(inside):
        # the mean of 1/(1 + (u/x)^2) and of (u/x)/(1 + (u/x)^2) for u below x/1e8 is that of 1 and
        # u/x
        weights, u = nodes(exponent, smallest=float(np.min(x[inside])) * 1e-8, step=FINE)
        mean[inside] = summed(maxwell, weights, x[inside], u)
    return mean


def crept(exponent: float, t: Array) -> Array:
    r"""Average 1 - exp(-t/u) over the spectrum, for t in [0, inf].

    .. math:: 1 - \frac{2}{\Gamma(n)} t^{n/2} \mathbf{K}_n(2 \sqrt{t})

    (Eq. 4.10 with k = 0). For small t, where this formula cancels, the integral itself is
    evaluated.
    """
    n = exponent
    late = np.clip(t, 0.1, 1e6)  # exp(-2000) is zero
    root = 2 * np.sqrt(late)
    mean = np.array(
        1
        - 2 * scipy.special.rgamma(n) * late ** (n / 2) * scipy.special.kve(n, root) * np.exp(-root)
    )
    early = (t > 0) & (t < 0.1)
    if np.any(early):
        weights, u = nodes(n, smallest=float(np.min(t[early])) / 40, step=FINE)
        mean[early] = summed(lambda ratio: -np.expm1(-ratio), weights, t[early], u)
    return np.where(t == 0, 0.0, mean)


def summed(
    kernel: Callable[[Array], npt.NDArray], weights: Array, x: Array, u: Array
) -> npt.NDArray:
    """Sum weights times kernel(x/u) over the nodes u; the result has the shape of x."""
    return blockwise(lambda column: kernel(column / u), weights, x)


def coarse_step(exponent: float, *, longest: float, tolerance: float) -> tuple[float, float]:
    r"""Return the widest step of the nodes for a tolerated error of the creep, and that error.

    The error of the trapezoidal rule is given by its first harmonic, with s = 2 pi/step and
    nu = n + i s (weights normalised to the sum 1):

    .. math::

        \frac{2}{\Gamma(n)} \left| \int_0^\infty u^{\nu-1} e^{-u} (1 - e^{-t/u}) du
        - \Gamma(\nu) F(t) \right| ,

    where F is the exact creep. For t <= longest it is bounded by the smaller of
    \|Gamma(nu)\| (1 + 2.2/(1 + 2n)), an envelope of the largest values for n in (0, 3] and
    s <= 23, and of \|Gamma(nu)\| F + exp(t/s) (t^n \|Gamma(-nu)\| + t \|Gamma(nu - 1)\|), from the
    series in t.
    """
    n, t = exponent, longest
    s = np.arange(3.0, 30.0, 0.1)
    nu = n + 1j * s
    G = np.exp(scipy.special.loggamma(nu).real) * scipy.special.rgamma(n)  # |Gamma(nu)|/Gamma(n)
    bound = G * (1 + 2.2 / (1 + 2 * n))
    if t < 1:
        reflected = np.pi / np.abs(nu * np.sin(np.pi * nu)) / G * scipy.special.rgamma(n) ** 2
        early = np.exp(t / s) * (t**n * reflected + t * G / np.abs(nu - 1))
        bound = np.minimum(bound, early + G * crept(n, np.array([t])))
    error = 2.1 * bound  # 5 % for the higher harmonics
    first = int(np.argmax(error <= tolerance)) if error[-1] <= tolerance else s.size - 1
    return 2 * np.pi / float(s[first]), float(error[first])


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
