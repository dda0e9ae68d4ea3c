"""Read a design from a TOML file: targets, bounds, materials to choose from, and the interface.

The tables [interface] and [material] are those of a case file; [[materials]] is a list of such
materials, each with a name. [targets] has hold, release and ratio, [bounds] the variables.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.materials import Material
from viscotack.problem.case_file import case_of_tables
from viscotack.problem.case_table import Table, refuse_named, refuse_unknown
from viscotack.units import parse

from .space import PADS, UNITS, Bounds, DesignSpace, Targets

_TABLES = ("targets", "bounds", "material", "materials", "interface")
_TARGETS = {"hold": ("N", '"5 mN"'), "release": ("N", '"1 mN"'), "ratio": ("1", "4")}
_EXAMPLES = {
    "radius": '"1 mm..10 mm"',
    "preload": '"1 mN..20 mN"',
    "pads": '"1..12"',
    "hold_speed": '"100 um/s..10 mm/s"',
    "release_speed": '"0.1 um/s..10 um/s"',
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
    """

    materials: Mapping[str, Material]
    traction: Any
    space: DesignSpace
    targets: Targets


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
    first = next(iter(problems.values()))
    return DesignFile(
        {name: each.material for name, each in problems.items()},
        first.traction,
        _space(Table(path, "bounds", tables)),
        _targets(Table(path, "targets", tables)),
    )


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


def _space(table: Table) -> DesignSpace:
    table.known |= {*UNITS, "area"}
    found: dict[str, Any] = {
        name: _bounds(table, name) for name in UNITS if name in (*table.values, *_NEEDED)
    }
    if "area" in table.values:
        found["area"] = table.quantity("area", "m^2", '"4 cm^2"')
    table.finish()
    return table.make(DesignSpace, **found)


def _bounds(table: Table, name: str) -> Bounds:
    """Return the bounds of a variable: a quantity, or a range "1 mm..10 mm"."""
    given = table.get(name, _EXAMPLES[name])
    ends = given.split(_TO, 1) if isinstance(given, str) else [given]
    if name != PADS and not isinstance(given, str):
        raise InputError(
            f"{table.name} {name} must be text with a unit, got {given!r:.60}; write for example "
            f"{name} = {_EXAMPLES[name]}"
        )
    try:
        numbers = [
            float(parse(end.strip() if isinstance(end, str) else end, UNITS[name])) for end in ends
        ]
    except ValueError as error:
        raise InputError(
            f"{table.name} {name}: {error}; for example {name} = {_EXAMPLES[name]}"
        ) from None
    return table.make(Bounds, *numbers)
