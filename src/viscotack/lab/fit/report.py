"""Report of a fit: constants, intervals, scatter and cautions; the passport issued from it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.passport import Evidence, Origin, Passport
from viscotack.model.materials.shift import Shift, TabulatedShift

from .observed import Observed
from .shift_factors import nearest_law

# Difference of the criterion within which the data do not distinguish two models.
ALIKE = 2.0
_UNITS = {"rubbery_modulus": "Pa", "glassy_modulus": "Pa", "tau0": "s"}


@dataclass(frozen=True)
class Interval:
    """A fitted quantity and its confidence interval.

    Attributes
    ----------
    name : str
        Name of the quantity, as in the material.
    value : float
        Fitted value, in SI.
    low, high : float
        Ends of the interval, in SI; 0 and inf where the data give no bound on that side. Both equal
        the value if it was given instead of fitted, and are nan if no interval was
        computed.
    known : bool
        Whether the quantity was given, not fitted.
    """

    name: str
    value: float
    low: float
    high: float
    known: bool = False

    @property
    def unit(self) -> str:
        """SI unit, "1" for a pure number."""
        return _UNITS.get(self.name, "1")

    @property
    def told(self) -> bool:
        """Whether an interval was computed."""
        return not (np.isnan(self.low) or np.isnan(self.high))

    @property
    def bounded(self) -> bool:
        """Whether the data give a lower and an upper bound."""
        return self.low > 0 and bool(np.isfinite(self.high))

    def words(self) -> str:
        """Format value, interval and unit as a line of text."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        line = f"{self.name:<16} {self.value:>11.5g}{unit}"
        if self.known:
            return f"{line}  given"
        if not self.told:
            return f"{line}  (no interval, because draws=0)"
        if self.bounded:
            return f"{line}  ({self.low:.5g} to {self.high:.5g})"
        if self.low > 0:
            return f"{line}  (at least {self.low:.4g}; no upper bound)"
        if np.isfinite(self.high):
            return f"{line}  (at most {self.high:.4g}; no lower bound)"
        return f"{line}  (not bounded)"


def rated(
    data: Observed, model: str, material: Any, constants: int, *, chosen: int = 0, **more: Any
) -> "FitReport":
    """Return a fitted solid with its scatter and criterion.

    `chosen` counts constants of the criterion only, `more` are other fields of the fit.
    """
    residuals = data.weighed(data.residuals(material))
    return FitReport(
        observed=data,
        model=model,
        material=material,
        scatter=float(np.sqrt(np.sum(residuals**2) / max(residuals.size - constants, 1))),
        constants=constants,
        criterion=information_criterion(residuals, constants + chosen),
        **more,
    )


