"""Material passport: a material with its origin, uncertainty and range of validity.

What is uncertain of it are solids sampled from it, and its times by a temperature.
"""

import math
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from math import inf, log
from statistics import NormalDist, fmean, pstdev
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.constants import temperatures
from viscotack.model.materials.conversion import PronyForm, prony_form, slowed
from viscotack.model.materials.material import word_of
from viscotack.model.materials.shift import BESIDE, FittedShift, Shift, TabulatedShift

# Beginning of the sentence of a fit on a liquid.
LIQUID = "this is a liquid"


@dataclass(frozen=True, kw_only=True)
class Origin:
    """Origin of a material.

    Attributes
    ----------
    reference : str
        Publication or laboratory, as text.
    doi : str
        DOI of the publication.
    file, sha256, format : str
        Name, hash and format of the fitted file.
    made_by : str
        Program and version that created the passport.
    notes : tuple of str
        Decisions between file and numbers.
    """

    reference: str = ""
    doi: str = ""
    file: str = ""
    sha256: str = ""
    format: str = ""
    made_by: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """Quality of a fit.

    Attributes
    ----------
    numbers, constants : int
        Number of measured values, and of fitted constants.
    scatter : float or None
        Standard deviation of ln(measured/fitted); None if unknown.
    level : float
        Confidence level of the intervals.
    intervals : tuple of (str, float, float)
        Name, lower and upper end [SI] of each interval; 0 and inf where there is no bound.
    undetermined, cautions : tuple of str
        Sentences on undetermined constants, and on the quality of the fit.
    """

    numbers: int
    constants: int
    level: float
    scatter: float | None = None
    intervals: tuple[tuple[str, float, float], ...] = ()
    undetermined: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Passport:
    """A material with its temperature shift, origin and uncertainty.

    Parameters
    ----------
    name : str
        Name of the material.
    material : Elastic, StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        Tensile solid at `temperature`, with a constant Poisson ratio.
    temperature : float or None
        Temperature of `material` [K].
    shift : WLF, Arrhenius, TabulatedShift or None
        Temperature dependence of its times.
    fitted_shift : FittedShift or None
        Law fitted to a measured table of shifts.
    temperatures : (float, float) or None
        Lowest and highest measured temperature [K].
    frequencies : (float, float) or None
        Lowest and highest measured angular frequency [rad/s], reduced to `temperature`.
    measured : str or None
        Measured kind of modulus, "E" or "G"; None if unknown.
    origin : Origin
        Origin of the material.
    evidence : Evidence or None
        Quality of the fit.
    allowed : tuple of Material
        Solids sampled from the uncertainty of the measurement at the same temperature, to propagate
        the joint uncertainty of all constants to predictions.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.materials.shift import WLF
    >>> rubber = Passport(
    ...     name="rubber",
    ...     material=StandardSolid(
    ...         rubbery_modulus=1e6, glassy_modulus=1e9, tau0=0.1, poisson_ratio=0.5
    ...     ),
    ...     temperature=293.15,
    ...     shift=WLF(reference_temperature=293.15, c1=8.0, c2=100.0),
    ... )
    >>> f"{rubber.at_temperature(273.15).tau0:.3g} s"
    '10 s'
    """

    name: str
    material: Any
    temperature: float | None = None
    shift: Shift | None = None
    fitted_shift: FittedShift | None = None
    temperatures: tuple[float, float] | None = None
    frequencies: tuple[float, float] | None = None
    measured: str | None = None
    origin: Origin = Origin()
    evidence: Evidence | None = None
    allowed: tuple[Any, ...] = ()

    def __post_init__(self):
        if not hasattr(self.material, "retardation_modes"):
            raise InputError(
                f"material must be a solid of viscotack, got {type(self.material).__name__}"
            )
        if self.shift is not None and self.temperature is None:
            raise InputError("a shift needs the temperature [K] of the material")
        if self.measured not in ("E", "G", None):
            raise InputError(f"measured must be 'E', 'G' or None, got {self.measured!r}")
        for name in ("temperature", "temperatures"):
            if (value := getattr(self, name)) is not None:
                temperatures(name, value)
        for name in ("temperatures", "frequencies"):
            pair = getattr(self, name)
            if pair is not None and not 0 < pair[0] <= pair[1]:
                raise InputError(f"{name} must be positive and ascend, got {pair}")

    @property
    def liquid(self) -> str:
        """The sentence of the fit on a liquid, whose rubbery modulus is no property; else empty."""
        said = () if self.evidence is None else self.evidence.undetermined
        return next((text for text in said if text.startswith(LIQUID)), "")

    @classmethod
    def of(cls, solid: Any) -> "Passport":
        """Return a passport as it is, and a bare material as a passport that knows nothing more."""
        return solid if isinstance(solid, Passport) else cls(name="", material=solid)

    def refuse_liquid(self, what: str) -> None:
        """Raise an error if the material is a liquid; `what` cannot be done with one."""
        if self.liquid:
            raise InputError(
                f"{self.name or 'the material'} has no rubbery plateau ({self.liquid.split('.')[0]}"
                f"): {what}. If it is a solid, measure at lower frequencies or state "
                "`rubbery_modulus` in `viscotack material fit`"
            )

    def shift_factor(self, temperature: float) -> float:
        """Return a_T, the factor on the times of the material at another temperature [K].

        Raises
        ------
        ValueError
            Without a shift law, or outside the measured temperatures or the law's range.
        """
        if temperature == self.temperature:
            return 1.0
        if self.shift is None or self.temperature is None:
            known = "" if self.temperature is None else f" from {_both(self.temperature)}"
            raise InputError(
                f"{self.name}: the temperature dependence of its times is unknown{known}"
            )
        if self.temperatures is not None:
            low, high = self.temperatures
            if not low - BESIDE <= temperature <= high + BESIDE:
                raise InputError(
                    f"{self.name} was measured from {_both(low)} to {_both(high)}, got "
                    f"{_both(temperature)}; superposition is not extrapolated"
                )
        law = self.shift
        decades = float(law.log10_shift(temperature)) - float(law.log10_shift(self.temperature))
        return 10.0**decades

    def shift_deviation(self, temperature: float) -> float:
        """Return the standard deviation of log10 a_T at a temperature [K]; 0 if unknown."""
        if self.temperature is None or not isinstance(self.shift, TabulatedShift):
            return 0.0
        return self.shift.deviation(temperature, self.temperature)

    def at_temperature(self, temperature: float) -> Any:
        """Return the material at another temperature [K], with its times multiplied by a_T.

        Moduli are unchanged: the small temperature dependence of the rubbery modulus is neglected.

        Raises
        ------
        ValueError
            As :meth:`shift_factor`.
        """
        return slowed(self.material, self.shift_factor(temperature))

    def moved_to(self, temperature: float) -> "Passport":
        """Return the passport of the same material at another temperature [K]."""
        a = self.shift_factor(temperature)
        frequencies = self.frequencies and (self.frequencies[0] / a, self.frequencies[1] / a)
        deviation = self.shift_deviation(temperature)
        note = f"moved from {_both(self.temperature)} to {_both(temperature)}, a_T = {a:.6g}"
        if deviation > 0:
            note += f", standard deviation of log10 a_T {deviation:.2g}"
        if self.temperature is None or temperature == self.temperature:
            return self
        evidence = self.evidence
        if evidence is not None:
            # combine two independent errors of ln tau0; the second is that of the shift
            wider = NormalDist().inv_cdf((1 + evidence.level) / 2) * deviation * math.log(10)
            moved = tuple(
                _moved(interval, getattr(self.material, "tau0", math.nan), a, wider)
                for interval in evidence.intervals
            )
            evidence = replace(evidence, intervals=moved)
        return replace(
            self,
            material=slowed(self.material, a),
            temperature=float(temperature),
            frequencies=frequencies,
            origin=replace(self.origin, notes=(*self.origin.notes, note)),
            evidence=evidence,
            allowed=tuple(
                slowed(solid, a * 10 ** (deviation * z))
                for solid, z in zip(self.allowed, _scattered(len(self.allowed)), strict=True)
            ),
        )

    def as_prony(
        self, frequencies: tuple[float, float] | None = None, tolerance: float = 3e-4
    ) -> tuple["Passport", PronyForm]:
        """Return the passport of a Prony series of the material, and the series with its error.

        Parameters
        ----------
        frequencies : (float, float), optional
            Range of the series [rad/s]; by default the measured range.
        tolerance : float
            As for :func:`.prony_form`.

        Raises
        ------
        InputError
            If the range is unknown; as :func:`.prony_form`.
        """
        bounds, solid = frequencies or self.frequencies, self.material
        if bounds is None and word_of(solid) in ("prony", "sls"):
            bounds = 1e-3 / solid.time_unit, 1e3 / solid.time_unit
        if bounds is None:
            raise InputError(
                f"frequencies: {self.name} does not say where it was measured; say where the "
                'series must hold, "1 mHz,1 MHz"',
                field="frequencies",
            )
        form = prony_form(solid, frequencies=bounds, tolerance=tolerance)
        note = f"Prony series of the {word_of(solid)}, error {form.error:.1e}"
        origin = replace(self.origin, notes=(*self.origin.notes, note))
        how = {"material": form.material, "frequencies": form.frequencies, "origin": origin}
        return replace(self, **how), form


