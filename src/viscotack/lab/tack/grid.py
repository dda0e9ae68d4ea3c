"""Tables of tack tests: identify columns and convert their numbers to SI."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab import quantities
from viscotack.lab.columns import SAME_TEMPERATURE, Cells
from viscotack.lab.lab_file import LabFile
from viscotack.lab.quantities import (
    POSSIBLE,
    bare,
    kelvin,
    nearness_to_sample,
    no_unit,
    unit_within,
)
from viscotack.lab.tables import Table, heads, refuse_pooled, ruled

from .header import recorded
from .headings import POSITIONS, SIZES, factor, measures, recognise
from .record import TackRecord

_INTO = {"gap": -1, "depth": 1, "travel": 0}
_FLAGS, _LENGTH = {"force": "--force-unit", "time": "--time-unit"}, "--length-unit"
_OF_CAMERA = ("contact_radius", "contact_diameter", "contact_area")
_NEEDED = 20  # smallest number of rows needed to identify the parts of a test


@dataclass(frozen=True)
class Given:
    """Options of the caller, for files that lack the information."""

    force_unit: str | None = None
    length_unit: str | None = None
    time_unit: str | None = None
    force_column: str | None = None
    position_column: str | None = None
    time_column: str | None = None
    decimal: str | None = None
    nominal_speed: float | None = None
    spring_constant: float | None = None
    sensitivity: float | None = None
    temperature_in_name: bool = False
    where: str | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Headings given by the caller."""
        chosen = (self.force_column, self.position_column, self.time_column)
        return tuple(name.strip() for name in chosen if name)


def grid(
    file: LabFile,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[tuple[int, Sequence[str]]],
    label: str = "",
    temperature: float | None = None,
) -> Table:
    """Return a table; raise an error that names the first row of another length.

    `temperature` is stated above the table [K].
    """
    names, beside, chosen = ruled(file, headings, units, rows)
    return Table(
        tuple(name.strip('"').strip() for name in names),
        tuple(bare(unit.strip('"')) for unit in beside),
        chosen,
        temperature=temperature,
        label=label,
    )


def heads_columns(cells: Sequence[str], names: Sequence[str] = ()) -> bool:
    """Return whether a row heads force and position or time, or contains the given names."""
    if names and not all(map(str.isdecimal, names)):
        return heads(cells, names)
    named = {heading.quantity for heading in map(recognise, cells) if heading is not None}
    return "force" in named and bool(named & {*POSITIONS, "time"})


def record(file: LabFile, table: Table, given: Given, format: str, few: bool = False) -> TackRecord:
    """Return the record in a table; one of several intervals may have `few` rows.

    Raises
    ------
    ValueError
        If a column or unit is missing or ambiguous, or a cell is not a number.
    """
    notes: list[str] = []
    columns = _Columns(file, table, given, notes)
    force = columns.values("force", columns.the("force", given.force_column, ("force",)))
    kind, index = columns.position()
    position = columns.values(kind, index)
    time = None
    if (at := columns.optional("time", given.time_column)) is not None:
        time = columns.values("time", at)
    size, temperature = columns.size(), columns.temperature()
    columns.refuse_contradiction()
    # what differs along a test, such as its parts, is no state that is pooled
    rows_apart = range(len(table.rows))
    refuse_pooled(file, [table], [columns.in_use], [rows_apart])
    rows = [force, position, *([] if time is None else [time])]
    keep = np.all(np.isfinite(rows), axis=0)
    lost = int(np.sum(~keep))
    if lost:
        notes.append(f"{lost} rows without a number rejected")
    needed = 1 if few else _NEEDED
    if int(np.sum(keep)) < needed:
        raise file.error(
            f"{int(np.sum(keep))} rows with a force and a position; at least {needed} are needed"
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
        temperature=None if temperature is None else temperature[keep],
    )
    return found


def time_by_speed(file: LabFile, position: Array, given: Given, notes: list[str]) -> Array:
    """Compute the time [s] from the nominal speed given by the caller."""
    if given.nominal_speed is None:
        raise file.error(
            "there is no column of time, so the true speed is unknown; set "
            "--nominal-speed to use the set speed"
        )
    if not 0 < given.nominal_speed < np.inf:
        raise InputError(f"--nominal-speed must be positive, got {given.nominal_speed!r} m/s")
    notes.append("no column of time: computed from the nominal speed, which is not verified")
    way = np.abs(np.diff(position, prepend=position[0]))
    return np.cumsum(np.where(np.isfinite(way), way, 0.0)) / given.nominal_speed


