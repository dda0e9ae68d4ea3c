"""Read a design from a TOML file: targets, bounds, materials to choose from, and the interface.

The tables [interface] and [material] are those of a case file; [[materials]] is a list of such
materials, each with a name. [targets] has what is wanted, [bounds] the variables, [conditions] the
speeds and temperatures at which all targets count, and [scatter] tolerances with the yield.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.geometry import Bonded, Frictionless
from viscotack.materials import Material
from viscotack.materials.library import MATERIALS, passport_of
from viscotack.materials.passport import Passport
from viscotack.problem.case_file import case_of_tables, passport_of_tables
from viscotack.problem.case_table import Table, refuse_named, refuse_unknown
from viscotack.units import parse

from .space import (
    EXPONENT,
    HOLD_SPEED,
    INTERFACE,
    PADS,
    RELEASE_SPEED,
    UNITS,
    Bounds,
    Conditions,
    DesignSpace,
    Targets,
)

_TABLES = ("targets", "bounds", "conditions", "scatter", "material", "materials", "interface")
_TARGETS = {
    "hold": ("N", '"5 mN"'),
    "release": ("N", '"1 mN"'),
    "ratio": ("1", "4"),
    "work": ("J", '"20 nJ"'),
    "dead_load": ("N", '"2 mN"'),
    "preload": ("N", '"10 mN"'),
    "holding_time": ("s", '"60 s"'),
}
_EXAMPLES = {
    "radius": '"1 mm..10 mm"',
    "preload": '"1 mN..20 mN"',
    "pads": '"1..12"',
    "hold_speed": '"100 um/s..10 mm/s"',
    "release_speed": '"0.1 um/s..10 um/s"',
    "modulus": '"0.5 MPa..5 MPa"',
    "thickness": '"100 um..2 mm"',
    "exponent": '"2..4"',
    "backing": '"100 N/m..10 kN/m"',
    "temperature": '"10 degC..30 degC"',
}
_NEEDED = ("radius", "preload")
# Names of what is not computed.
_ALONG = ("shear", "peel", "tilt")
_TO = ".."
_MOST_MATERIALS = 10
# Indenter and test used in place of those of a design while material and interface are read.
_POSED = {
    "sphere": {"radius": "1 m"},
    "protocol": {"preload_depth": "0 m", "speed": "1 um/s"},
}


@dataclass(frozen=True)
class DesignFile:
    """Contents of a file.

    Attributes
    ----------
    materials : mapping of str to material
        Materials to choose from.
    traction : traction law
        The interface.
    space : DesignSpace
        Bounds of the variables.
    targets : Targets
        Wanted forces.
    conditions : Conditions
        Speeds, temperatures and tolerances at which they count.
    passports : mapping of str to Passport
        Passports of the materials that have one, at the temperature of the material.
    """

    materials: Mapping[str, Material]
    traction: Any
    space: DesignSpace
    targets: Targets
    conditions: Conditions = Conditions()
    passports: Mapping[str, Passport] = field(default_factory=dict)


def read_design(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> DesignFile:
    """Read a design from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/design.md describes its tables.
    also : iterable of classes
        User-defined laws and materials that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    path = Path(path)
    tables = read_toml(path)
    refuse_named(path, tables, _ALONG, "pads are pulled along their axis from a rigid plate")
    refuse_unknown(f"{path}", tables, _TABLES, "table")
    beside = beside or path.parent.joinpath
    problems = {
        name: case_of_tables(
            {"material": table, "interface": tables.get("interface", {}), **_POSED},
            where=f"{path}, material {name!r}",
            also=also,
            beside=beside,
        )
        for name, table in _materials(path, tables).items()
    }
    passports = {
        name: passport_of_tables({"material": table}, where=path, also=also, beside=beside)[0]
        for name, table in _materials(path, tables).items()
    }
    first = next(iter(problems.values()))
    given = Table(path, "conditions", tables) if "conditions" in tables else None
    windows = {} if given is None else _windows(given)
    shifts: dict[str, tuple[float, float]] = {}
    if given is not None and "temperature" in given.values:
        ends = _bounds(given, "temperature", "K")
        shifts = {
            name: _shifts(table, name, ends, path, also, beside)
            for name, table in _materials(path, tables).items()
        }
    if given is not None:
        given.finish()
    deviations, share = _scatter(path, tables)
    window = {f"{name.removesuffix('_speed')}_window": x.top / x.low for name, x in windows.items()}
    return DesignFile(
        {name: each.material for name, each in problems.items()},
        first.traction,
        _space(Table(path, "bounds", tables), windows),
        _targets(Table(path, "targets", tables)),
        Conditions(**window, shifts=shifts, deviations=deviations, share=share),
        {name: each for name, each in passports.items() if each is not None},
    )


