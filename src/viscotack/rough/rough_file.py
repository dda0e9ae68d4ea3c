"""Read a rough surface and its test from a TOML file.

The tables [material], [interface], [protocol] and perhaps [layer] are those of a case file; the
table [surface] names a file of heights or states a generated map.
"""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.problem.case_file import parts_of_tables
from viscotack.problem.case_table import Table, refuse_unknown
from viscotack.surfaces import HeightMap, bumps, pillars, read_map, self_affine, sphere

from .problem import RoughProblem

_TABLES = ("surface", "material", "interface", "protocol", "layer")
_TOML = (".toml", "")
# Generated maps: their function, lengths that are needed, lengths and numbers that may be given.
_KINDS: dict[str, tuple[Any, tuple[str, ...], tuple[str, ...]]] = {
    "sphere": (sphere, ("radius",), ()),
    "self-affine": (self_affine, ("rms_height",), ("roll_off", "shortest")),
    "bumps": (bumps, ("radius", "spacing", "height"), ("scatter",)),
    "pillars": (pillars, ("radius", "spacing", "height"), ()),
}


def read_rough(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> RoughProblem:
    """Read a rough surface and its test from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/rough_surfaces.md describes its tables.
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
    if path.suffix.lower() not in _TOML and path.is_file():
        raise InputError(
            f"{path} must be a TOML file with a test; name a map of heights in it: [surface] with "
            f'file = "{path.name}"'
        )
    tables = read_toml(path)
    refuse_unknown(f"{path}", tables, _TABLES, "table")
    beside = beside or path.parent.joinpath
    parts = parts_of_tables(path, tables, also=also, beside=beside)
    surface = _surface(Table(path, "surface", tables, beside))
    try:
        return RoughProblem(surface=surface, **parts)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _surface(table: Table) -> HeightMap:
    """Return the map stated by the table [surface]; several generated maps may be added."""
    if "file" in table.values:
        found = _measured(table)
    else:
        kinds = table.get("kind", '"self-affine"')
        names = kinds if isinstance(kinds, list) else [kinds]
        if not names or any(name not in _KINDS for name in names):
            raise InputError(f"{table.name} kind must be one of {', '.join(_KINDS)}, got {kinds!r}")
        maps = [_generated(table, name) for name in names]
        found = maps[0]
        for other in maps[1:]:
            found = table.make(found.__add__, other)
    if _switch(table, "level", False):
        found = table.make(found.levelled, curvature=_switch(table, "remove_curvature", False))
    table.finish()
    return found


def _measured(table: Table) -> HeightMap:
    file = table.beside("file", '"scan.npy"')
    table.known |= {"pixel", "height_unit"}

    def stated(key: str) -> float | None:
        return table.quantity(key, "m", '"1 nm"') if key in table.values else None

    pixel, unit = stated("pixel"), stated("height_unit")
    return table.make(
        read_map, file, pixel=pixel, unit=unit, periodic=_switch(table, "periodic", False)
    )


def _generated(table: Table, name: str) -> HeightMap:
    kind, needed, optional = _KINDS[name]
    table.known.add("kind")
    values: dict[str, Any] = {key: table.quantity(key, "m", '"10 um"') for key in needed}
    table.known |= set(optional)
    values |= {key: table.quantity(key, "m") for key in optional if key in table.values}
    if name == "self-affine":
        values["hurst"] = table.quantity("hurst", "1", "0.8")
        values["seed"] = _whole(table, "seed", 0)
        values["periodic"] = _switch(table, "periodic", True)
    elif "scatter" in values:
        values["seed"] = _whole(table, "seed", 0)
    pixels = _whole(table, "pixels", None)
    return table.make(kind, pixels, table.quantity("pixel", "m", '"1 um"'), **values)


def _whole(table: Table, key: str, default: int | None) -> int:
    """Return a whole number, the default without the key."""
    table.known.add(key)
    given = table.get(key, "128") if default is None else table.values.get(key, default)
    if not isinstance(given, int) or isinstance(given, bool) or given < 0:
        raise InputError(f"{table.name} {key} must be a whole number, got {given!r}")
    return given


def _switch(table: Table, key: str, default: bool) -> bool:
    table.known.add(key)
    given = table.values.get(key, default)
    if not isinstance(given, bool):
        raise InputError(f"{table.name} {key} must be true or false, got {given!r}")
    return given
