"""What files of a laboratory say: materials from DMA, pull-offs from a rig, the interface of both.

The files have been sent; they lie in a folder of their own, and whatever says their path is told
without it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.app.cli.superposing import Shifting, stepped, swept
from viscotack.app.records import rates_record, slow_record, tests_record
from viscotack.errors import InputError
from viscotack.files.toml import parse_toml
from viscotack.identify import fitted_force, identify_rates, identify_slow, pull_offs, slow_test
from viscotack.lab import FrequencySweeps, allow_for_shifts, fit, issued, read
from viscotack.lab.fit_report import FitReport
from viscotack.lab.tack import Survey, survey
from viscotack.materials.library import MATERIALS, published
from viscotack.materials.passport_tables import passport_text
from viscotack.materials.shift import TabulatedShift
from viscotack.units import parse
from viscotack.version import __version__

from .asks import Asked, Tell, material_table, problem_of
from .examples import FIRST
from .plain import drawn, plain

# Points of a fitted curve, of a measured one, and how far it is drawn beyond [decades].
_CURVE, _MOST, _BEYOND = 120, 1500, 0.5
# Of the reader of DMA files and of that of tack files: what a file may not say itself.
DMA_READING = ("format", "kind", "frequency_unit", "modulus_unit", "time_unit", "temperature_unit")
TACK_READING = ("format", "force_unit", "length_unit", "time_unit", "force_column")


def fit_material(asked: Asked, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Fit a material to DMA, relaxation or creep files; with what is drawn of it."""
    files, options = _files(asked), asked["options"]
    given = {name: options.get(name) for name in DMA_READING}
    measured = read(files, temperature=_kelvin(options.get("temperature")), **given)
    shifting = Shifting(
        reference=_kelvin(options.get("reference_temperature")),
        glass_transition=options.get("glass_transition"),
        wlf=options.get("wlf"),
        shift_file=None,
        by=None,
        vertical=None,
        leave_out=(),
    )
    is_sweep = isinstance(measured, FrequencySweeps)
    data, shift, cautions = (swept if is_sweep else stepped)(measured, shifting)
    report = fit(
        data,
        poisson_ratio=parse(options.get("poisson_ratio", 0.5), "1"),
        model=options.get("model", "best"),
    )
    report = allow_for_shifts(report, data, shift)
    report = replace(report, cautions=(*cautions, *report.cautions))
    passport = issued(
        report,
        name=options.get("name") or files[0].stem,
        shift=shift,
        reference="",
        made_by=f"viscotack {__version__}",
    )
    names = ", ".join(file.name for file in files)
    passport = replace(passport, origin=replace(passport.origin, file=names))
    return {
        "table": material_table(report.material),
        "model": report.model,
        "words": report.words(),
        "notes": list(report.observed.source.notes),
        "passport": passport_text(passport),
        "fit": _fit(report),
        "shifts": _shifts(passport.shift),
    }


