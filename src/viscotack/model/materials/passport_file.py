"""Read and write passports as TOML files, without loss of digits.

Quantities are text with units, so that TOML readers of other programs need no other information.
"""

import os
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from viscotack.cards import with_units
from viscotack.errors import InputError
from viscotack.files.toml import read_toml, toml_value
from viscotack.files.whole import Target, write_whole
from viscotack.model.materials.material import Material
from viscotack.model.materials.passport import Evidence, Origin, Passport
from viscotack.model.materials.shift import LAWS, FittedShift, Shift, TabulatedShift
from viscotack.model.materials.words import MODELS, word_of
from viscotack.model.tables import OWN, Reading, read_as
from viscotack.units import parse

VERSION = 1
_TABLES = (
    "material", "convention", "temperature", "nearest_law", "range", "origin", "evidence",
    "allowed",
)  # fmt: skip
# What tau0 and other times of a model are.
_TIMES = {
    "elastic": "none",
    "sls": "tau0 is the retardation time",
    "prony": "branches have relaxation times",
    "power-law": "tau0 is the characteristic retardation time",
    "relaxation-power-law": "tau0 is the characteristic relaxation time",
    "fractional-zener": "tau0 is the retardation time",
}
_NOT_STATED = "not stated"


def write_passport(passport: Passport, path: Target) -> None:
    """Write a passport to a TOML file; :func:`read_passport` restores an equal one.

    For a user-defined material, its word and numbers are written, but not its code.

    Parameters
    ----------
    passport : Passport
        Passport to write.
    path : path or binary file
        Output file.

    Raises
    ------
    NotWritten
        If the file cannot be written; an existing file is then unchanged.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from viscotack.model.materials.library import published
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "pdms.toml")
    ...     write_passport(published("pdms-10-1"), file)
    ...     read_passport(file) == published("pdms-10-1")
    True
    """
    write_whole(path, passport_text(passport).encode())


