"""Read a design from a TOML file: targets, bounds, materials to choose from, and the interface.

The tables [interface] and [material] are those of a case file; [[materials]] is a list of such
materials, each with a name. [targets] has what is wanted, [bounds] the variables, [conditions] the
speeds and temperatures at which all targets count, and [scatter] tolerances with the yield.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

from viscotack.cards import Quantity
from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.geometry import Bonded
from viscotack.materials import Material
from viscotack.materials.passport import Passport
from viscotack.problem.case_file import case_of_tables, passport_of
from viscotack.problem.nouns import known
from viscotack.problem.tables import Read, Reading, read_as, refuse_named, refuse_unknown

from .space import (
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
# Names of what is not computed.
_ALONG = ("shear", "peel", "tilt")
_TO = ".."
_MOST_MATERIALS = 10


def _bounds(value: Any, reading: Reading, unit: str, example: str) -> Bounds:
    """Return the bounds of a variable: a quantity, or a range "1 mm..10 mm"."""
    ends = value.split(_TO, 1) if isinstance(value, str) else [value]
    pure = "1" if unit == "1" else unit
    numbers = (reading.parsed(x.strip() if isinstance(x, str) else x, pure, example) for x in ends)
    return Bounds(*numbers)


def _of(unit: str, example: str) -> Read:
    return Read(partial(_bounds, unit=unit, example=example))


@dataclass(frozen=True)
class _BoundsTable:
    """The table [bounds]: the variables of a design, and what limits the pads."""

    radius: Annotated[Bounds, _of("m", "1 mm..10 mm")]
    preload: Annotated[Bounds, _of("N", "1 mN..20 mN")]
    pads: Annotated[Bounds | None, _of("1", "1..12")] = None
    hold_speed: Annotated[Bounds | None, _of("m/s", "100 um/s..10 mm/s")] = None
    release_speed: Annotated[Bounds | None, _of("m/s", "0.1 um/s..10 um/s")] = None
    modulus: Annotated[Bounds | None, _of("Pa", "0.5 MPa..5 MPa")] = None
    thickness: Annotated[Bounds | None, _of("m", "100 um..2 mm")] = None
    exponent: Annotated[Bounds | None, _of("1", "2..4")] = None
    backing: Annotated[Bounds | None, _of("N/m", "100 N/m..10 kN/m")] = None
    area: (
        Annotated[float, Quantity("m^2", "A", "largest area", above=0, example="4 cm^2")] | None
    ) = None
    base: Literal["frictionless", "bonded"] | None = None


@dataclass(frozen=True)
class _ConditionsTable:
    """The table [conditions]: speeds and temperatures at which all targets count."""

    hold_speed: Annotated[Bounds | None, _of("m/s", "100 um/s..10 mm/s")] = None
    release_speed: Annotated[Bounds | None, _of("m/s", "0.1 um/s..10 um/s")] = None
    temperature: Annotated[Bounds | None, _of("K", "10 degC..30 degC")] = None


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
    refuse_named(f"{path}", tables, _ALONG, "pads are pulled along their axis from a rigid plate")
    refuse_unknown(f"{path}", tables, _TABLES, "table")
    reading = Reading(str(path), known(also), beside or path.parent.joinpath)
    materials = _materials(path, tables)
    problems = {
        name: case_of_tables(
            {"material": table, "interface": tables.get("interface"), **_POSED},
            where=f"{path}, material {name!r}",
            also=also,
            beside=reading.beside,
        )
        for name, table in materials.items()
    }
    passports = {
        name: passport_of({"material": each}, reading)[0] for name, each in materials.items()
    }
    given = read_as(_ConditionsTable, tables.get("conditions", {}), reading, "conditions")
    speeds = {HOLD_SPEED: given.hold_speed, RELEASE_SPEED: given.release_speed}
    windows = {name: each for name, each in speeds.items() if each is not None}
    shifts: dict[str, tuple[float, float]] = {}
    if given.temperature is not None:
        shifts = {
            name: _shifts(passports[name], name, given.temperature, path) for name in materials
        }
    deviations, share = _scatter(tables, reading)
    window = {f"{name.removesuffix('_speed')}_window": x.top / x.low for name, x in windows.items()}
    try:
        conditions = Conditions(**window, shifts=shifts, deviations=deviations, share=share)
    except InputError as error:
        raise InputError(f"{path}, [scatter] {error}") from None
    return DesignFile(
        {name: each.material for name, each in problems.items()},
        next(iter(problems.values())).traction,
        _space(tables, windows, reading),
        read_as(Targets, tables.get("targets"), reading, "targets"),
        conditions,
        {name: each for name, each in passports.items() if each is not None},
    )


def _shifts(passport: Passport | None, name: str, ends: Bounds, path: Path) -> tuple[float, float]:
    """Return the least and largest factor on the times of a material over the temperatures."""
    if passport is None:
        raise InputError(
            f"{path}, material {name!r}: temperatures need a passport, which has the shift of "
            "the times"
        )
    if passport.temperature is None:
        raise InputError(f"{path}, material {name!r}: the temperature of the passport is unknown")
    own = passport.shift_factor(passport.temperature)
    found = [passport.shift_factor(T) / own for T in (ends.low, ends.top)]
    return min(found), max(found)


def _scatter(tables: Mapping[str, Any], reading: Reading) -> tuple[dict[str, float], float]:
    """Return the tolerances and the least share of parts that meet the targets."""
    given = tables.get("scatter", {})
    where = f"{reading.where}, [scatter]"
    if not isinstance(given, Mapping):
        raise InputError(f"{where} must be a table")
    names = [name for name in (*UNITS, *INTERFACE, "yield") if name != PADS]
    refuse_unknown(where, given, names, "key")
    found = {}
    for name, value in given.items():
        try:
            found[name] = reading.parsed(value, "1", "3 %")
        except InputError as error:
            raise InputError(f"{where} {name}: {error}") from None
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


def _space(
    tables: Mapping[str, Any], windows: Mapping[str, Bounds], reading: Reading
) -> DesignSpace:
    table = read_as(_BoundsTable, tables.get("bounds"), reading, "bounds")
    where = f"{reading.where}, [bounds]"
    if twice := [name for name in windows if getattr(table, name) is not None]:
        raise InputError(
            f"{where} {twice[0]}: all speeds in [conditions] count; remove it from [bounds]"
        )
    found: dict[str, Any] = {name: x for name in UNITS if (x := getattr(table, name)) is not None}
    for name, each in windows.items():
        found[name] = Bounds(each.low if name == HOLD_SPEED else each.top)
    try:
        return DesignSpace(**found, area=table.area, bonded=table.base == Bonded.word)
    except InputError as error:
        raise InputError(f"{where} {error}") from None
