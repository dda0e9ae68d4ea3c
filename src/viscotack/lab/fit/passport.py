"""Issue a material passport from a fit."""

from viscotack.errors import InputError
from viscotack.lab.sweeps import ShiftTable
from viscotack.model.materials.passport import Evidence, Origin, Passport
from viscotack.model.materials.shift import Shift

from .report import FitReport
from .shift_laws import nearest_law

_ALLOWED = 24  # largest number of sampled solids in a passport


def issued(
    report: FitReport,
    *,
    name: str,
    shift: Shift | ShiftTable | None = None,
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
    shift : WLF, Arrhenius, TabulatedShift, ShiftTable or None
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
    if isinstance(shift, ShiftTable):
        zero, rows = seen.temperature, len(shift)
        if zero is None and rows > 1:
            raise InputError("a table of shifts needs the temperature of the master curve [K]")
        if zero is not None and rows > 2:
            fitted = nearest_law(shift, reference_temperature=zero)
        # a table of one row contains no shift
        shift = shift.at_reference(zero) if zero is not None and rows > 1 else None
    elif shift is not None and seen.temperature is not None:
        shift = shift.at_reference(seen.temperature)
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
            scatter=report.scatter.deviation,
            level=report.level,
            intervals=tuple((i.name, i.low, i.high) for i in report.intervals if i.told),
            undetermined=report.undetermined,
            cautions=report.cautions,
        ),
        # evenly, at most _ALLOWED
        allowed=report.draws[:: max(len(report.draws) // _ALLOWED, 1)][:_ALLOWED],
    )
