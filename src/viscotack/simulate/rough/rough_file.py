"""Read a rough surface and its test from a TOML file.

The tables [material], [interface], [protocol] and perhaps [layer] are those of a case file; the
table [surface] names a file of heights or states a generated map.
"""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, cast

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.model.problem import case_file
from viscotack.model.problem.nouns import known
from viscotack.model.problem.rough_case import RoughCase
from viscotack.model.tables import Reading

from .problem import RoughProblem

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
    if "surface" not in tables:
        raise InputError(f"{path}: the table [surface] is missing; see docs/rough_surfaces.md")
    reading = Reading(str(path), known(also), beside or path.parent.joinpath)
    return cast(RoughCase, case_file.problem_of(tables, reading))


def problem_of(case: RoughCase) -> RoughProblem:
    """Return the problem that is stated, with its map of heights."""
    return RoughProblem(
        surface=case.surface.map(),
        material=case.material,
        traction=case.traction,
        protocol=case.protocol,
        body=case.body,
    )
