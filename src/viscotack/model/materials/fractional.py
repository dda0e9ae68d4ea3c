r"""Fractional Zener solid: a standard solid with a springpot in place of the dashpot.

The stress of a springpot is proportional to the fractional derivative of order a of the strain,
between a spring (a = 0) and a dashpot (a = 1). The relaxation functions are Mittag-Leffler
functions, with power-law decay on both sides of tau0, and each is a sum of exponentials with a
positive spectrum,

.. math::

    \mathbf{E}_a(-x^a) = \int e^{-x/u} h_a(u)\, d\ln u , \qquad
    h_a = \frac{\sin \pi a}{2 \pi (\cosh(a \ln u) + \cos \pi a)}

(Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity, 2nd ed. (2022),
doi:10.1142/p926, Sec. 3.4). As a function of ln u it is analytic for \|Im ln u\| < d, the smaller
of pi/2 (from the exponential) and pi (1 - a)/a (from h_a), so the trapezoidal rule has an error of
exp(-2 pi d/step).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.constants import (
    FractionalOrder,
    GlassyModulus,
    PoissonRatio,
    RetardationTime,
    RubberyModulus,
    like_input,
    nonnegative,
)
from viscotack.model.materials.material import Complex, Real, Solid
from viscotack.model.materials.modes import FINEST, ROUNDING, Modes, blockwise, compressed

_FINE = 0.127  # of the width d: exp(-2 pi/0.127) = 3e-22
_LAST = 60.0  # a |ln u| above which the spectrum is below round-off for any k


@dataclass(frozen=True, kw_only=True)
class FractionalZener(Solid):
    r"""Solid whose creep is a Mittag-Leffler function of time (fractional Zener model).

    .. math::

        E_0 C(t) = 1 - (1 - k)\, \mathbf{E}_a(-(t/\tau_0)^a) , \qquad
        E(\omega) = E_0 + (E_\infty - E_0) \frac{(i \omega \tau_R)^a}{1 + (i \omega \tau_R)^a} ,
        \qquad \tau_R = k^{1/a} \tau_0

    with k = E0/Einf. Modulus and compliance have the form of the Cole-Cole law.

    Parameters
    ----------
    rubbery_modulus : float
        Long-time Young's modulus E0 [Pa], positive.
    glassy_modulus : float
        Short-time Young's modulus [Pa], not below the rubbery one.
    order : float
        Order a of the springpot, in (0, 0.95]; a = 1 would be the standard solid.
    tau0 : float
        RETARDATION time [s], positive. The relaxation time is k^(1/a) tau0: `relaxation_time`.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    All four functions have relative errors below 1e-12. For t << tau0 the creep rises as t^a, and
    for t >> tau0 it approaches its limit as t^-a, more slowly than any exponential: after N tau0
    a fraction N^-a of it remains.

    References
    ----------
    Bagley & Torvik (1983), A theoretical basis for the application of fractional calculus to
    viscoelasticity, Journal of Rheology 27, 201-210, doi:10.1122/1.549724. Cole & Cole (1941),
    doi:10.1063/1.1750906.

    Examples
    --------
    >>> solid = FractionalZener(
    ...     rubbery_modulus=1e6, glassy_modulus=1e8, order=0.5, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> f"{solid.creep(2.0) * 1e6:.4f} 1/MPa, relaxes in {solid.relaxation_time * 1e6:.0f} us"
    '0.5767 1/MPa, relaxes in 200 us'
    """

    word: ClassVar[str] = "fractional-zener"

    rubbery_modulus: RubberyModulus
    glassy_modulus: GlassyModulus
    order: FractionalOrder
    tau0: RetardationTime
    poisson_ratio: PoissonRatio

    @property
    def relaxation_time(self) -> float:
        """Relaxation time k^(1/a) tau0 [s], never longer than the retardation time."""
        return self.modulus_ratio ** (1 / self.order) * self.tau0

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], from glassy to rubbery, at times [s]."""
        t = nonnegative("time", time, "s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        # in logarithms, because the relaxation time underflows at small orders
        return like_input(E0 + (Einf - E0) * remaining(self.order, _log(t) - self._log_relaxation))

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], from glassy to rubbery, at times [s]."""
        t = nonnegative("time", time, "s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        return like_input(Cinf + (C0 - Cinf) * passed(self.order, _log(t) - math.log(self.tau0)))

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        return like_input(E0 + (Einf - E0) * _cole(self.order, _log(w) + self._log_relaxation))

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return 1/(E' + i E'') = C' - i C'' [1/Pa] at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        # 1/(1 + z) equals z/(1 + z) at the conjugate of 1/z
        passing = np.conj(_cole(self.order, -_log(w) - math.log(self.tau0)))
        return like_input(Cinf + (C0 - Cinf) * passing)

    def _modes(self, shortest: float, longest: float, tolerance: float) -> Modes:
        a, k = self.order, self.modulus_ratio
        tolerance = max(tolerance, FINEST)
        first, last = math.log(shortest / self.tau0), math.log(longest / self.tau0)
        step = 3 * math.pi * _width(a) / math.log(4 / tolerance)
        # The error oscillates with one step in the logarithm of time, and its amplitude varies over
        # the width of the kernel: sampling one period every quarter of an e-fold finds the maximum.
        waves = np.linspace(first, last, 2 + int((last - first) / max(step, 0.25)))
        at = np.unique(np.minimum(waves[:, None] + step * np.arange(16) / 16, last))
        exact = k + (1 - k) * passed(a, at)
        missed = math.inf
        while step > _FINE * _width(a):
            weights, log_u = nodes(a, step)
            # merge the modes faster, and those slower, than the window into one each
            inside = np.clip(log_u, first - 5, last - math.log(tolerance) + 5)
            log_u, place = np.unique(inside, return_inverse=True)
            weights = (1 - k) * np.bincount(place, weights=weights).astype(float)
            window = shortest, longest, tolerance / 2
            modes = compressed(k, weights, self.tau0 * np.exp(log_u), *window, error=0.0)
            missed = float(np.max(np.abs(modes.creep(self.tau0 * np.exp(at)) - exact)))
            error = 1.05 * missed + ROUNDING
            if error <= tolerance:
                return Modes(modes.instantaneous, modes.weights, modes.times, error)
            step *= 0.85
        raise InputError(
            f"the closest modes have an error of {missed:.1e}, above the tolerance {tolerance:g}; "
            "increase the tolerance"
        )

    @property
    def _log_relaxation(self) -> float:
        return math.log(self.modulus_ratio) / self.order + math.log(self.tau0)


def nodes(order: float, step: float) -> tuple[Array, npt.NDArray[Any]]:
    """Return normalised weights and nodes ln u of the spectrum of a Mittag-Leffler function."""
    a = order
    last = math.ceil(_LAST / a / step)
    y = step * np.arange(-last, last + 1, dtype=float)
    # cosh(a y) + cos(pi a) as a sum of positive terms
    weights = 1 / (np.sinh(a * y / 2) ** 2 + math.cos(math.pi * a / 2) ** 2)
    return weights / np.sum(weights), y


def passed(order: float, log_time: Array) -> Array:
    """Return 1 - E_a(-x^a) at ln x, from -inf to inf, as a sum of positive terms."""
    return _summed(order, log_time, lambda ratio: -np.expm1(-ratio), early=0.0, late=1.0)


def remaining(order: float, log_time: Array) -> Array:
    """Return E_a(-x^a) at ln x, from -inf to inf, as a sum of positive terms."""
    return _summed(order, log_time, lambda ratio: np.exp(-ratio), early=1.0, late=0.0)


def _summed(
    order: float, log_time: Array, kernel: Callable[[Array], Array], *, early: float, late: float
) -> Array:
    """Average a kernel of x/u over the spectrum, with its limits at 0 and infinity."""
    found = np.where(log_time > 0, late, early)
    inside = np.isfinite(log_time)
    if not np.any(inside):
        return found
    x = log_time[inside]
    weights, y = nodes(order, _FINE * _width(order))
    # exp(-exp(4)) is 0, and 1 - exp(-r) is r below exp(-37)
    fast, slow = y < np.min(x) - 4, y > np.max(x) + 37
    between = ~fast & ~slow
    constant = late * np.sum(weights[fast]) + early * np.sum(weights[slow])
    highest = float(np.max(x))
    rising = late * float(np.sum(weights[slow] * np.exp(highest - y[slow])))
    w, y = weights[between], y[between]
    middle = blockwise(lambda column: kernel(np.exp(column - y)), w, x)
    found[inside] = constant + rising * np.exp(x - highest) + middle
    return found


def _cole(order: float, log_x: Array) -> npt.NDArray[np.complex128]:
    """Return z/(1 + z) with z = (i x)^a at ln x, from -inf to inf, without cancellation."""
    cos, sin = math.cos(math.pi * order / 2), math.sin(math.pi * order / 2)
    with np.errstate(over="ignore", divide="ignore"):
        small = np.exp(-order * np.abs(log_x))  # the smaller of z and 1/z
        across = sin / (small + 2 * cos + 1 / small)
    above = 1 + 2 * cos * small + small**2
    part = np.where(log_x > 0, 1 + cos * small, small * (small + cos)) / above
    return part + 1j * across


def _width(order: float) -> float:
    """Return the half-width of the strip about real ln u where the integrands are analytic."""
    return min(math.pi / 2, math.pi * (1 - order) / order)


def _log(values: Array) -> Array:
    with np.errstate(divide="ignore"):
        return np.log(values)
