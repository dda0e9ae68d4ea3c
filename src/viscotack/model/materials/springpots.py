r"""Pairs of springpots: laws for fits only.

The stress of a springpot of order a under a strain e is E tau^a d^a e/dt^a: a spring for a = 0, a
dashpot for a = 1 (Schiessel, Metzler, Blumen & Nonnenmacher, Journal of Physics A 28 (1995)
6567-6584, doi:10.1088/0305-4470/28/23/012). Two of them describe many gels, melts and foods with
four constants over the measured decades. Beyond, their moduli continue as powers of time: there is
neither a rubbery plateau, needed for a relaxed contact, nor a glassy one, needed for a fast crack.
Every simulation would depend on an arbitrary cut-off, so none is allowed;
:class:`viscotack.model.materials.FractionalZener` has both plateaus.

Relaxation in series and creep in parallel are two-parameter Mittag-Leffler functions. They are
computed from their spectrum of exponentials, which follows from the modulus across the branch cut
at negative s, as a sum of positive terms by the trapezoidal rule in ln s.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.cards import conform
from viscotack.errors import InputError
from viscotack.model.materials.checks import like_input
from viscotack.model.materials.constants import (
    CharacteristicModulus,
    CharacteristicTime,
    LowerOrder,
    PoissonRatio,
    UpperOrder,
)
from viscotack.model.materials.material import Complex, Real
from viscotack.model.materials.modes import blockwise

NO_PLATEAU = (
    "two springpots have neither a rubbery nor a glassy plateau: their modulus continues as a "
    "power of time, and a simulated contact would depend on an arbitrary cut-off. Fit "
    "fractional-zener, or a Prony series over the measured range"
)
_FINE = 0.127  # of the width in which the integrand is analytic: exp(-2 pi/0.127) = 3e-22
_LAST = 40.0  # decrease of ln(integrand) beyond which it is neglected


class _Springpots:
    """Common part of the pairs: one complex function by the other, and their spectrum."""

    no_contact: ClassVar[str] = NO_PLATEAU
    modulus: Any
    order: Any
    lower_order: Any
    tau0: Any

    def __post_init__(self) -> None:
        conform(self)
        if not 0 <= self.order - self.lower_order <= 0.99:
            raise InputError(
                "lower_order must not be above order, and not more than 0.99 below it, got "
                f"{self.lower_order:g} and {self.order:g}; use a Prony series for a spring and a "
                "dashpot"
            )

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s]."""
        return 1 / self.complex_compliance(omega)

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return C' - i C'' [1/Pa] at angular frequencies [rad/s]."""
        return 1 / self.complex_modulus(omega)

    def _powers(self, omega: npt.ArrayLike, sign: int) -> npt.NDArray[Any]:
        """Return (i omega tau0)^a + (i omega tau0)^b, with the sign of the orders."""
        x = _inside("omega", omega, "rad/s") * self.tau0

        def power(order: float) -> npt.NDArray[Any]:
            angle = math.pi * order / 2
            return x**order * complex(math.cos(angle), math.sin(angle))

        return power(sign * self.order) + power(sign * self.lower_order)

    def _spectrum(self, y: Array, first: float, second: float) -> Array:
        """Return the spectrum at the rate exp(y)/tau0, but for its power of the rate."""
        apart = self.order - self.lower_order
        rising = np.exp(apart * y)
        across = 1 + 2 * math.cos(math.pi * apart) * rising + rising**2
        parts = math.sin(math.pi * first) + rising * math.sin(math.pi * second)
        return parts / across / math.pi


@dataclass(frozen=True, kw_only=True)
class FractionalMaxwell(_Springpots):
    r"""Two springpots in series (fractional Maxwell model).

    .. math:: E(\omega) = E \frac{(i \omega \tau_0)^a}{1 + (i \omega \tau_0)^{a-b}}

    Parameters
    ----------
    modulus : float
        E [Pa], positive: each springpot alone has this modulus at 1/tau0.
    order, lower_order : float
        Orders: a in [0.05, 1] dominates at long times, b in [0, a] at short times; at most 0.99
        apart.
    tau0 : float
        Crossover time [s], positive.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    The relative error of the relaxation is below 1e-10; creep and complex functions are exact to
    round-off.

    Examples
    --------
    >>> melt = FractionalMaxwell(
    ...     modulus=1e5, order=0.9, lower_order=0.2, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> f"{melt.relaxation(2.0):.0f} Pa"
    '27815 Pa'
    """

    word: ClassVar[str] = "fractional-maxwell"

    modulus: CharacteristicModulus
    order: UpperOrder
    lower_order: LowerOrder
    tau0: CharacteristicTime
    poisson_ratio: PoissonRatio

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return C' - i C'' [1/Pa] at angular frequencies [rad/s], the sum of both compliances."""
        return like_input(self._powers(omega, -1) / self.modulus)

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa] at times [s], the sum of both compliances."""
        T = _inside("time", time, "s") / self.tau0
        a, b = self.order, self.lower_order
        return like_input(
            (T**a * scipy.special.rgamma(1 + a) + T**b * scipy.special.rgamma(1 + b)) / self.modulus
        )

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa] at times [s], positive."""
        T = _inside("time", time, "s") / self.tau0
        a, b = self.order, self.lower_order

        def spectrum(y: Array) -> Array:
            """Return H at the rate exp(y)/tau0, over the modulus."""
            return np.exp(a * y) * self._spectrum(y, a, b)

        return like_input(
            self.modulus
            * _summed(T, spectrum, lambda r: np.exp(-r), width=_width(a - b), slow=a, fast=np.inf)
        )


