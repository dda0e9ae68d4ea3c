r"""Time-temperature superposition: the shift factor a_T of a solid at another temperature.

log10 a_T is positive where the solid is slower than at the reference temperature, that is below
it: relaxation times at T are a_T times those at the reference, and a modulus measured at omega and
T equals that at the reference temperature and omega a_T.
"""

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.model.materials.constants import POSSIBLE, like_input, store, temperatures
from viscotack.units import readable

# c1 and c2 [K] at the glass transition (Eq. 4.25): averages over many polymers
UNIVERSAL = 17.44, 51.6
DOUBTFUL = 150.0  # K: below it Celsius may have been meant
Reference = Annotated[
    float,
    Quantity(
        "K",
        "T0",
        "reference temperature",
        least=POSSIBLE[0],
        most=POSSIBLE[1],
        advice="give Celsius + 273.15",
    ),
]


def wlf_decades(above: Any, c1: float, c2: float) -> Any:
    """Return log10 a_T of the WLF law, for temperatures relative to its reference [K]."""
    return -c1 * above / (c2 + above)


@dataclass(frozen=True, kw_only=True)
class WLF:
    r"""Shift law of Williams, Landel and Ferry, for polymers above their glass transition.

    .. math:: \log_{10} a_T = -\frac{c_1 (T - T_0)}{c_2 + T - T_0}

    Parameters
    ----------
    reference_temperature : float
        T0 [K], 100 to 1,000; a warning asks below 150 K whether Celsius was meant. All three
        are keywords, because their order differs between texts.
    c1 : float
        Decades [-], positive.
    c2 : float
        Distance of the reference from the pole [K], positive: at T0 - c2 the solid would be
        infinitely slow.

    Notes
    -----
    The law is valid from the glass transition to about 100 K above it. Between the pole and the
    transition it returns a number that a glass out of equilibrium does not follow; at and below the
    pole it raises an error.

    References
    ----------
    Williams, Landel & Ferry (1955), doi:10.1021/ja01619a008. Maghami, PhD thesis (2025), Eq. 4.25.

    Examples
    --------
    PDMS at -100 C, relative to 20 C (Sec. 4.6.1 of the thesis):

    >>> wlf = WLF.from_glass_transition(158.15).at_reference(293.15)
    >>> round(wlf.log10_shift(173.15), 3)
    8.689
    """

    word: ClassVar[str] = "wlf"

    reference_temperature: Reference
    c1: Annotated[float, Quantity("1", "c1", "decades far above the reference", above=0)]
    c2: Annotated[float, Quantity("K", "c2", "distance of the reference from the pole", above=0)]

    def __post_init__(self):
        conform(self)
        if (self.c1, self.c2) != UNIVERSAL:  # silicones have glass transitions below 150 K
            _ask_about_celsius(self.reference_temperature)

    @classmethod
    def from_glass_transition(cls, temperature: float) -> Self:
        """Return the law with c1 = 17.44 and c2 = 51.6 K at the glass transition (Eq. 4.25).

        Parameters
        ----------
        temperature : float
            Glass transition temperature [K]. The constants are averages over many polymers.
        """
        c1, c2 = UNIVERSAL
        return cls(reference_temperature=temperature, c1=c1, c2=c2)

    @property
    def pole(self) -> float:
        """Temperature T0 - c2 [K] of the pole, with no shift at or below it."""
        return self.reference_temperature - self.c2

    def log10_shift(self, temperature: npt.ArrayLike) -> float | Array:
        """Return log10 a_T at temperatures [K] above the pole, in the shape given."""
        above = temperatures("temperature", temperature) - self.reference_temperature
        if np.any(above <= -self.c2):
            raise InputError(
                f"the WLF shift has its pole at {_in_celsius(self.pole)} and no value below, got "
                f"{_in_celsius(float(np.min(above)) + self.reference_temperature)}; "
                "omit these temperatures, or use a measured table of shifts"
            )
        return like_input(wlf_decades(above, self.c1, self.c2))

    def at_reference(self, temperature: float) -> "WLF":
        """Return the same law for another reference temperature [K], above the pole."""
        temperature = _reference(temperature)
        c2 = self.c2 + temperature - self.reference_temperature
        if c2 <= 0:
            raise InputError(
                f"the reference temperature must lie above the pole of the WLF shift at "
                f"{_in_celsius(self.pole)}, got {_in_celsius(temperature)}"
            )
        return WLF(reference_temperature=temperature, c1=self.c1 * self.c2 / c2, c2=c2)

    def words(self) -> str:
        """Describe the law in words."""
        return f"WLF with c1 = {self.c1:g}, c2 = {self.c2:g} K at {self.reference_temperature:g} K"