def _scattered(count: int) -> list[float]:
    """Return deterministic numbers of mean 0 and deviation 1, evenly spread and unordered."""
    # golden-section steps cover the unit interval evenly
    drawn = [NormalDist().inv_cdf((0.5 + 0.6180339887 * i) % 1.0) for i in range(count)]
    if count < 2:
        return [0.0] * count
    return [(x - fmean(drawn)) / pstdev(drawn) for x in drawn]


def _moved(
    interval: tuple[str, float, float], tau0: float, factor: float, wider: float
) -> tuple[str, float, float]:
    """Move an interval to another temperature; `wider` is the half-width of ln(factor)."""
    name, low, high = interval
    if name != "tau0":
        return interval
    # an open end stays open
    down = math.hypot(math.log(tau0 / low), wider) if low > 0 else math.inf
    up = math.hypot(math.log(high / tau0), wider)
    return name, tau0 * factor * math.exp(-down), tau0 * factor * math.exp(up)


def _both(temperature: float | None) -> str:
    return "" if temperature is None else f"{temperature - 273.15:.4g} C ({temperature:.5g} K)"


# Number of solids sampled from the intervals of a passport without sampled solids.
_DRAWN = 24


def allowed(passport: Passport) -> tuple[Any, ...]:
    """Return solids sampled from the uncertainty of a passport's material.

    These are the solids stored in the passport. For a passport without them, each constant is
    sampled independently from its interval, which overestimates the uncertainty. Empty if unknown.
    """
    if passport.allowed or passport.evidence is None:
        return passport.allowed
    known = {field.name for field in fields(passport.material)}
    quantile = NormalDist().inv_cdf((1 + passport.evidence.level) / 2)
    widths = {}
    for name, low, high in passport.evidence.intervals:
        if name in known:
            value = getattr(passport.material, name)
            # half-widths of the interval of ln(value), of its bounded sides
            sides = [log(value / low)] if low > 0 else []
            sides += [log(high / value)] if high < inf else []
            if sides and np.mean(sides) > 0:
                widths[name] = float(np.mean(sides)) / quantile
    if not widths:
        return ()
    rng = np.random.default_rng(20)
    solids = []
    while len(solids) < _DRAWN:
        drawn = {
            name: getattr(passport.material, name) * float(np.exp(width * rng.standard_normal()))
            for name, width in widths.items()
        }
        try:
            solids.append(replace(passport.material, **drawn))
        except InputError:  # glassy softer than rubbery modulus, or an exponent out of range
            continue
    return tuple(solids)


