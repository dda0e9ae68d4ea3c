"""Read a rough surface and its test from a TOML file.

The tables [material], [interface], [protocol] and perhaps [layer] are those of a case file; the
table [surface] names a file of heights or states a generated map.
"""

import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.problem.case_file import parts_of_tables
from viscotack.problem.case_table import Table, refuse_unknown
from viscotack.problem.rough_case import KINDS, RoughCase, StatedSurface, hash_of

from .problem import RoughProblem

_TABLES = ("surface", "material", "interface", "protocol", "layer")
_TOML = (".toml", "")


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
    case = read_rough_case(path, also=also, beside=beside)
    try:
        return problem_of(case)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def read_rough_case(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> RoughCase:
    """Read a rough surface and its test as they are stated, without making the map.

    The parameters are those of :func:`read_rough`. A measured map is stated by its file and hash.
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
    return RoughCase(surface=_surface(Table(path, "surface", tables, beside)), **parts)


def problem_of(case: RoughCase) -> RoughProblem:
    """Return the problem that is stated, with its map of heights."""
    return RoughProblem(
        surface=case.surface.map(),
        material=case.material,
        traction=case.traction,
        protocol=case.protocol,
        body=case.body,
    )


def _surface(table: Table) -> StatedSurface:
    """Return the surface stated by the table [surface]; several generated maps may be added."""
    given: dict[str, Any] = {}
    if "file" in table.values:
        file = table.beside("file", '"scan.npy"').resolve()
        given |= {"file": str(file), "sha256": hash_of(file)}
        names = ("pixel", "height_unit")
    else:
        kinds = table.get("kind", '"self-affine"')
        kinds = kinds if isinstance(kinds, list) else [kinds]
        if not kinds or any(kind not in KINDS for kind in kinds):
            raise InputError(f"{table.name} kind must be one of {', '.join(KINDS)}, got {kinds!r}")
        given["kind"] = tuple(kinds)
        needed = {"pixels", "pixel", *(name for kind in kinds for name in KINDS[kind][1])}
        names = (*needed, *(name for kind in kinds for name in KINDS[kind][2]))
        stated = cards(StatedSurface)
        table.require(stated[name] for name in stated if name in needed)
        for name in stated:
            if name in needed:
                table.get(name)
    if "file" in given or "self-affine" in given["kind"]:
        given["periodic"] = _switch(table, "periodic")
    given["level"] = bool(_switch(table, "level"))
    given["remove_curvature"] = bool(_switch(table, "remove_curvature"))
    table.known |= set(names)
    given |= {
        name: table.number(field)
        for name, field in cards(StatedSurface).items()
        if name in names and name in table.values
    }
    table.finish()
    return table.make(partial(StatedSurface, **given))


def _switch(table: Table, key: str) -> bool | None:
    table.known.add(key)
    given = table.values.get(key)
    if given is not None and not isinstance(given, bool):
        raise InputError(f"{table.name} {key} must be true or false, got {given!r}")
    return given