@dataclass(frozen=True)
class Arrhenius:
    r"""Shift law of a thermally activated process, for example below the glass transition.

    .. math:: \log_{10} a_T = \frac{E_a}{R \ln 10} \left(\frac{1}{T} - \frac{1}{T_0}\right)

    with the gas constant R = 8.314 J/(mol K).

    Parameters
    ----------
    reference_temperature : float
        T0 [K].
    activation_energy : float
        Ea [J/mol], positive.

    References
    ----------
    Ferry, Viscoelastic Properties of Polymers, 3rd ed., Wiley (1980), ch. 11.

    Examples
    --------
    >>> round(Arrhenius(298.15, 100e3).log10_shift(288.15), 3)
    0.608
    """

    word: ClassVar[str] = "arrhenius"

    reference_temperature: Reference
    activation_energy: Annotated[float, Quantity("J/mol", "E_a", "activation energy", above=0)]

    def __post_init__(self):
        conform(self)
        _ask_about_celsius(self.reference_temperature)

    def log10_shift(self, temperature: npt.ArrayLike) -> float | Array:
        """Return log10 a_T at temperatures [K], in the shape given."""
        inverse = 1 / temperatures("temperature", temperature) - 1 / self.reference_temperature
        return like_input(
            self.activation_energy / (scipy.constants.gas_constant * math.log(10)) * inverse
        )

    def at_reference(self, temperature: float) -> "Arrhenius":
        """Return the same law for another reference temperature [K]."""
        return replace(self, reference_temperature=temperature)

    def words(self) -> str:
        """Return the law as a person reads it."""
        return f"Arrhenius with {readable(self.activation_energy, 'J/mol', digits=6)}"


# K: accepted distance from the measured range, because chambers drift about their set point
BESIDE = 1.0


