"""Passports as TOML files, without loss of digits, and as text for people.

Quantities in files are text with units, so that TOML readers of other programs need no other
information.
"""

import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.cards import Pairs, cards, with_units
from viscotack.errors import InputError
from viscotack.files.toml import read_toml, toml_value
from viscotack.files.whole import Target, write_whole
from viscotack.model.materials.material import Material, word_of
from viscotack.model.materials.passport import Evidence, Origin, Passport
from viscotack.model.materials.shift import LAWS, FittedShift, Shift, TabulatedShift
from viscotack.model.tables import OWN, Reading, read_as, stated
from viscotack.units import parse, readable

VERSION = 1
_TABLES = (
    "material", "convention", "temperature", "nearest_law", "range", "origin", "evidence",
    "allowed",
)  # fmt: skip
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
    kind = type(passport.material)
    known = cards(kind) | cards(kind, Pairs)
    times = [f"{name}: {known[name].card.words}" for name in ("tau0", "branches") if name in known]
    temperature: dict[str, Any] = {}
    if passport.temperature is not None:
        temperature["reference"] = f"{passport.temperature!r} K"
    if passport.temperatures is not None:
        temperature["measured"] = [f"{T!r} K" for T in passport.temperatures]
    fitted, bounds = passport.fitted_shift, passport.frequencies
    nearest: dict[str, Any] = {}
    if fitted is not None:
        errors = {"standard_error": list(fitted.standard_error), "misfit": fitted.misfit}
        nearest = _law(fitted.law) | errors
    tables = [
        ("[material]", _solid(passport.material)),
        (
            "[convention]",
            {
                "modulus": "E",
                "measured": passport.measured or _NOT_STATED,
                "times": "; ".join(times) or "none",
            },
        ),
        ("[temperature]", temperature | _law(passport.shift)),
        ("[nearest_law]", nearest),
        ("[range]", {"angular_frequency": [f"{w!r} rad/s" for w in bounds]} if bounds else {}),
        ("[origin]", stated(passport.origin)),
        ("[evidence]", stated(passport.evidence) if passport.evidence else {}),
        *(("[[allowed]]", _solid(allowed)) for allowed in passport.allowed),
    ]
    lines = [
        "# A material and its papers, written by viscotack. Moduli are Young's moduli.",
        f"passport = {VERSION}",
        f"name = {toml_value(passport.name)}",
    ]
    for name, table in tables:
        if table:
            lines += ["", name, *(f"{key} = {toml_value(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _solid(material: Any) -> dict[str, Any]:
    return {"model": word_of(material)} | with_units(material)


def _law(shift: Shift | None) -> dict[str, Any]:
    if shift is None:
        return {}
    table: dict[str, Any] = {"law": shift.word, "zero": f"{shift.reference_temperature!r} K"}
    if not isinstance(shift, TabulatedShift):
        return table | {k: x for k, x in with_units(shift).items() if k != "reference_temperature"}
    rows = zip(shift.temperature, shift.values, strict=True)
    more = {"uncertainty": shift.uncertainty, "vertical": shift.vertical}
    table["shifts"] = [[f"{T!r} K", value] for T, value in rows]
    return table | {key: values for key, values in more.items() if values}


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
    reading = Reading("the passport", bare=True)
    nouns = replace(reading.nouns, materials={**reading.nouns.materials, **own})
    try:
        return _passport(tables, replace(reading, nouns=nouns))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        words = f"{error.args[0]} is missing" if isinstance(error, KeyError) else error
        raise InputError(
            f"{path}: {words}; docs/materials.md shows a passport",
            field=getattr(error, "field", ""),
        ) from None


def _passport(tables: Mapping[str, Any], reading: Reading) -> Passport:
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
    fitted = None
    if nearest:
        law: Any = _shift(nearest, "nearest_law", reading)
        errors = tuple(map(float, nearest["standard_error"]))
        fitted = FittedShift(law, errors, float(nearest["misfit"]))
    measured = convention.get("measured", _NOT_STATED)
    reference = temperature.get("reference")
    return Passport(
        name=str(tables.get("name", "")),
        material=_material(tables.get("material"), reading),
        temperature=None if reference is None else parse(reference, "K"),
        shift=_shift(temperature, "temperature", reading) if "law" in temperature else None,
        fitted_shift=fitted,
        temperatures=_span(temperature.get("measured"), "K"),
        frequencies=_span(tables.get("range", {}).get("angular_frequency"), "rad/s"),
        measured=None if measured == _NOT_STATED else measured,
        origin=read_as(Origin, tables.get("origin", {}), reading, "origin"),
        evidence=(
            read_as(Evidence, tables["evidence"], reading, "evidence")
            if "evidence" in tables
            else None
        ),
        allowed=tuple(_material(table, reading) for table in tables.get("allowed", ())),
    )


def _material(given: Any, reading: Reading) -> Material:
    """Return the material of a table [material]."""
    table = reading.given(given, "material")
    kind = reading.choice(table, "material", "model", reading.nouns.materials, OWN)
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


def _span(values: Any, unit: str) -> tuple[float, float] | None:
    if values is None:
        return None
    low, high = values
    return parse(low, unit), parse(high, unit)


def in_words(passport: Passport) -> str:
    """Format a passport as lines of text."""
    solid = passport.material
    model = word_of(solid)
    lines = [f"{passport.name}: {model}"]
    for name, field in cards(type(solid)).items():
        number = readable(getattr(solid, name), field.card.unit, digits=5)
        lines.append(f"  {name:<18}{number:>16}")
    lines.append(f"  {'modulus_ratio':<18}{solid.modulus_ratio:>16.5g}")
    if model == "prony":
        lines.append(f"  {'branches':<18}{len(solid.branches):>16}")
        lines += [
            f"    {readable(E, 'Pa', digits=5):>16}{readable(t, 's', digits=5):>16}"
            for E, t in solid.branches
        ]
    if passport.temperature is not None:
        law = "no shift" if passport.shift is None else type(passport.shift).__name__
        lines.append(f"  at {passport.temperature - 273.15:.4g} C; times shift by: {law}")
    lines += shift_lines(passport)
    if passport.temperatures is not None:
        low, high = (T - 273.15 for T in passport.temperatures)
        lines.append(f"  measured from {low:.4g} to {high:.4g} C")
    if passport.frequencies is not None:
        low, high = (w / (2 * np.pi) for w in passport.frequencies)
        lines.append(f"  known from {readable(low, 'Hz', digits=3, to=high)}")
    origin = passport.origin
    for words in (origin.reference, origin.doi and f"doi:{origin.doi}", origin.file):
        if words:
            lines.append(f"  source: {words}")
    if passport.evidence is not None:
        for name, low, high in passport.evidence.intervals:
            level = 100 * passport.evidence.level
            lines.append(f"  {level:.0f} % interval of {name}: {low:.5g} to {high:.5g}")
        lines += [f"  Not determined: {words}" for words in passport.evidence.undetermined]
        lines += [f"  Note: {words}" for words in passport.evidence.cautions]
    return "\n".join(line.rstrip() for line in lines)


def shift_lines(passport: Passport) -> list[str]:
    """Format a table of shifts and its fitted law as lines; empty without a table."""
    shift = passport.shift
    if not isinstance(shift, TabulatedShift):
        return []
    unknown = [np.nan] * len(shift.values)
    rows = zip(
        shift.temperature,
        np.asarray(shift.log10_shift(shift.temperature)),
        shift.uncertainty or unknown,
        shift.vertical or unknown,
        strict=True,
    )
    lines = ["         T [C]   log10 a_T          +-    log10 b_T"]
    lines += [
        f"    {round(T - 273.15, 2) + 0.0:>10.2f}{value:>12.3f}{doubt:>12.2g}{up:>13.3f}".replace(
            "nan", "  -"
        )
        for T, value, doubt, up in rows
    ]
    if passport.fitted_shift is None:
        return (
            [*lines, "  no WLF or Arrhenius law fits the table"] if len(shift.values) > 2 else lines
        )
    return [*lines, f"  nearest law: {passport.fitted_shift.words()}"]