def known_of(
    passport: Passport, temperature_uncertainty: float | None = None
) -> tuple[tuple[Any, ...], dict[str, float]]:
    """Return sampled solids, and the deviation of ln of the times by the temperature [K].

    Raises
    ------
    InputError
        If the passport knows neither, or no shift for the uncertainty of a temperature.
    """
    solids, times = allowed(passport), dict[str, float]()
    if temperature_uncertainty is not None:
        times["temperature"] = shift_error(passport, temperature_uncertainty)
        if not times["temperature"]:
            raise InputError(
                f"{passport.name}: the temperature dependence of its times is unknown; omit "
                "`temperature_uncertainty`"
            )
    if not solids and not times:
        raise InputError(
            f"{passport.name}: the uncertainty of this material is unknown (no sampled solids "
            "and no intervals); omit passport, or state scatter of its constants"
        )
    return solids, times


def shift_error(passport: Passport, uncertainty: float, temperature: float | None = None) -> float:
    """Return the relative standard error of the times of a solid by its temperature.

    Parameters
    ----------
    passport : Passport
        Solid with its shift law.
    uncertainty : float
        Standard uncertainty of the temperature of the tests [K].
    temperature : float, optional
        This temperature [K]; by default that of the passport.

    Returns
    -------
    float
        In ln of the times; 0 without a shift law.
    """
    law, middle = passport.shift, passport.temperature if temperature is None else temperature
    if law is None or middle is None or not uncertainty:
        return 0.0
    found = {middle: float(law.log10_shift(middle))}
    for beside in (middle - uncertainty, middle + uncertainty):
        # a table may end here, or a law have its pole
        with suppress(InputError):
            found[beside] = float(law.log10_shift(beside))
    span = max(found) - min(found)
    decades = found[min(found)] - found[max(found)]
    return abs(decades) / span * uncertainty * log(10.0) if span else 0.0
