"""What the files of designs, windows and arrays share: tables, ranges, and contacts to be posed."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.model.problem import Problem
from viscotack.model.problem.case_file import case_of_tables
from viscotack.model.problem.nouns import known
from viscotack.model.problem.tables import Reading, refuse_named, refuse_unknown

# Between the ends of a range of numbers.
_TO = ".."


def opened(
    path: str | os.PathLike[str],
    names: Iterable[str],
    also: Iterable[Any],
    beside: Callable[[str], Path] | None,
    *,
    not_computed: Iterable[str],
) -> tuple[dict[str, Any], Reading]:
    """Return the tables of a TOML file, which have these names, and how their values are read."""
    path = Path(path)
    tables = read_toml(path)
    why = "contacts are pulled along their axis from a rigid plate or object"
    refuse_named(f"{path}", tables, not_computed, why)
    refuse_unknown(f"{path}", tables, names, "table")
    return tables, Reading(str(path), known(also), beside or path.parent.joinpath)


@contextmanager
def at(where: str) -> Iterator[None]:
    """Name the place in a file of an InputError."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{where} {error}") from None


def ends(value: Any, reading: Reading, unit: str, example: str = "") -> list[float]:
    """Return a quantity, or both ends of a range "1 mm..10 mm"."""
    parts = value.split(_TO, 1) if isinstance(value, str) else [value]
    return [reading.parsed(x.strip() if isinstance(x, str) else x, unit, example) for x in parts]


def contact(
    tables: Mapping[str, Any],
    name: str,
    reading: Reading,
    also: Iterable[Any],
    *,
    preload: float,
    speed: float,
    temperature: float | None = None,
) -> Problem:
    """Return the contact of a table that has the tables of a case file without its protocol."""
    table, path = tables.get(name), reading.where
    if not isinstance(table, Mapping):
        raise InputError(f"{path}: the table [{name}] is missing; write [{name}.material] and more")
    if "protocol" in table:
        raise InputError(f"{path}: [{name}.protocol] is stated by [pull]; remove it")
    protocol = {"preload_force": f"{preload!r} N", "speed": f"{speed!r} m/s"}
    return case_of_tables(
        {**table, "protocol": protocol},
        where=f"{path}, [{name}]",
        also=also,
        beside=reading.beside,
        temperature=temperature,
    )