def read_tests(asked: Asked, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Read tack tests: a row for each cycle, its retraction, and what was refused."""
    found = _survey(asked)
    return plain(tests_record(found)) | {
        "curves": [_retraction(cycle) for cycle in found.cycles],
        "refused": [{"file": path, "reason": why} for path, why in found.reasons],
    }


def identify_slow_test(asked: Asked, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Find work of adhesion and Tabor number from one slow retraction of a sphere."""
    found, options = _survey(asked), asked["options"]
    number = int(parse(options.get("cycle", 1), "1"))
    if not 1 <= number <= len(found.cycles):
        raise InputError(f"cycle must be 1 to {len(found.cycles)}, got {number}")
    test = slow_test(found.cycles[number - 1], parse(_needed(options, "radius", "5 mm"), "m"))
    answer = identify_slow(test, contact_modulus=_pair(options, "contact_modulus", "Pa"))
    return plain(slow_record(answer)) | {
        "measured": {"at": drawn(test.at), "force": drawn(test.force)},
        "fitted": {"at": drawn(test.at), "force": drawn(fitted_force(answer.best, test))},
    }


def identify_rate_series(asked: Asked, tell: Tell, also: tuple[Any, ...]) -> dict[str, Any]:
    """Find work of adhesion and range from pull-offs at several speeds, with a known material."""
    found, options = _survey(asked), asked["options"]
    preload, machine = options.get("preload"), options.get("compliance")
    yields = 0.0 if machine is None else parse(machine, "m/N")
    answer = identify_rates(
        pull_offs(found.cycles),
        material=_solid(asked["material"], also),
        radius=parse(_needed(options, "radius", "5 mm"), "m"),
        preload=None if preload is None else parse(preload, "N"),
        work_of_adhesion=_pair(options, "work_of_adhesion", "J/m^2"),
        stiffness=1 / yields if yields > 0 else None,
    )
    return plain(rates_record(answer))


def _solid(words: str, also: tuple[Any, ...]) -> Any:
    """Return the passport of a published name, or the solid of the text of a table [material]."""
    if words in MATERIALS:
        return published(words)
    table = parse_toml(words, "the material").get("material")
    if not isinstance(table, dict):
        raise InputError(
            "material must be the TOML text of a table [material] or the name of a published "
            f"material, {', '.join(MATERIALS)}; got {words!r:.60}"
        )
    # by way of a case that has it: what a table may say is known in one place
    return problem_of(FIRST | {"material": table}, also).material


def _files(asked: Asked) -> list[Path]:
    return [Path(file) for file in asked["files"]]


def _survey(asked: Asked) -> Survey:
    """Return what the files of a rig say; refused where none of their cycles says anything."""
    options = asked["options"]
    reading = {name: options.get(name) for name in TACK_READING}
    speed, compliance = options.get("nominal_speed"), options.get("compliance")
    reading["nominal_speed"] = None if speed is None else parse(speed, "m/s")
    evaluation = {
        "compliance": None if compliance is None else parse(compliance, "m/N"),
        "retraction_only": str(options.get("retraction_only", "")).lower() in ("true", "1", "yes"),
    }
    found = survey(_files(asked), reading=reading, evaluation=evaluation)
    if not found.cycles:
        reasons = "; ".join(f"{Path(path).name}: {why}" for path, why in found.reasons)
        raise InputError(f"no cycle of a tack test could be read: {reasons}")
    return found


def _retraction(cycle: Any) -> dict[str, Any]:
    """Return the retraction of a cycle as it is drawn."""
    back = cycle.retraction
    every = max((back.stop - back.start) // _MOST, 1)
    return {
        "file": Path(cycle.source.path).name,
        "cycle": cycle.number,
        "depth": drawn(cycle.depth[back][::every]),
        "force": drawn(cycle.force[back][::every]),
        "pull_off_force": cycle.pull_off_force.value,
        "pull_off_force_uncertainty": cycle.pull_off_force.uncertainty,
        "pull_off_depth": cycle.pull_off_depth.value,
        "speed": cycle.speed.value,
        "speed_uncertainty": cycle.speed.uncertainty,
        "preload": cycle.preload.value,
    }


def _fit(report: FitReport) -> dict[str, Any]:
    """Return measured points, fitted curves with their band, and residuals."""
    data = report.observed
    unit = 1 / (2 * np.pi) if data.in_frequency else 1.0
    ends = np.log10(data.at[0]) - _BEYOND, np.log10(data.at[-1]) + _BEYOND
    at = np.logspace(*ends, _CURVE)
    curves = data.predicted(report.material, at)
    low, high = report.band(at) if report.draws else (curves, curves)
    percent = 100 * np.expm1(report.residuals)
    return {
        "x": "frequency" if data.in_frequency else "time",
        "x_unit": "Hz" if data.in_frequency else "s",
        "unit": "1/Pa" if data.quantity == "creep" else "Pa",
        "level": report.level,
        "measured_from": float(data.at[0] * unit),
        "measured_to": float(data.at[-1] * unit),
        "at": drawn(data.at * unit),
        "curve_at": drawn(at * unit),
        "parts": [
            {
                "name": part,
                "measured": drawn(data.values[i]),
                "fitted": drawn(curves[i]),
                "low": drawn(low[i]),
                "high": drawn(high[i]),
                "residual": drawn(percent[i]),
            }
            for i, part in enumerate(data.parts)
        ],
    }


def _shifts(shift: Any) -> dict[str, Any] | None:
    """Return the table of shifts that was found or given, None where a law was."""
    if not isinstance(shift, TabulatedShift):
        return None
    rows = np.array(shift.temperature)
    return {
        "temperature": drawn(rows - 273.15),
        "log10_shift": drawn(shift.log10_shift(rows)),
        "deviation": drawn(shift.uncertainty) if shift.uncertainty else None,
    }


def _kelvin(text: str | None) -> float | None:
    return None if text is None else parse(text, "K")


def _needed(options: Mapping[str, Any], name: str, example: str) -> str:
    if options.get(name) is None:
        raise InputError(f'{name} is missing; give for example {name} = "{example}"')
    return options[name]


def _pair(options: Mapping[str, Any], name: str, unit: str) -> tuple[float, float] | None:
    """Return a number known from elsewhere and its uncertainty."""
    words: Sequence[Any] = [options.get(name), options.get(f"{name}_uncertainty")]
    if (words[0] is None) != (words[1] is None):
        raise InputError(f"{name} and {name}_uncertainty go together; give both or neither")
    if words[0] is None:
        return None
    return parse(words[0], unit), parse(words[1], unit)
