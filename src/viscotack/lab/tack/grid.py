"""Tables of tack tests: which column is what, and its numbers in SI."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.columns import Cells, Table, ruled
from viscotack.lab.lab_file import LabFile
from viscotack.lab.quantities import bare, no_unit

from .header import recorded
from .headings import POSITIONS, SIZES, factor, measures, recognise
from .record import TackRecord

_INTO = {"gap": -1, "depth": 1, "travel": 0}
_FLAGS = {"force": "--force-unit", "time": "--time-unit"}
_NEEDED = 20  # rows; with fewer no part of a test can be told from another


@dataclass(frozen=True)
class Given:
    """What the caller says where a file does not."""

    force_unit: str | None = None
    length_unit: str | None = None
    time_unit: str | None = None
    force_column: str | None = None
    position_column: str | None = None
    decimal: str | None = None
    nominal_speed: float | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The headings that the caller names."""
        return tuple(name for name in (self.force_column, self.position_column) if name)


def grid(
    file: LabFile,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[tuple[int, Sequence[str]]],
    label: str = "",
) -> Table:
    """Return a table whose rows are as long as its headings, or say which row is not."""
    names, beside, chosen = ruled(file, headings, units, rows)
    return Table(
        tuple(name.strip('"').strip() for name in names),
        tuple(bare(unit.strip('"')) for unit in beside),
        chosen,
        label=label,
    )


def heads_columns(cells: Sequence[str], names: Sequence[str] = ()) -> bool:
    """Return whether a row names a force and a position or a time, or holds the names given."""
    if names:
        held = {cell.strip().strip('"').strip().casefold() for cell in cells}
        return all(name.strip().casefold() in held for name in names)
    named = {heading.quantity for heading in map(recognise, cells) if heading is not None}
    return "force" in named and bool(named & {*POSITIONS, "time"})


def record(file: LabFile, table: Table, given: Given, format: str, few: bool = False) -> TackRecord:
    """Return the record that a table holds; one of several intervals may be of `few` rows.

    Raises
    ------
    ValueError
        If a column or unit is missing or not the only one, or a cell holds no number.
    """
    notes: list[str] = []
    columns = _Columns(file, table, given, notes)
    force = columns.values("force", columns.the("force", given.force_column, ("force",)))
    kind, index = columns.position()
    position = columns.values(kind, index)
    time = None
    if (at := columns.optional("time")) is not None:
        time = columns.values("time", at)
    size = columns.size()
    rows = [force, position, *([] if time is None else [time])]
    keep = np.all(np.isfinite(rows), axis=0)
    lost = int(np.sum(~keep))
    if lost:
        notes.append(f"{lost} rows without a number left out")
    needed = 1 if few else _NEEDED
    if int(np.sum(keep)) < needed:
        raise file.error(
            f"{int(np.sum(keep))} rows with a force and a position; a test needs {needed}"
        )
    if time is None:
        time = time_by_speed(file, position, given, notes)
    (found,) = recorded(
        file,
        format,
        notes,
        (time[keep], force[keep], position[keep]),
        into=_INTO[kind],
        contact_radius=None if size is None else size[keep],
    )
    return found


def time_by_speed(file: LabFile, position: Array, given: Given, notes: list[str]) -> Array:
    """Return the time [s] of a record without one, by the nominal speed that the caller says."""
    if given.nominal_speed is None:
        raise file.error(
            "there is no column of time, so that the true speed cannot be known; say "
            "--nominal-speed to take the one that was set"
        )
    if not 0 < given.nominal_speed < np.inf:
        raise InputError(f"--nominal-speed must be positive, got {given.nominal_speed!r} m/s")
    notes.append("no column of time: it is reckoned with the nominal speed, which is not checked")
    way = np.abs(np.diff(position, prepend=position[0]))
    return np.cumsum(np.where(np.isfinite(way), way, 0.0)) / given.nominal_speed


class _Columns:
    """The columns of a table by their meaning."""

    def __init__(self, file: LabFile, table: Table, given: Given, notes: list[str]):
        self.file, self.table, self.given, self.notes = file, table, given, notes
        self.units: dict[int, str] = {}
        self.found: dict[str, list[int]] = {}
        for index, text in enumerate(table.headings):
            heading = recognise(text)
            if heading is None:
                continue
            unit = heading.unit or table.units[index]
            # instruments write the same word over volts
            if measures(unit, heading.quantity):
                self.found.setdefault(heading.quantity, []).append(index)
                self.units[index] = unit
        self.cells = Cells(file, table, given.decimal, self.units, notes)

    def named(self, name: str) -> int:
        """Return the column with a heading that the caller names."""
        wanted = name.strip().casefold()
        places = [i for i, text in enumerate(self.table.headings) if text.casefold() == wanted]
        if not places:
            known = ", ".join(repr(text) for text in self.table.headings if text)
            raise self.file.error(f"no column is named {name!r}; the columns are {known}")
        return places[0]

    def the(self, word: str, name: str | None, quantities: tuple[str, ...]) -> int:
        """Return the one column of a quantity."""
        if name is not None:
            return self.named(name)
        places = [i for quantity in quantities for i in self.found.get(quantity, [])]
        if not places:
            known = ", ".join(repr(text) for text in self.table.headings if text)
            raise self.file.error(
                f"no column is a {word} (the columns are {known}); say --{word}-column NAME"
            )
        first = self.cells.numbers(places[0])
        for other in places[1:]:
            values = self.cells.numbers(other)
            if self.units[other] != self.units[places[0]] or not np.array_equal(
                values, first, equal_nan=True
            ):
                names = [self.table.headings[i] for i in (places[0], other)]
                raise self.file.error(
                    f'two columns are a {word}: "{names[0]}" and "{names[1]}"; say '
                    f"--{word}-column NAME"
                )
        return places[0]

    def position(self) -> tuple[str, int]:
        """Return which kind of position the file has, and its column."""
        index = self.the("position", self.given.position_column, POSITIONS)
        heading = recognise(self.table.headings[index])
        kind = heading.quantity if heading and heading.quantity in POSITIONS else "travel"
        return kind, index

    def optional(self, quantity: str) -> int | None:
        """Return the column of a quantity, None without one."""
        return self.the(quantity, None, (quantity,)) if quantity in self.found else None

    def size(self) -> Array | None:
        """Return the contact radius [m] where a radius, a diameter or an area stands there."""
        for quantity in SIZES:
            if (index := self.optional(quantity)) is not None:
                values = self.values(quantity, index)
                if quantity == "contact_diameter":
                    values = values / 2
                if quantity == "contact_area":
                    if np.any(values < 0):
                        raise self.file.error(f"a contact area is negative: {np.nanmin(values):g}")
                    values = np.sqrt(values / np.pi)
                return values
        return None

    def values(self, quantity: str, index: int) -> Array:
        """Return a column in SI."""
        said = {"force": self.given.force_unit, "time": self.given.time_unit}
        unit = self.units.get(index, self.table.units[index])
        if heading := recognise(self.table.headings[index]):
            unit = heading.unit or unit
        if no_unit(unit):
            unit = said.get(quantity, self.given.length_unit) or ""
        if no_unit(unit):
            flag = _FLAGS.get(quantity, "--length-unit")
            raise self.file.error(
                f'the column "{self.table.headings[index]}" has no unit; say {flag} or write it'
            )
        try:
            return self.cells.numbers(index) * factor(unit, quantity)
        except InputError as error:
            if str(error).startswith(self.file.path):
                raise
            raise self.file.error(f'column "{self.table.headings[index]}": {error}') from None