class _Columns:
    """The columns of a table by quantity."""

    def __init__(self, file: LabFile, table: Table, given: Given, notes: list[str]):
        self.file, self.table, self.given, self.notes = file, table, given, notes
        self.units: dict[int, str] = {}
        # columns that are read, units of the caller that are needed, and those that contradict
        self.in_use: set[int] = set()
        self.needed: set[str] = set()
        self.contradicted: dict[str, str] = {}
        self.found: dict[str, list[int]] = {}
        for index, text in enumerate(table.headings):
            heading = recognise(text)
            if heading is None:
                continue
            unit = heading.unit or table.units[index]
            # instruments use the same heading for volts
            if measures(unit, heading.quantity):
                self.found.setdefault(heading.quantity, []).append(index)
                self.units[index] = unit
        self.cells = Cells(file, table, given.decimal, self.units, notes)

    def named(self, name: str) -> int:
        """Return the column whose heading or number (from 1) the caller gives."""
        wanted = name.strip().casefold()
        places = [i for i, text in enumerate(self.table.headings) if text.casefold() == wanted]
        if not places and wanted.isdecimal() and 0 < int(wanted) <= len(self.table.headings):
            places = [int(wanted) - 1]
        if not places:
            known = ", ".join(repr(text) for text in self.table.headings if text)
            raise self.file.error(f"no column has the heading {name!r}; the headings are {known}")
        return places[0]

    def the(self, word: str, name: str | None, quantities: tuple[str, ...]) -> int:
        """Return the single column of a quantity."""
        if name is not None:
            return self.named(name)
        places = [i for quantity in quantities for i in self.found.get(quantity, [])]
        if not places:
            known = ", ".join(repr(text) for text in self.table.headings if text)
            raise self.file.error(
                f"no column of {word} was recognised (headings: {known}); set --{word}-column NAME"
            )
        first = self.cells.numbers(places[0])
        for other in places[1:]:
            values = self.cells.numbers(other)
            if self.units[other] != self.units[places[0]] or not np.array_equal(
                values, first, equal_nan=True
            ):
                names = [self.table.headings[i] for i in (places[0], other)]
                raise self.file.error(
                    f'two columns of {word} were recognised: "{names[0]}" and "{names[1]}"; set '
                    f"--{word}-column NAME"
                )
        return places[0]

    def position(self) -> tuple[str, int]:
        """Return the kind of position in the file, and its column."""
        index = self.the("position", self.given.position_column, POSITIONS)
        heading = recognise(self.table.headings[index])
        kind = heading.quantity if heading and heading.quantity in POSITIONS else "travel"
        return kind, index

    def optional(self, quantity: str, name: str | None = None) -> int | None:
        """Return the column of a quantity, or None."""
        known = name is not None or quantity in self.found
        return self.the(quantity, name, (quantity,)) if known else None

    def size(self) -> Array | None:
        """Return the contact radius [m] from a column of radius, diameter or area, or None."""
        for quantity in SIZES:
            if (index := self.optional(quantity)) is not None:
                values = self.values(quantity, index)
                if quantity == "contact_diameter":
                    values = values / 2
                if quantity == "contact_area":
                    if np.any(values < 0):
                        raise self.file.error(
                            f"a contact area must not be negative, got {np.nanmin(values):g}"
                        )
                    values = np.sqrt(values / np.pi)
                return values
        return None

    def temperature(self) -> Array | None:
        """Return the temperature of each row [K], nan where unknown, or None if none is stated.

        Of several columns that differ, that of the sample is used. A column without a unit, or one
        that cannot be read, is left out, with a note.
        """
        headings = self.table.headings
        read: list[tuple[int, str, Array]] = []
        for index, unit in enumerate(self.table.units):
            one = quantities.recognise(headings[index], unit)
            if one is None or one.quantity != "temperature" or index in self.in_use:
                continue
            try:
                factor, offset = kelvin(bare(one.unit or unit))
                rows = self.cells.numbers(index) * factor + offset
            except InputError as error:
                self.notes.append(f"temperature not read: {error}")
                continue
            possible = (rows > POSSIBLE[0]) & (rows < POSSIBLE[1])
            if possible.any():
                read.append((index, headings[index], np.where(possible, rows, np.nan)))
        read.sort(key=lambda one: -nearness_to_sample(one[1]))
        for _, other, rows in read[1:]:
            apart = float(np.nanmax(np.abs(rows - read[0][2])))
            if apart <= SAME_TEMPERATURE:
                continue
            if nearness_to_sample(other) == nearness_to_sample(read[0][1]):
                self.notes.append(
                    f'temperature not read: "{read[0][1]}" and "{other}" differ by up to '
                    f"{apart:.3g} K"
                )
                return None
            self.notes.append(f'"{read[0][1]}" is the temperature, and "{other}" is not used')
        if read:
            return read[0][2]
        stated = self.table.temperature
        return None if stated is None else np.full(len(self.table.rows), stated)

    def refuse_contradiction(self) -> None:
        """Refuse a unit of the caller that no column needs and that the file contradicts."""
        for flag, said in self.contradicted.items():
            if flag not in self.needed:
                raise self.file.error(said)

    def values(self, quantity: str, index: int) -> Array:
        """Return a column in SI."""
        given = {"force": self.given.force_unit, "time": self.given.time_unit}
        said, flag = given.get(quantity, self.given.length_unit), _FLAGS.get(quantity, _LENGTH)
        text = self.table.headings[index]
        heading = recognise(text)
        unit = (heading and heading.unit) or self.table.units[index] or unit_within(text)
        self.in_use.add(index)
        if quantity == "time" and self.cells.is_clock(index):
            unit = "s"
        if no_unit(unit):
            unit = said or ""
            self.needed.add(flag)
        elif said is not None and quantity not in _OF_CAMERA:
            if not math.isclose(factor(said, quantity), factor(unit, quantity)):
                self.contradicted[flag] = (
                    f'the file states {unit} for "{text}", but {flag} is {said}'
                )
        if no_unit(unit):
            raise self.file.error(
                f'the column "{text}" has no unit; set {flag} or write it into the file'
            )
        try:
            return self.cells.numbers(index) * factor(unit, quantity)
        except InputError as error:
            if str(error).startswith(self.file.path):
                raise
            raise self.file.error(f'column "{self.table.headings[index]}": {error}') from None