@dataclass(frozen=True, kw_only=True)
class FractionalKelvinVoigt(_Springpots):
    r"""Two springpots in parallel (fractional Kelvin-Voigt model).

    .. math:: E(\omega) = E \left[(i \omega \tau_0)^a + (i \omega \tau_0)^b\right]

    Parameters
    ----------
    modulus : float
        E [Pa], positive: each springpot alone has this modulus at 1/tau0.
    order, lower_order : float
        Orders: a in [0.05, 1] dominates at short times, b in [0, a] at long times; at most 0.99
        apart.
    tau0 : float
        Crossover time [s], positive.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    The relative error of the creep is below 1e-10; relaxation and complex functions are exact to
    round-off.

    Examples
    --------
    >>> gel = FractionalKelvinVoigt(
    ...     modulus=1e4, order=0.7, lower_order=0.1, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> f"{gel.creep(2.0) * 1e4:.4f} of 1/modulus"
    '0.5907 of 1/modulus'
    """

    word: ClassVar[str] = "fractional-kelvin-voigt"

    modulus: CharacteristicModulus
    order: UpperOrder
    lower_order: LowerOrder
    tau0: CharacteristicTime
    poisson_ratio: PoissonRatio

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s], the sum of both moduli."""
        return like_input(self.modulus * self._powers(omega, 1))

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa] at times [s], the sum of both moduli."""
        T = _inside("time", time, "s") / self.tau0
        a, b = self.order, self.lower_order
        # 1/Gamma(0) is 0: a dashpot contributes only at the instant of the step
        return like_input(
            self.modulus
            * (T**-a * scipy.special.rgamma(1 - a) + T**-b * scipy.special.rgamma(1 - b))
        )

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa] at times [s], positive."""
        T = _inside("time", time, "s") / self.tau0
        a, b = self.order, self.lower_order

        def spectrum(y: Array) -> Array:
            """Return L at the rate exp(y)/tau0, times the modulus."""
            return np.exp(-b * y) * self._spectrum(y, b, a)

        return like_input(
            _summed(T, spectrum, lambda r: -np.expm1(-r), width=_width(a - b), slow=1 - b, fast=a)
            / self.modulus
        )


def _inside(name: str, values: npt.ArrayLike, unit: str) -> Array:
    """Return times or frequencies in (0, inf); raise an error at 0 and infinity."""
    array = np.asarray(values, dtype=float)
    wrong = array[~((array > 0) & (array < np.inf))]
    if wrong.size:
        raise InputError(
            f"{name} must be positive and finite, got {wrong[0]} {unit}: springpots have no plateau"
        )
    return array


def _width(apart: float) -> float:
    """Return the half-width of the strip about real ln s where the integrands are analytic."""
    return math.pi / 2 if apart < 2 / 3 else math.pi * (1 - apart) / apart


def _summed(
    T: Array,
    spectrum: Callable[[Array], Array],
    kernel: Callable[[Array], Array],
    *,
    width: float,
    slow: float,
    fast: float,
) -> Array:
    """Integrate spectrum times kernel(rate times time) over the logarithm of rates.

    The integrand decays as exp(slow y) below all times and as exp(-fast y) above them.
    """
    x = np.log(np.ravel(T))
    low = min(0.0, -float(np.max(x, initial=0.0))) - _LAST / slow
    high = max(0.0, -float(np.min(x, initial=0.0))) + (_LAST / fast if np.isfinite(fast) else 5.0)
    step = _FINE * width
    y = np.arange(low, high + step, step)
    weights = step * spectrum(y)
    return blockwise(lambda column: kernel(np.exp(column + y)), weights, x).reshape(np.shape(T))