def passport_text(passport: Passport) -> str:
    """Format a passport as the text of its file."""
    lines = [
        "# A material and its papers, written by viscotack. Moduli are Young's moduli.",
        f"passport = {VERSION}",
        f"name = {toml_value(passport.name)}",
    ]
    for name, table in _tables(passport):
        if table:
            lines += ["", name, *(f"{key} = {toml_value(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _tables(passport: Passport) -> list[tuple[str, Mapping[str, Any]]]:
    """Return the headings of the file with their tables."""
    solid = _solid(passport.material)
    convention = {
        "modulus": "E",
        "measured": passport.measured or _NOT_STATED,
        "times": _TIMES.get(solid["model"], "as the class of the model defines them"),
    }
    temperature: dict[str, Any] = {}
    if passport.temperature is not None:
        temperature["reference"] = f"{passport.temperature!r} K"
    if passport.temperatures is not None:
        temperature["measured"] = [f"{T!r} K" for T in passport.temperatures]
    bounds, fitted = passport.frequencies, passport.fitted_shift
    nearest: dict[str, Any] = {}
    if fitted is not None:
        errors = {"standard_error": list(fitted.standard_error), "misfit": fitted.misfit}
        nearest = _law(fitted.law) | errors
    return [
        ("[material]", solid),
        ("[convention]", convention),
        ("[temperature]", temperature | _law(passport.shift)),
        ("[nearest_law]", nearest),
        ("[range]", {"angular_frequency": [f"{w!r} rad/s" for w in bounds]} if bounds else {}),
        ("[origin]", _stated(passport.origin)),
        ("[evidence]", _stated(passport.evidence) if passport.evidence else {}),
        *(("[[allowed]]", _solid(allowed)) for allowed in passport.allowed),
    ]


def _solid(material: Any) -> dict[str, Any]:
    return {"model": word_of(material)} | with_units(material)


def _law(shift: Shift | None) -> dict[str, Any]:
    if shift is None:
        return {}
    zero = f"{shift.reference_temperature!r} K"
    if not isinstance(shift, TabulatedShift):
        constants = with_units(shift)
        del constants["reference_temperature"]
        return {"law": shift.word, "zero": zero} | constants
    rows = zip(shift.temperature, shift.values, strict=True)
    more = {"uncertainty": list(shift.uncertainty), "vertical": list(shift.vertical)}
    return {"law": "table", "zero": zero, "shifts": [[f"{T!r} K", value] for T, value in rows]} | {
        key: values for key, values in more.items() if values
    }


def _stated(record: Any) -> dict[str, Any]:
    """Return the non-empty fields of a record."""
    values = {field.name: getattr(record, field.name) for field in fields(record)}
    return {key: value for key, value in values.items() if value not in ("", (), None)}


def read_passport(path: str | os.PathLike[str], *, also: Iterable[Any] = ()) -> Passport:
    """Read a passport from a TOML file.

    Parameters
    ----------
    path : path
        File written by :func:`write_passport`, or by hand with the same tables.
    also : iterable of classes
        User-defined materials that the file may name by their words; unused ones are ignored.

    Returns
    -------
    Passport
        Equal to the one that was written.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If the file is not a passport, or a key is missing, unknown or invalid.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from viscotack.model.materials.library import published
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "pdms.toml")
    ...     write_passport(published("pdms-10-1"), file)
    ...     read_passport(file) == published("pdms-10-1")
    True
    """
    path = Path(path)
    tables = read_toml(path)
    if "passport" not in tables:
        raise InputError(
            f"{path} is not a material passport, because it lacks the line 'passport = {VERSION}'; "
            "create one by `viscotack material fit`; docs/materials.md shows an example"
        )
    if tables["passport"] != VERSION:
        raise InputError(
            f"{path}: passport version {tables['passport']!r} is not supported, only {VERSION}; "
            "use a newer viscotack"
        )
    own = {kind.word: kind for kind in also if hasattr(kind, "retardation_modes")}
    try:
        return _passport(tables, {**MODELS, **own}, Reading("the passport", bare=True))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        words = f"{error.args[0]} is missing" if isinstance(error, KeyError) else error
        raise InputError(
            f"{path}: {words}; docs/materials.md shows a passport",
            field=getattr(error, "field", ""),
        ) from None


def _passport(tables: Mapping[str, Any], models: Mapping[str, Any], reading: Reading) -> Passport:
    for name in tables:
        if name not in ("passport", "name", *_TABLES):
            raise InputError(f"unknown table [{name}]; allowed tables: {', '.join(_TABLES)}")
    convention = tables.get("convention", {})
    if convention.get("modulus", "E") != "E":
        raise InputError(
            f'[convention] modulus must be "E", got {convention["modulus"]!r}; a passport states '
            "Young's moduli, E = 2 (1 + nu) G"
        )
    temperature, nearest = tables.get("temperature", {}), tables.get("nearest_law")
    measured = convention.get("measured", _NOT_STATED)
    reference = temperature.get("reference")
    return Passport(
        name=str(tables.get("name", "")),
        material=_material(tables.get("material"), models, reading),
        temperature=None if reference is None else parse(reference, "K"),
        shift=_shift(temperature, "temperature", reading) if "law" in temperature else None,
        fitted_shift=_fitted(nearest, reading) if nearest else None,
        temperatures=_span(temperature.get("measured"), "K"),
        frequencies=_span(tables.get("range", {}).get("angular_frequency"), "rad/s"),
        measured=None if measured == _NOT_STATED else measured,
        origin=read_as(Origin, tables.get("origin", {}), reading, "origin"),
        evidence=(
            read_as(Evidence, tables["evidence"], reading, "evidence")
            if "evidence" in tables
            else None
        ),
        allowed=tuple(_material(table, models, reading) for table in tables.get("allowed", ())),
    )


def _material(given: Any, models: Mapping[str, Any], reading: Reading) -> Material:
    """Return the material of a table [material]; its model must be one of the given ones."""
    table = reading.given(given, "material")
    kind = reading.choice(table, "material", "model", models, OWN)
    del table["model"]
    return read_as(kind, table, reading, "material")


def _shift(table: Mapping[str, Any], name: str, reading: Reading) -> Shift:
    zero, law = parse(table["zero"], "K"), table["law"]
    if law == "table":
        rows = [(parse(T, "K"), float(value)) for T, value in table["shifts"]]
        temperature, values = zip(*rows, strict=True)
        more = {key: tuple(map(float, table.get(key, ()))) for key in ("uncertainty", "vertical")}
        return TabulatedShift(zero, temperature, values, **more)
    kind = reading.choice(table, name, "law", LAWS, '; law = "table" for one measured')
    others = ("law", "zero", "reference", "measured", "standard_error", "misfit")
    constants = {key: value for key, value in table.items() if key not in others}
    return read_as(kind, constants | {"reference_temperature": zero}, reading, name)


def _fitted(table: Mapping[str, Any], reading: Reading) -> FittedShift:
    law: Any = _shift(table, "nearest_law", reading)
    return FittedShift(law, tuple(map(float, table["standard_error"])), float(table["misfit"]))


def _span(values: Any, unit: str) -> tuple[float, float] | None:
    if values is None:
        return None
    low, high = values
    return parse(low, unit), parse(high, unit)
