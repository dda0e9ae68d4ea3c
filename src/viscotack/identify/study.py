"""A study in a file: what a lab measured, on what, and how its files are to be read.

As TOML, ``viscotack identify rates ... -o study.toml`` writes one::

    title = "lens on PDMS"
    files = ["lens_1_um_s.csv", "lens_30_um_s.csv"]    # beside the study
    material = "pdms-10-1"                             # or a passport beside the study
    radius = "5.19 mm"
    preload = "1.5 mN"
    temperature = "20 degC"
    work_of_adhesion = ["152 mJ/m2", "3 mJ/m2"]        # known from a slow test
    scatter = "3 %"                                    # of forces from test to test
    growth = true                                      # of the interface with the opening speed

    [read]            # as the flags of `viscotack test read`
    force_unit = "mN"

Names of files are relative to the folder of the study.
"""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.lab.tack import Survey, survey
from viscotack.materials import Passport
from viscotack.materials.library import passport_of
from viscotack.units import parse

from .pull_off import pull_offs
from .rate_series import RateSeriesFit, identify_rates

_UNITS = {"radius": "m", "preload": "N", "temperature": "K"}
_WORDS = ("title", "notes", "material")
_KEYS = (
    "files",
    "level",
    "scatter",
    "curves",
    "growth",
    "work_of_adhesion",
    "read",
    *_UNITS,
    *_WORDS,
)
# keys of [read]: of the reader, of the evaluation, with the unit of those that have one
_READING: dict[str, str | None] = {
    "format": None,
    "force_unit": None,
    "length_unit": None,
    "time_unit": None,
    "force_column": None,
    "position_column": None,
    "decimal": None,
    "nominal_speed": "m/s",
}
_EVALUATION: dict[str, str | None] = {
    "compliance": "m/N",
    "compliance_uncertainty": "m/N",
    "into": None,
    "compression": None,
    "retraction_only": None,
}


@dataclass(frozen=True, kw_only=True)
class Study:
    """Tests of one sphere on one material at several speeds.

    Parameters
    ----------
    files : tuple of Path
        What the rig wrote.
    material : str
        A published material, or the file of a passport.
    radius : float
        Of the sphere [m].
    preload : float, optional
        Under which contacts relaxed [N]; else the force where retractions begin.
    temperature : float, optional
        Of the tests [K]; else that of the passport.
    work_of_adhesion : (float, float), optional
        Known from a slow test, with its standard uncertainty [J/m2].
    curves : bool
        Take whole curves, not only pull-offs.
    growth : bool
        Look for an interface that grows with the opening speed.
    scatter : float
        Relative standard deviation from test to test, where the tests do not show it themselves.
    level : float
        Confidence level of all intervals and bands.
    reading, evaluation : mapping
        Keywords of :func:`viscotack.lab.tack.read` and :func:`viscotack.lab.tack.evaluate`.
    title, notes : str
        For the report.
    """

    files: tuple[Path, ...]
    material: str
    radius: float
    preload: float | None = None
    temperature: float | None = None
    work_of_adhesion: tuple[float, float] | None = None
    curves: bool = False
    growth: bool = False
    scatter: float = 0.0
    level: float = 0.9
    reading: Mapping[str, Any] = field(default_factory=dict)
    evaluation: Mapping[str, Any] = field(default_factory=dict)
    title: str = ""
    notes: str = ""

    def __post_init__(self):
        if not self.files:
            raise InputError("a study has files that a rig wrote; it names none")

    def passport(self) -> Passport:
        """Return the material at the temperature of the tests."""
        found = passport_of(self.material)
        return found if self.temperature is None else found.moved_to(self.temperature)


@dataclass(frozen=True, eq=False)
class Answer:
    """What the files of a study say, and the interface they tell of."""

    study: Study
    survey: Survey
    fit: RateSeriesFit