@dataclass(frozen=True)
class TabulatedShift:
    """Measured shift table, interpolated smoothly; temperatures outside it are rejected.

    Parameters
    ----------
    reference_temperature : float
        T0 [K], inside the table; there the shift is zero.
    temperature : tuple of float
        Temperatures of the table [K], ascending, two or more.
    values : tuple of float
        log10 a_T at these temperatures, relative to any temperature.
    uncertainty : tuple of float
        Standard deviation of each value; empty if unknown.
    vertical : tuple of float
        log10 of the factor that converts a modulus at these temperatures to the one where the
        values are zero; empty for 1.

    Notes
    -----
    Interpolated by the monotone cubic of Fritsch & Carlson (1980), doi:10.1137/0717021, which
    adds no extrema, and extrapolated linearly by up to 1 K, because a sweep at 0 C may be recorded
    with the -0.01 C of the chamber.

    Examples
    --------
    >>> table = TabulatedShift(293.15, (253.15, 273.15, 293.15), (5.0, 2.0, 0.0))
    >>> table.log10_shift(273.15)
    2.0
    >>> table.at_reference(273.15).log10_shift([253.15, 293.15]).tolist()
    [3.0, -2.0]
    """

    word: ClassVar[str] = "table"

    reference_temperature: float
    temperature: tuple[float, ...]
    values: tuple[float, ...]
    uncertainty: tuple[float, ...] = ()
    vertical: tuple[float, ...] = ()

    def __post_init__(self):
        temperature = temperatures("temperature", self.temperature)
        values = np.asarray(self.values, dtype=float)
        if temperature.ndim != 1 or temperature.size < 2 or temperature.shape != values.shape:
            raise InputError(
                "a table of shifts needs two or more temperatures and one value for each, got "
                f"shapes {temperature.shape} and {values.shape}"
            )
        if np.any(np.diff(temperature) <= 0):
            raise InputError("the temperatures of a table of shifts must ascend, each once")
        if not np.all(np.isfinite(values)):
            raise InputError("the values of a table of shifts must be finite")
        more = {}
        for name in ("uncertainty", "vertical"):
            column = np.asarray(getattr(self, name), dtype=float)
            if column.size and column.shape != values.shape:
                raise InputError(
                    f"{name} of a table of shifts needs one number per temperature or none, "
                    f"got {column.size} for {values.size}"
                )
            if not np.all(np.isfinite(column)) or name == "uncertainty" and np.any(column < 0):
                raise InputError(f"{name} of a table of shifts must be finite and not negative")
            more[name] = tuple(column.tolist())
        store(
            self,
            reference_temperature=_reference(self.reference_temperature),
            temperature=tuple(temperature.tolist()),
            values=tuple(values.tolist()),
            **more,
        )
        self._refuse_outside(np.asarray(self.reference_temperature))

    def __len__(self) -> int:
        return len(self.temperature)

    def log10_shift(self, temperature: npt.ArrayLike) -> float | Array:
        """Return log10 a_T at temperatures [K] inside the table, in the shape given."""
        asked = temperatures("temperature", temperature)
        self._refuse_outside(asked)
        return like_input(self._along(asked) - self._along(np.asarray(self.reference_temperature)))

    def deviation(self, temperature: float, other: float) -> float:
        """Return the standard deviation of log10 a_T between two temperatures [K] of the table.

        The errors of both rows are assumed independent, which is an upper estimate. Zero if
        unknown.
        """
        if temperature == other or not self.uncertainty:
            return 0.0
        there, here = np.interp([temperature, other], self.temperature, self.uncertainty)
        return math.hypot(there, here)

    def at_reference(self, temperature: float) -> "TabulatedShift":
        """Return the same table for another reference temperature [K] inside it."""
        return replace(self, reference_temperature=temperature)

    def _along(self, temperature: Array) -> Array:
        curve = scipy.interpolate.PchipInterpolator(self.temperature, self.values)
        inside = np.clip(temperature, self.temperature[0], self.temperature[-1])
        return curve(inside) + curve.derivative()(inside) * (temperature - inside)

    def _refuse_outside(self, temperature: Array) -> None:
        low, high = self.temperature[0], self.temperature[-1]
        outside = temperature[(temperature < low - BESIDE) | (temperature > high + BESIDE)]
        if outside.size:
            raise InputError(
                f"the table of shifts covers {_in_celsius(low)} to {_in_celsius(high)}, "
                f"got {_in_celsius(float(outside[0]))}; tables are not extrapolated; "
                "fit a WLF or Arrhenius law to it"
            )


Shift = WLF | Arrhenius | TabulatedShift
LAWS: Mapping[str, type[WLF] | type[Arrhenius]] = {kind.word: kind for kind in (WLF, Arrhenius)}


@dataclass(frozen=True)
class FittedShift:
    """A shift law fitted to a measured table, from :func:`viscotack.lab.fit_wlf` and others.

    Parameters
    ----------
    law : WLF or Arrhenius
        Law at its reference temperature.
    standard_error : tuple of float
        Standard errors of c1 [-] and c2 [K], or of the activation energy [J/mol].
    misfit : float
        Root mean square of log10 a_T of the table minus that of the law [decades].
    worst : (float, float)
        Temperature [K] and difference [decades] of the worst row; not stored in passports, and
        ignored in comparisons.
    """

    law: WLF | Arrhenius
    standard_error: tuple[float, ...]
    misfit: float
    worst: tuple[float, float] = field(default=(math.nan, math.nan), compare=False)

    def words(self) -> str:
        """Describe the law with its errors in words."""
        law, errors = self.law, self.standard_error
        if isinstance(law, WLF):
            constants = (
                f"WLF with c1 = {law.c1:.4g} +- {errors[0]:.2g}, c2 = {law.c2:.4g} +- "
                f"{errors[1]:.2g} K at {law.reference_temperature - 273.15:.4g} C"
            )
        else:
            energy = readable(law.activation_energy, "J/mol", uncertainty=errors[0])
            constants = f"Arrhenius with {energy}"
        return f"{constants}; {self.misfit:.2g} decades off the table on average"


def _reference(value: float) -> float:
    return float(temperatures("reference_temperature", value))


def _ask_about_celsius(kelvin: float) -> None:
    if kelvin < DOUBTFUL:
        warnings.warn(
            f"the reference temperature of {_in_celsius(kelvin)} is unusually low; "
            f"were {kelvin:g} C meant?",
            UserWarning,
            stacklevel=4,
        )


def _in_celsius(temperature: float) -> str:
    return f"{temperature:.6g} K ({temperature - 273.15:.4g} C)"
