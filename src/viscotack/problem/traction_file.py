"""The table [interface] of a case file, and the flag for the same: a traction law in words."""

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, Protocol

from viscotack.files.quantities import read_quantities
from viscotack.traction import LAWS, Tabulated, Traction
from viscotack.units import finite, positive


class Table(Protocol):
    """What a table of a case file offers, with errors that name file, table and key."""

    path: Path
    name: str
    values: Mapping[str, Any]

    def get(self, key: str) -> Any: ...  # noqa: D102
    def quantity(self, key: str, unit: str) -> float: ...  # noqa: D102
    def word(self, key: str, allowed: Iterable[str]) -> str: ...  # noqa: D102
    def make(self, kind: Any, *value: Any, **values: Any) -> Any: ...  # noqa: D102


def law_from_table(table: Table) -> Traction:
    """Return the law of the table [interface]; its range by equilibrium_gap or by strength."""
    kind: Any = LAWS[table.word("law", LAWS)]
    if kind is Tabulated:
        return _tabulated(table.path.parent / str(table.get("file")))
    constants = {
        constant.name: table.quantity(constant.name, "1")
        for constant in _constants(kind)
        if constant.default is MISSING or constant.name in table.values
    }
    work = table.quantity("work_of_adhesion", "J/m^2")
    if "strength" not in table.values:
        gap = table.quantity("equilibrium_gap", "m")
    elif "equilibrium_gap" in table.values:
        raise ValueError(f"{table.name} strength and equilibrium_gap say the same; leave out one")
    else:
        strength = table.make(positive, "strength", table.quantity("strength", "Pa"), "Pa")
        gap = table.make(kind, 1.0, 1.0, **constants).strength * work / strength
    return table.make(kind, work_of_adhesion=work, equilibrium_gap=gap, **constants)


def law_from_words(words: str) -> Traction:
    """Return the reduced law that a flag states: its name and, after a colon, what it needs.

    Examples
    --------
    >>> law_from_words("exponential:0.25")
    Exponential(work_of_adhesion=1.0, equilibrium_gap=1.0, decay=0.25)
    >>> law_from_words("dugdale").strength
    1.0
    """
    name, _, rest = words.partition(":")
    if name not in LAWS:
        raise ValueError(f"the law must be one of {', '.join(LAWS)}, got {words!r}")
    kind: Any = LAWS[name]
    if kind is Tabulated:
        if not rest:
            raise ValueError("a law of the kind table needs its file: table:FILE.csv")
        return _tabulated(rest).reduced()
    constants = [constant.name for constant in _constants(kind)]
    needed = [constant.name for constant in _constants(kind) if constant.default is MISSING]
    given = rest.split(",") if rest else []
    if not len(needed) <= len(given) <= len(constants):
        wanted = ",".join(constant.upper() for constant in constants)
        raise ValueError(f"write {name}{':' if wanted else ''}{wanted}, got {words!r}")
    values = {
        constant: finite(constant, text, "1")
        for constant, text in zip(constants, given, strict=False)
    }
    return kind(1.0, 1.0, **values)


def _constants(kind: Any) -> list[Any]:
    """Return the fields of a law beside its work and gap; all are pure numbers."""
    return [x for x in fields(kind) if x.name not in ("work_of_adhesion", "equilibrium_gap")]


def _tabulated(path: str | Path) -> Tabulated:
    columns = read_quantities(path, {"gap": "m", "traction": "Pa"})
    try:
        return Tabulated.of_points(columns["gap"], columns["traction"])
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
