"""From a fit to a passport: the material with what is known of it."""

from typing import Any

from viscotack.errors import InputError
from viscotack.materials.passport import Evidence, Origin, Passport
from viscotack.materials.shift import Shift

from .fit_report import FitReport
from .shift_laws import nearest_law
from .sweeps import ShiftTable

_ALLOWED = 24  # solids that a passport keeps


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
        What the material is called.
    shift : WLF, Arrhenius, TabulatedShift, ShiftTable or None
        How its times change with temperature; a table is interpolated, never extrapolated.
    reference : str
        Who measured it, in words.
    made_by : str
        Program and version.

    Raises
    ------
    ValueError
        If a shift is given and the measurement does not say its temperature.
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
        # one row shifts nothing
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
        allowed=_thinned(report.draws),
    )


def _thinned(draws: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return as many of the solids drawn as a file needs to say how they scatter."""
    return draws[:: max(len(draws) // _ALLOWED, 1)][:_ALLOWED]