def information_criterion(residuals: Array, constants: int, *, floor: float = 0.0) -> float:
    """Return the corrected Akaike information criterion; infinite with too few numbers.

    -2 ln(likelihood) + 2 K + 2 K (K + 1)/(M - K - 1) with M numbers and K constants, including the
    scatter. Smaller is better; a difference of 10 is decisive. The scatter is at least `floor`, in
    the unit of the residuals.
    """
    M, K = residuals.size, constants + 1
    if M - K - 1 <= 0:
        return float("inf")
    return float(
        M * np.log(np.mean(residuals**2) + floor**2 + 1e-30) + 2 * K + 2 * K * (K + 1) / (M - K - 1)
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class FitReport:
    """A material fitted to a measurement, returned by :func:`viscotack.lab.fit`.

    Attributes
    ----------
    observed : Observed
        Fitted numbers.
    model : str
        "power-law", "relaxation-power-law", "sls", "fractional-zener" or "prony".
    material : Material
        The fitted solid, tensile.
    scatter : float
        Standard deviation of ln(measured/fitted), corrected for the number of constants.
    constants : int
        Number of fitted constants.
    criterion : float
        Corrected Akaike information criterion; inf with too few numbers.
    level : float
        Confidence level of the intervals and of `band`.
    intervals : tuple of Interval
        Intervals of the constants, or of the two plateaus of a Prony series (nan if draws=0).
    draws : tuple of Material
        Solids sampled from the uncertainty of the fit, for bands and to propagate the uncertainty
        to predictions.
    compared : tuple of (str, float)
        Alternatives that were fitted, with the criterion of each.
    grid : int
        For a Prony series, the number of relaxation times tried.
    shared : str
        Correlation of the errors in words; empty for independent errors or if not computed.
    undetermined : tuple of str
        Sentences on constants and ranges that the measurement does not determine.
    cautions : tuple of str
        Sentences on the quality of the fit.
    """

    observed: Observed
    model: str
    material: Any
    scatter: float
    constants: int
    criterion: float
    level: float = 0.9
    intervals: tuple[Interval, ...] = ()
    draws: tuple[Any, ...] = ()
    compared: tuple[tuple[str, float], ...] = ()
    grid: int = 0
    shared: str = ""
    undetermined: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()

    @property
    def residuals(self) -> Array:
        """ln(measured/fitted), shape (P, N), one row per part of the quantity."""
        return self.observed.residuals(self.material)

    @property
    def median_error(self) -> float:
        """Median relative deviation of the fit from the data, over all numbers."""
        return float(np.median(np.abs(np.expm1(-self.residuals))))

    def band(self, at: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the pointwise confidence band of the fitted quantity.

        Parameters
        ----------
        at : array_like, shape (n,)
            Angular frequencies [rad/s], or times [s], as in the measurement.

        Returns
        -------
        low, high : ndarray, shape (P, n)
            Limits at the level of the report, [Pa] or [1/Pa]. Outside the measured range they
            show only the extrapolation of the model.
        """
        if not self.draws:
            raise InputError("a band needs sampled solids; fit with draws=100, not draws=0")
        curves = np.array([self.observed.predicted(solid, at) for solid in self.draws])
        part = (1 - self.level) / 2
        return np.quantile(curves, part, axis=0), np.quantile(curves, 1 - part, axis=0)

    def interval(self, name: str) -> Interval:
        """Return the interval of a quantity by its name."""
        for found in self.intervals:
            if found.name == name:
                return found
        raise InputError(f"no interval {name!r}; available: {[i.name for i in self.intervals]}")

    def words(self) -> str:
        """Format the report as lines of text."""
        scatters = np.sqrt(np.mean(self.residuals**2, axis=1))
        pairs = zip(self.observed.parts, scatters, strict=True)
        parts = ", ".join(f"{100 * value:.2g} % ({part})" for part, value in pairs)
        low, high = self.observed.at[0], self.observed.at[-1]
        over = f"{self.observed.quantity} from {low:.3g} to {high:.3g} s"
        if self.observed.in_frequency:
            over = f"{low / (2 * np.pi):.3g} to {high / (2 * np.pi):.3g} Hz"
        each = dict(self.compared)
        least = min(each.values(), default=0.0)
        alike = [x for x in each if self.model in each and each[x] <= least + ALIKE]
        model = " or ".join([self.model, *(x for x in alike if x != self.model)])
        model += ", undetermined" * (len(alike) > 1)
        lines = [
            f"{model}: {self.constants} constants on {self.observed.values.size} numbers, {over}",
            f"  {100 * self.level:.0f} % intervals:",
            *(f"  {interval.words()}" for interval in self.intervals),
            f"  scatter {parts}, median error {100 * self.median_error:.2g} %",
        ]
        if len(self.compared) > 1:
            tried = ", ".join(f"{name} {value - least:+.1f}" for name, value in each.items())
            lines.append(f"  criterion (AICc, above the best): {tried}")
        lines += [f"  Not determined: {sentence}" for sentence in self.undetermined]
        lines += [f"  Note: {sentence}" for sentence in self.cautions]
        return "\n".join(lines)


_ALLOWED = 24  # largest number of sampled solids in a passport


def issued(
    report: FitReport,
    *,
    name: str,
    shift: Shift | None = None,
    reference: str = "",
    made_by: str = "",
) -> Passport:
    """Return the passport of a fitted material.

    Parameters
    ----------
    report : FitReport
        The fit.
    name : str
        Name of the material.
    shift : WLF, Arrhenius, TabulatedShift or None
        Temperature dependence of its times; a table is interpolated, never extrapolated.
    reference : str
        Origin of the measurement, as text.
    made_by : str
        Program and version.

    Returns
    -------
    Passport
        The fitted material with its intervals and sampled solids.

    Raises
    ------
    ValueError
        If a shift is given but the temperature of the measurement is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> from viscotack.lab import MasterCurve, fit
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5)
    >>> omega = np.geomspace(0.1, 1e4, 16)
    >>> modulus = solid.complex_modulus(omega)
    >>> curve = MasterCurve(293.15, omega, modulus.real, modulus.imag, "E")
    >>> passport = issued(fit(curve, poisson_ratio=0.5, model="sls"), name="rubber")
    >>> passport.name, passport.temperature
    ('rubber', 293.15)
    """
    seen = report.observed
    source = seen.source
    fitted = None
    if shift is not None and seen.temperature is not None:
        shift = shift.at_reference(seen.temperature)
        if isinstance(shift, TabulatedShift) and len(shift) > 2:
            fitted = nearest_law(shift, reference_temperature=seen.temperature)
    return Passport(
        name=name,
        material=report.material,
        temperature=seen.temperature,
        shift=shift,
        fitted_shift=fitted,
        temperatures=seen.temperatures,
        frequencies=seen.frequencies,
        measured=seen.kind,
        origin=Origin(
            reference=reference,
            file=source.path,
            sha256=source.sha256,
            format=source.format,
            made_by=made_by,
            notes=source.notes,
        ),
        evidence=Evidence(
            numbers=int(seen.values.size),
            constants=report.constants,
            scatter=report.scatter,
            level=report.level,
            intervals=tuple((i.name, i.low, i.high) for i in report.intervals if i.told),
            undetermined=report.undetermined,
            cautions=report.cautions,
        ),
        # evenly, at most _ALLOWED
        allowed=report.draws[:: max(len(report.draws) // _ALLOWED, 1)][:_ALLOWED],
    )