def _windows(table: Table) -> dict[str, Bounds]:
    """Return the speeds at which targets must be met, all of them."""
    names = [name for name in (HOLD_SPEED, RELEASE_SPEED) if name in table.values]
    table.known |= {HOLD_SPEED, RELEASE_SPEED, "temperature"}
    return {name: _bounds(table, name) for name in names}


def _shifts(
    material: Any,
    name: str,
    ends: Bounds,
    path: Path,
    also: Iterable[Any],
    beside: Callable[[str], Path],
) -> tuple[float, float]:
    """Return the least and largest factor on the times of a material over the temperatures."""
    if "passport" not in material:
        raise InputError(
            f"{path}, material {name!r}: temperatures need a passport, which has the shift of "
            "the times"
        )
    table = Table(path, "material", {"material": material}, beside)
    given = material["passport"]
    file = given if given in MATERIALS else str(table.beside("passport", '"pdms.toml"'))
    passport = passport_of(file, also=also)
    stated = passport.temperature
    if "temperature" in material:
        stated = table.quantity("temperature", "K", '"20 degC"')
    if stated is None:
        raise InputError(f"{path}, material {name!r}: the temperature of the passport is unknown")
    own = passport.shift_factor(stated)
    found = [passport.shift_factor(T) / own for T in (ends.low, ends.top)]
    return min(found), max(found)


def _scatter(path: Path, tables: Mapping[str, Any]) -> tuple[dict[str, float], float]:
    """Return the tolerances and the least share of parts that meet the targets."""
    if "scatter" not in tables:
        return {}, 0.0
    table = Table(path, "scatter", tables)
    names = [name for name in (*UNITS, *INTERFACE) if name != PADS]
    table.known |= {*names, "yield"}
    found = {
        name: table.quantity(name, "1", '"3 %"')
        for name in (*names, "yield")
        if name in table.values
    }
    table.finish()
    return {name: x for name, x in found.items() if name != "yield"}, found.get("yield", 0.0)


def _materials(path: Path, tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of the materials by their names."""
    if ("material" in tables) == ("materials" in tables):
        raise InputError(f"{path}: a design needs either [material] or a list of [[materials]]")
    if "material" in tables:
        only = tables["material"]
        named = only.get("passport", only.get("model")) if isinstance(only, Mapping) else None
        return {named if isinstance(named, str) else "material": only}
    given = tables["materials"]
    if not isinstance(given, list) or not 0 < len(given) <= _MOST_MATERIALS:
        raise InputError(f"{path}: [[materials]] must be a list of 1 to {_MOST_MATERIALS} tables")
    found: dict[str, Any] = {}
    for number, each in enumerate(given, start=1):
        name = each.get("name") if isinstance(each, Mapping) else None
        if not isinstance(name, str) or not name or name in found:
            raise InputError(
                f"{path}: each of [[materials]] needs a name of its own; number {number} has "
                f"{name!r:.60}"
            )
        found[name] = {key: value for key, value in each.items() if key != "name"}
    return found


def _targets(table: Table) -> Targets:
    table.known |= _TARGETS.keys()
    found = {
        name: table.quantity(name, unit, example)
        for name, (unit, example) in _TARGETS.items()
        if name in table.values
    }
    table.finish()
    return table.make(Targets, **found)


def _space(table: Table, windows: Mapping[str, Bounds]) -> DesignSpace:
    table.known |= {*UNITS, "area", "base"}
    if twice := [name for name in windows if name in table.values]:
        raise InputError(
            f"{table.name} {twice[0]}: all speeds in [conditions] count; remove it from [bounds]"
        )
    found: dict[str, Any] = {
        name: _bounds(table, name) for name in UNITS if name in (*table.values, *_NEEDED)
    }
    for name, each in windows.items():
        found[name] = Bounds(each.low if name == HOLD_SPEED else each.top)
    if "area" in table.values:
        found["area"] = table.quantity("area", "m^2", '"4 cm^2"')
    if "base" in table.values:
        found["bonded"] = table.word("base", (Frictionless.word, Bonded.word)) == Bonded.word
    table.finish()
    return table.make(DesignSpace, **found)


def _bounds(table: Table, name: str, unit: str = "") -> Bounds:
    """Return the bounds of a variable: a quantity, or a range "1 mm..10 mm"."""
    unit = unit or UNITS[name]
    given = table.get(name, _EXAMPLES[name])
    ends = given.split(_TO, 1) if isinstance(given, str) else [given]
    if name not in (PADS, EXPONENT) and not isinstance(given, str):
        raise InputError(
            f"{table.name} {name} must be text with a unit, got {given!r:.60}; write for example "
            f"{name} = {_EXAMPLES[name]}"
        )
    try:
        numbers = [float(parse(end.strip() if isinstance(end, str) else end, unit)) for end in ends]
    except ValueError as error:
        raise InputError(
            f"{table.name} {name}: {error}; for example {name} = {_EXAMPLES[name]}"
        ) from None
    return table.make(Bounds, *numbers)