def answer(study: Study) -> Answer:
    """Return the interface of a study: files read, pull-offs averaged, rate series fitted.

    Raises
    ------
    OSError
        If a file cannot be opened.
    ValueError
        If no cycle can be trusted, or the series says nothing.
    """
    passport = study.passport()
    found = survey(study.files, reading=study.reading, evaluation=study.evaluation)
    if not found.cycles:
        reasons = "\n  ".join(f"{path}: {why}" for path, why in found.reasons)
        raise InputError(f"no cycle of a tack test could be read:\n  {reasons}")
    machine = [one.record.compliance for one in found.evaluations]
    compliance = study.evaluation.get("compliance") or max(machine)
    fit = identify_rates(
        pull_offs(found.cycles),
        material=passport,
        radius=study.radius,
        preload=study.preload,
        work_of_adhesion=study.work_of_adhesion,
        stiffness=1 / compliance if compliance > 0 else None,
        curves=study.curves,
        growth=study.growth,
        scatter=study.scatter,
        level=study.level,
    )
    return Answer(study, found, fit)


def read_study(path: str | os.PathLike[str]) -> Study:
    """Return the study in a TOML file; its files are beside it.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If a key is missing, unknown or impossible.
    """
    path = Path(path)
    table = read_toml(path)
    try:
        return _study(table, path.parent)
    except (ValueError, TypeError, AttributeError) as error:
        raise InputError(f"{path}: {error}") from None


def _study(table: Mapping[str, Any], folder: Path) -> Study:
    _known("a study", table, _KEYS)
    for key in ("files", "material", "radius"):
        if key not in table:
            raise InputError(f"{key} is missing; a study has files, material and radius")
    values: dict[str, Any] = {
        key: parse(table[key], unit) for key, unit in _UNITS.items() if key in table
    }
    values |= {key: str(table[key]) for key in _WORDS if key in table}
    beside = folder / values["material"]
    if beside.is_file():
        values["material"] = str(beside)
    values |= {key: parse(table[key], "1") for key in ("level", "scatter") if key in table}
    for key in ("curves", "growth"):
        if not isinstance(table.get(key, False), bool):
            raise InputError(f"{key} must be true or false, got {table[key]!r}")
        values[key] = table.get(key, False)
    if "work_of_adhesion" in table:
        value, uncertainty = table["work_of_adhesion"]
        values["work_of_adhesion"] = parse(value, "J/m^2"), parse(uncertainty, "J/m^2")
    how = table.get("read", {})
    _known("[read]", how, (*_READING, *_EVALUATION))
    return Study(
        files=tuple(folder / str(name) for name in table["files"]),
        reading=_taken(how, _READING),
        evaluation=_taken(how, _EVALUATION),
        **values,
    )


def _known(name: str, table: Mapping[str, Any], keys: tuple[str, ...]) -> None:
    unknown = sorted(table.keys() - set(keys))
    if unknown:
        raise InputError(f"{name} has no {unknown[0]!r}; there are {', '.join(keys)}")


def _taken(table: Mapping[str, Any], units: Mapping[str, str | None]) -> dict[str, Any]:
    return {
        key: table[key] if unit is None else parse(table[key], unit)
        for key, unit in units.items()
        if key in table
    }


def study_text(study: Study, folder: str | os.PathLike[str]) -> str:
    """Return the TOML of a study for a file in a folder, beside which its files are named."""
    values: dict[str, Any] = {"title": study.title, "notes": study.notes}
    values["files"] = [os.path.relpath(file, folder) for file in study.files]
    values["material"] = study.material
    if Path(study.material).is_file():
        values["material"] = os.path.relpath(study.material, folder)
    for key, unit in _UNITS.items():
        values[key] = _quantity(getattr(study, key), unit)
    if study.work_of_adhesion is not None:
        values["work_of_adhesion"] = [_quantity(x, "J/m^2") for x in study.work_of_adhesion]
    values |= {name: getattr(study, name) or None for name in ("curves", "growth", "scatter")}
    values["level"] = study.level
    how = {
        key: value if unit is None else _quantity(value, unit)
        for units, given in ((_READING, study.reading), (_EVALUATION, study.evaluation))
        for key, unit in units.items()
        if (value := given.get(key)) not in (None, False, 0)
    }
    lines = [f"{key} = {_toml(value)}" for key, value in values.items() if value not in (None, "")]
    if how:
        lines += ["", "[read]", *(f"{key} = {_toml(value)}" for key, value in how.items())]
    return "\n".join(lines) + "\n"


def _quantity(value: float | None, unit: str) -> str | None:
    return None if value is None else f"{float(value)!r} {unit}"


def _toml(value: Any) -> str:
    # strings, numbers, words for yes and no, and lists of strings are written as in JSON
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
