"""Read a design from a TOML file: targets, bounds, materials to choose from, and the interface.

The tables [interface] and [material] are those of a case file; [[materials]] is a list of such
materials, each with a name. [targets] has what is wanted, [bounds] the variables, [conditions] the
speeds and temperatures at which all targets count, and [scatter] tolerances with the yield.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

from viscotack.errors import InputError
from viscotack.model.materials import Material
from viscotack.model.materials.passport import Passport
from viscotack.model.problem.case_file import case_of_tables, passport_of
from viscotack.model.problem.tables import Reading, read_as, refuse_unknown

from .files import at, opened
from .space import (
    HOLD_SPEED,
    INTERFACE,
    PADS,
    RELEASE_SPEED,
    UNITS,
    Between,
    Bounds,
    Conditions,
    DesignSpace,
    Targets,
)

_TABLES = ("targets", "bounds", "conditions", "scatter", "material", "materials", "interface")
_MOST_MATERIALS = 10


@dataclass(frozen=True)
class _ConditionsTable:
    """The table [conditions]: speeds and temperatures at which all targets count."""

    hold_speed: Annotated[Bounds | None, Between("m/s", "100 um/s..10 mm/s")] = None
    release_speed: Annotated[Bounds | None, Between("m/s", "0.1 um/s..10 um/s")] = None
    temperature: Annotated[Bounds | None, Between("K", "10 degC..30 degC")] = None


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
    tables, reading = opened(path, _TABLES, also, beside, not_computed=("shear", "peel", "tilt"))
    materials = _materials(reading.where, tables)
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
    if (ends := given.temperature) is not None:
        for name in materials:
            with at(f"{path}, material {name!r}:"):
                shifts[name] = _shifts(passports[name], ends)
    deviations = _scatter(tables, reading)
    share = deviations.pop("yield", 0.0)
    window = {f"{name.removesuffix('_speed')}_window": x.top / x.low for name, x in windows.items()}
    with at(f"{path}, [scatter]"):
        conditions = Conditions(**window, shifts=shifts, deviations=deviations, share=share)
    return DesignFile(
        {name: each.material for name, each in problems.items()},
        next(iter(problems.values())).traction,
        _space(tables, windows, reading),
        read_as(Targets, tables.get("targets"), reading, "targets"),
        conditions,
        {name: each for name, each in passports.items() if each is not None},
    )


def _shifts(passport: Passport | None, ends: Bounds) -> tuple[float, float]:
    """Return the least and largest factor on the times of a material over the temperatures."""
    if passport is None:
        raise InputError("temperatures need a passport, which has the shift of the times")
    if passport.temperature is None:
        raise InputError("the temperature of the passport is unknown")
    own = passport.shift_factor(passport.temperature)
    found = [passport.shift_factor(T) / own for T in (ends.low, ends.top)]
    return min(found), max(found)


def _scatter(tables: Mapping[str, Any], reading: Reading) -> dict[str, float]:
    """Return the tolerances, and as "yield" the least share of parts that meet the targets."""
    given = tables.get("scatter", {})
    where = f"{reading.where}, [scatter]"
    if not isinstance(given, Mapping):
        raise InputError(f"{where} must be a table")
    known = [name for name in (*UNITS, *INTERFACE, "yield") if name != PADS]
    refuse_unknown(where, given, known, "key")
    found = {}
    for name, value in given.items():
        with at(f"{where} {name}:"):
            found[name] = reading.parsed(value, "1", "3 %")
    return found


def _materials(path: str, tables: Mapping[str, Any]) -> dict[str, Any]:
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
    found = read_as(DesignSpace, tables.get("bounds"), reading, "bounds")
    with at(f"{reading.where}, [bounds]"):
        if twice := [name for name in windows if getattr(found, name) is not None]:
            raise InputError(f"{twice[0]}: all speeds in [conditions] count; remove it")
    slowest = {name: x.low if name == HOLD_SPEED else x.top for name, x in windows.items()}
    speeds: dict[str, Any] = {name: Bounds(speed) for name, speed in slowest.items()}
    return replace(found, **speeds)
