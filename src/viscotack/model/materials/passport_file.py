"""Read and write passports as TOML files, without loss of digits.

docs/materials.md shows an example. Every quantity is text with its unit, as in case files. The
tables [relaxation] and [retardation] are derived from [material] for other programs; reading
rejects a file in which they disagree.
"""

import os
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.cards import Pairs, cards
from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.files.whole import Target, write_whole
from viscotack.model.materials.checks import rests
from viscotack.model.materials.material import Material
from viscotack.model.materials.modes import maxwell, voigt
from viscotack.model.materials.passport import Evidence, Origin, Passport
from viscotack.model.materials.passport_tables import VERSION, passport_text
from viscotack.model.materials.shift import LAWS, WLF, Arrhenius, FittedShift, Shift, TabulatedShift
from viscotack.model.materials.words import FITS_ONLY, MODELS, units_of
from viscotack.units import parse

_TABLES = (
    "material", "convention", "temperature", "nearest_law", "range", "origin", "evidence",
    "relaxation", "retardation", "allowed",
)  # fmt: skip


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
        If the file is not a passport, a key is missing, unknown or invalid, or its relaxation or
        retardation form disagrees with its material.

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
    try:
        return _passport(tables, known_models(also))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        missing = isinstance(error, KeyError)
        words = (
            f"{error.args[0]} is missing; docs/materials.md shows a passport" if missing else error
        )
        raise InputError(f"{path}: {words}") from None


def known_models(also: Iterable[Any] = ()) -> Mapping[str, Any]:
    """Return the classes of materials by their words, including user-defined ones."""
    own = {kind.word: kind for kind in also if hasattr(kind, "retardation_modes")}
    return {**MODELS, **own}


def _passport(tables: Mapping[str, Any], models: Mapping[str, Any]) -> Passport:
    for name in tables:
        if name not in ("passport", "name", *_TABLES):
            raise InputError(f"unknown table [{name}]; allowed tables: {', '.join(_TABLES)}")
    convention = tables.get("convention", {})
    if convention.get("modulus", "E") != "E":
        raise InputError(
            f'[convention] modulus must be "E", got {convention["modulus"]!r}; a passport states '
            "Young's moduli, E = 2 (1 + nu) G"
        )
    temperature = tables.get("temperature", {})
    bounds = tables.get("range", {}).get("angular_frequency")
    measured = convention.get("measured", "not stated")
    passport = Passport(
        name=str(tables.get("name", "")),
        material=material_in(tables["material"], models),
        temperature=_read(temperature.get("reference"), "K"),
        shift=_shift(temperature),
        fitted_shift=_fitted(tables.get("nearest_law", {})),
        temperatures=_span(temperature.get("measured"), "K"),
        frequencies=_span(bounds, "rad/s"),
        measured=None if measured == "not stated" else measured,
        origin=_made(Origin, tables.get("origin", {})),
        evidence=_made(Evidence, tables["evidence"]) if "evidence" in tables else None,
        allowed=tuple(material_in(table, models) for table in tables.get("allowed", ())),
    )
    _check_forms(passport, tables)
    return passport


def material_in(table: Mapping[str, Any], models: Mapping[str, Any]) -> Material:
    """Return the material of a table [material]; its model must be one of the given ones."""
    model = table["model"]
    rests(FITS_ONLY.get(model))
    if model not in models:
        raise InputError(
            f"[material] model must be one of {', '.join(models)}, got {model!r}; for a "
            "user-defined model, give its class (also=(CLASS,) in Python, --with FILE.py on the "
            "command line)"
        )
    units, lists = units_of(models[model]), cards(models[model], Pairs)
    values: dict[str, Any] = {key: parse(table[key], unit) for key, unit in units.items()}
    for key, field in lists.items():
        first, second = field.card.units
        values[key] = [(parse(x, first), parse(y, second)) for x, y in table[key]]
    extra = table.keys() - {"model", *lists, *units}
    if extra:
        raise InputError(f"[material] has the unknown key {min(extra)!r}")
    return models[model](**values)


def _check_forms(passport: Passport, tables: Mapping[str, Any]) -> None:
    """Raise an error if the series disagree with the material, because one of them was edited."""
    forms = (
        ("relaxation", "rubbery_modulus", "branches", "Pa", _modulus_of_branches),
        ("retardation", "glassy_modulus", "elements", "1/Pa", _modulus_of_elements),
    )
    for name, plateau, pairs, unit, modulus in forms:
        if name not in tables:
            continue
        table = tables[name]
        sizes, times = np.array([(parse(E, unit), parse(t, "s")) for E, t in table[pairs]]).T
        omega = np.geomspace(*(passport.frequencies or (0.1 / times[-1], 10 / times[0])), 60)
        stated = modulus(omega, parse(table[plateau], "Pa"), sizes, times)
        exact = np.asarray(passport.material.complex_modulus(omega))
        allowed = min(1.5 * float(table["largest_error"]), 0.1) + 1e-9
        if not np.max(np.abs(stated / exact - 1)) < allowed:
            raise InputError(
                f"the table [{name}] disagrees with [material], from which it is derived; delete "
                "[relaxation] and [retardation] after editing [material]"
            )


def _modulus_of_branches(omega: Any, rubbery: float, E: Any, tau: Any) -> Any:
    return rubbery + maxwell(omega[:, None] * tau) @ E


def _modulus_of_elements(omega: Any, glassy: float, C: Any, tau: Any) -> Any:
    return 1 / (1 / glassy + voigt(omega[:, None] * tau) @ C)


def _shift(table: Mapping[str, Any]) -> Shift | None:
    if "law" not in table:
        return None
    zero = parse(table["zero"], "K")
    if table["law"] == "table":
        rows = [(parse(T, "K"), float(value)) for T, value in table["shifts"]]
        temperature, values = zip(*rows, strict=True)
        more = {key: tuple(map(float, table.get(key, ()))) for key in ("uncertainty", "vertical")}
        return TabulatedShift(zero, temperature, values, **more)
    return _law(table)


def _fitted(table: Mapping[str, Any]) -> FittedShift | None:
    if not table:
        return None
    errors = tuple(map(float, table["standard_error"]))
    return FittedShift(_law(table), errors, float(table["misfit"]))


def _law(table: Mapping[str, Any]) -> WLF | Arrhenius:
    zero = parse(table["zero"], "K")
    if table["law"] not in LAWS:
        raise InputError(
            f"[temperature] law must be one of {', '.join(LAWS)} or table, got {table['law']!r}"
        )
    kind = LAWS[table["law"]]
    constants = {key: parse(table[key], unit) for key, unit in kind.units.items()}
    return kind(reference_temperature=zero, **constants)


def _made(kind: Any, table: Mapping[str, Any]) -> Any:
    unknown = table.keys() - {field.name for field in fields(kind)}
    if unknown:
        raise InputError(f"[{kind.__name__.lower()}] has the unknown key {min(unknown)!r}")
    return kind(**{key: _frozen(value) for key, value in table.items()})


def _frozen(value: Any) -> Any:
    return tuple(_frozen(v) for v in value) if isinstance(value, list) else value


def _read(value: Any, unit: str) -> float | None:
    return None if value is None else parse(value, unit)


def _span(values: Any, unit: str) -> tuple[float, float] | None:
    if values is None:
        return None
    low, high = values
    return parse(low, unit), parse(high, unit)
