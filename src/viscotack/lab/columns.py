"""A table as a file has it, in text, and its columns as numbers in SI.

Every format is brought into this one shape first; what the words mean is decided here, once.
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .arrays import KINDS
from .doubts import doubtful_temperature
from .lab_file import LabFile
from .numbers import decimal_mark, half_digit, number, plain_numbers
from .quantities import (
    POSSIBLE,
    Heading,
    bare,
    in_kelvin,
    kelvin,
    kind_of_geometry,
    no_unit,
    radians_per_second,
    recognise,
    scale,
)

_UNITS = {
    "storage": "Pa",
    "loss": "Pa",
    "magnitude": "Pa",
    "modulus": "Pa",
    "stress": "Pa",
    "phase": "rad",
    "compliance": "1/Pa",
    "time": "s",
    "step_time": "s",
}


# what gives the unit of a column that has none
_FLAGS = {
    "Pa": "--modulus-unit Pa, kPa or MPa",
    "1/Pa": "--modulus-unit Pa, kPa or MPa, of the stress",
    "s": "--time-unit s or min",
}
_IN_FILE = "written in the heading or below it"
_HELD = 0.05  # of the level of a step; an instrument holds it better
_STATED = re.compile(r"([+-]?[0-9]+(?:[.,][0-9]*)?)\s*(°C|C|K|°F)")
_TEMPERATURE = re.compile(r"(?:[Tt]\s*=\s*)?([+-]?[0-9]+(?:\.[0-9]*)?)\s*(°C|ºC|oC|degC|C|K|°F)?")

Rows = tuple[tuple[int, tuple[str, ...]], ...]


@dataclass(frozen=True)
class Table:
    """Headings, units and rows of cells, as text.

    Parameters
    ----------
    headings, units : tuple of str
        One per column; an empty unit where the file gives none.
    rows : tuple of (int, tuple of str)
        Line number in the file and cells, as many as headings.
    words : str
        What the file says around the table: geometry, step name.
    temperature : float or None
        Temperature that the file states once for all rows [K].
    levels : dict of str to float
        What else the file states once for all rows: the step of ``strain`` [-] or ``stress`` [Pa].
    label : str
        What stands above the columns of one table beside others: a temperature, perhaps.
    notes : tuple of str
        What the layout decided.
    """

    headings: tuple[str, ...]
    units: tuple[str, ...]
    rows: Rows
    words: str = ""
    temperature: float | None = None
    notes: tuple[str, ...] = ()
    levels: Mapping[str, float] = field(default_factory=dict)
    label: str = ""


@dataclass(frozen=True)
class Units:
    """What the caller says where a file does not: units and the decimal mark."""

    frequency: str | None = None
    modulus: str | None = None
    time: str | None = None
    temperature: str | None = None
    decimal: str | None = None


def tabulated(
    file: LabFile,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[tuple[int, Sequence[str]]],
    **stated: Any,
) -> Table:
    """Return a table whose rows are as long as its headings, or say which row is not.

    `stated` are the other fields of :class:`Table`.
    """
    names, beside, chosen = ruled(file, headings, units, rows)
    given = [recognise(heading) for heading in names]
    # a row of units wins only where the heading itself has none
    own = [(heading and heading.unit) or unit for heading, unit in zip(given, beside, strict=True)]
    return Table(names, tuple(own), chosen, **stated)


def ruled(
    file: LabFile,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[tuple[int, Sequence[str]]],
) -> tuple[tuple[str, ...], tuple[str, ...], Rows]:
    """Return headings, units and rows of one length, or say which row is longer or shorter."""
    width = max((i + 1 for i, cell in enumerate(headings) if cell.strip()), default=0)
    chosen = []
    for line, cells in rows:
        cells = tuple(map(str.strip, cells))
        if len(cells) < width or any(cells[width:]):
            raise file.error(
                f"{len(cells)} cells where the headings have {width}; a cell is missing or added, "
                "or the file is cut",
                line,
            )
        chosen.append((line, cells[:width]))
    names = tuple(heading.strip() for heading in headings[:width])
    beside = [*(units or ()), *[""] * width][:width]
    return names, tuple(map(bare, beside)), tuple(chosen)


def first_headings(rows: Sequence[Sequence[str]]) -> int | None:
    """Return the index of the first row that names two or more quantities, or None.

    A row that begins with a label and a colon speaks of the test and heads no columns, unless two
    quantities follow.
    """
    for index, row in enumerate(rows):
        if row and row[0].rstrip().endswith(":"):
            row = row[1:]
        if len({heading.quantity for heading in map(recognise, row) if heading is not None}) >= 2:
            return index
    return None


def stated_temperature(rows: Iterable[Sequence[str]]) -> float | None:
    """Return the one temperature that lines above a table state [K], None for none or several.

    Examples
    --------
    >>> stated_temperature([["Temperature", "25 °C"]]), stated_temperature([["Temp: 300 K"]])
    (298.15, 300.0)
    """
    found = set()
    for row in rows:
        words = [cell.strip() for cell in row if cell.strip()]
        label, _, value = words[0].partition(":") if words else ("", "", "")
        if len(words) > 1:
            value = words[1]
        heading = recognise(label) if label else None
        match = _STATED.fullmatch(value.strip())
        if heading is None or heading.quantity != "temperature" or match is None:
            continue
        value = in_kelvin(float(match[1].replace(",", ".")), match[2])
        if POSSIBLE[0] < value < POSSIBLE[1]:
            found.add(value)
    return found.pop() if len(found) == 1 else None


class Columns:
    """The columns of one table that were recognised, as numbers in SI.

    Parameters
    ----------
    file : LabFile
        For the words of an error.
    table : Table
        What was read.
    units : Units
        What the caller says where the file does not.
    kind : {"E", "G"} or None
        Which modulus to take where the table has both.
    """

    def __init__(self, file: LabFile, table: Table, units: Units, kind: str | None = None):
        self.file, self.table, self.units = file, table, units
        self.notes: list[str] = list(table.notes)
        self._found: dict[str, list[tuple[int, Heading]]] = {}
        for index, text in enumerate(table.headings):
            heading = recognise(text)
            if heading is None or (kind and heading.kind and heading.kind != kind):
                continue
            self._found.setdefault(heading.quantity, []).append((index, heading))
        self.keep = np.ones(len(table.rows), dtype=bool)
        self._chosen: dict[str, tuple[int, Heading]] = {}
        used = [index for columns in self._found.values() for index, _ in columns]
        self._cells = Cells(file, table, units.decimal, used, self.notes)

    def __contains__(self, quantity: str) -> bool:
        return quantity in self._found

    def error(self, what: str, row: int | None = None) -> InputError:
        """Return an error that names the line of a row, or of the first row."""
        rows = self.table.rows
        line = rows[row][0] if row is not None else rows[0][0] if rows else None
        return self.file.error(what, line)

    def name(self, quantity: str) -> str:
        """Return the heading of a quantity as the file has it."""
        return self.table.headings[self._found[quantity][0][0]]

    def kind(self, *quantities: str) -> str | None:
        """Return the kind of modulus that headings, neighbours or words around the table say."""
        headings = [h for q in quantities for _, h in self._found.get(q, [])]
        said = {heading.kind for heading in headings} - {None}
        if len(said) > 1:
            raise self.error("one column is tensile (E), another one is shear (G); say --kind E|G")
        if said:
            return said.pop()
        known = [heading.kind for heading in map(recognise, self.table.headings) if heading]
        texts = (*self.table.headings, self.table.words)
        beside = {*known, *map(kind_of_geometry, texts)} - {None}
        kind = beside.pop() if len(beside) == 1 else None
        if kind is not None:
            word = KINDS[kind]
            self.notes.append(f"the words around the moduli speak of {word}, so kind is {kind!r}")
        return kind

    def numbers(self, quantity: str, *, needed: bool = True) -> Array:
        """Return a column in the unit of the file; a row without a needed number is left out."""
        index, _ = self._column(quantity)
        values = self._cells.numbers(index)
        if needed:
            self.keep &= ~np.isnan(values)
        return values

    def resolution(self, quantity: str) -> Array:
        """Return half a unit of the last digit written, in the unit of the file."""
        index, _ = self._column(quantity)
        return np.array([half_digit(cells[index]) for _, cells in self.table.rows])

    def has_unit(self, quantity: str) -> bool:
        """Return whether the file says in which unit a column is."""
        return not no_unit(self._unit(quantity))

    def held(self, quantity: str) -> npt.NDArray[np.bool_]:
        """Return in which rows a column is within 5 % of its level, the middle of its upper half.

        What lies below is the way to the step, or what came after it.
        """
        values = np.abs(self.numbers(quantity, needed=False))
        known = values[np.isfinite(values)]
        if not known.size or not known.max():
            return np.zeros(values.size, dtype=bool)
        level = np.median(known[known > 0.5 * known.max()])
        return np.abs(values - level) <= _HELD * level

    def lacking(self, *quantities: str) -> list[str]:
        """Return what neither file nor caller says about columns, each with the flag to say it."""
        found: dict[str, list[str]] = {}
        for quantity in quantities:
            if quantity not in self or not no_unit(self._unit(quantity)):
                continue
            target = _UNITS.get(quantity, "1")
            if quantity == "frequency":
                flag = "" if self.units.frequency else "--frequency-unit Hz or rad/s"
            elif quantity == "temperature":
                flag = "" if self.units.temperature else "--temperature-unit degC or K"
            else:
                flag = "" if target == "1" or self._said(target) else _FLAGS.get(target, _IN_FILE)
            if flag:
                found.setdefault(flag, []).append(f'"{self.name(quantity)}"')
        lacking = [f"the unit of {' and '.join(names)} ({flag})" for flag, names in found.items()]
        label = _TEMPERATURE.fullmatch(self.table.label.replace(",", "."))
        if "temperature" in quantities and label and not (label[2] or self.units.temperature):
            lacking.append(
                f"whether {self.table.label!r} above the columns is a temperature "
                "(--temperature-unit degC or K)"
            )
        return lacking

    def factor(self, quantity: str) -> float:
        """Return the factor that takes a column of moduli, times or pure numbers to SI."""
        target = _UNITS.get(quantity, "1")
        unit = self._unit(quantity)
        if no_unit(unit) and target != "1":
            unit = self._said(target)
        if no_unit(unit) and target != "1":
            flag = _FLAGS.get(target)
            cure = f"; say {flag} or write the unit" if flag else ""
            raise self.error(f'the column "{self.name(quantity)}" has no unit{cure}')
        try:
            return scale(unit, target)
        except ValueError as error:
            raise self._located(quantity, error) from None

    def si(self, quantity: str) -> Array:
        """Return a column of moduli, times or pure numbers in SI."""
        return self.factor(quantity) * self.numbers(quantity)

    def temperature(self) -> Array:
        """Return the temperature of each row [K]; nan where the file does not say."""
        if "temperature" not in self:
            stated = self.table.temperature if not self.table.label else self._labelled()
            return np.full(len(self.table.rows), math.nan if stated is None else stated)
        try:
            factor, offset = kelvin(self._temperature_unit())
        except ValueError as error:
            raise self._located("temperature", error) from None
        kelvins = self.numbers("temperature") * factor + offset
        for row in np.flatnonzero((kelvins <= POSSIBLE[0]) | (kelvins >= POSSIBLE[1])):
            raise self.error(f"a temperature of {kelvins[row]:g} K is not possible", int(row))
        self.notes += doubtful_temperature(kelvins, offset == 0.0)
        return kelvins

    def angular_frequency(self) -> Array:
        """Return 2 pi f [rad/s] of each row, from one column or from two that agree."""
        names = [name for name in ("angular_frequency", "frequency") if name in self]
        if len(names) == 2 and self.lacking("frequency"):
            names.pop()  # not needed, and it does not say what it is
        found = {name: self._angular(name) for name in names}
        if len(found) == 2:
            both = found["angular_frequency"], found["frequency"]
            for row in np.flatnonzero(np.abs(both[0] - both[1]) > 0.01 * np.abs(both[0])):
                raise self.error(
                    f'"{self.name("angular_frequency")}" is {both[0][row]:g} rad/s but '
                    f'"{self.name("frequency")}" makes {both[1][row]:g} rad/s',
                    int(row),
                )
        omega = next(iter(found.values()))
        for row in np.flatnonzero(omega <= 0):
            raise self.error(f"a frequency must be positive, got {omega[row]:g} rad/s", int(row))
        return omega

    def _angular(self, name: str) -> Array:
        unit, said = self._unit(name), self.units.frequency
        angular = name == "angular_frequency"
        if no_unit(unit) and said is None and angular:
            self.notes.append(f'"{self.name(name)}" has no unit and is taken in rad/s')
            return self.numbers(name)
        try:
            if said is None:
                factor = radians_per_second(unit, angular=angular)
            else:
                factor = own = radians_per_second(said, angular="rad" in said)
                if not no_unit(unit):
                    with suppress(ValueError):  # where the file is ambiguous the caller decides
                        own = radians_per_second(unit, angular=angular)
                if not math.isclose(own, factor):
                    raise InputError(f"the file says {bare(unit)}, --frequency-unit says {said}")
        except ValueError as error:
            raise self._located(name, error) from None
        return self.numbers(name) * factor

    def _temperature_unit(self) -> str:
        unit = self._unit("temperature")
        if no_unit(unit) and self.units.temperature is None:
            raise InputError("no unit; say --temperature-unit degC or K, or write it")
        return (self.units.temperature or "") if no_unit(unit) else unit

    def _labelled(self) -> float:
        """Return the temperature that stands above the columns of this table [K]."""
        text = self.table.label
        match = _TEMPERATURE.fullmatch(text.replace(",", "."))
        if match is None:
            raise self.error(
                f"{text!r} above the columns is no temperature; expected such as '20 °C'"
            )
        # a label without a unit was refused by `lacking`
        value = in_kelvin(float(match[1]), match[2] or self.units.temperature or "")
        if not POSSIBLE[0] < value < POSSIBLE[1]:
            raise self.error(f"a temperature of {value:g} K is not possible")
        return value

    def _said(self, target: str) -> str:
        """Return the unit that the caller gives for columns without one."""
        if target == "Pa":
            return self.units.modulus or ""
        if target == "1/Pa" and self.units.modulus:
            return f"1/({bare(self.units.modulus)})"
        return self.units.time or "" if target == "s" else ""

    def _column(self, quantity: str) -> tuple[int, Heading]:
        """Return the one column of a quantity; of several, the first, if all say the same."""
        if quantity not in self._chosen:
            first, *others = self._found[quantity]
            for other in others:
                self._refuse_other(quantity, first, other)
            self._chosen[quantity] = first
        return self._chosen[quantity]

    def _refuse_other(
        self, quantity: str, first: tuple[int, Heading], other: tuple[int, Heading]
    ) -> None:
        names = [self.table.headings[index] for index, _ in (first, other)]
        kinds = {heading.kind for _, heading in (first, other)} - {None}
        units = {bare(heading.unit or self.table.units[index]) for index, heading in (first, other)}
        if len(kinds) < 2 and len(units) == 1:
            values = [self._cells.numbers(index) for index, _ in (first, other)]
            # a temperature is in degrees, where one percent of the number means nothing
            slack = 0.5 if quantity == "temperature" else 0.01 * np.abs(values[0])
            if np.all((np.abs(values[0] - values[1]) <= slack) | np.isnan(values[0])):
                self.notes.append(f'of two columns that say the same, "{names[0]}" is used')
                return
        cure = "say --kind E or --kind G" if len(kinds) > 1 else "keep one of them"
        raise self.error(f'two columns of one quantity: "{names[0]}" and "{names[1]}"; {cure}')

    def _unit(self, quantity: str) -> str:
        index, heading = self._column(quantity)
        return heading.unit or self.table.units[index]

    def _located(self, quantity: str, error: ValueError) -> ValueError:
        text = str(error)
        if text.startswith(self.file.path):
            return error
        return self.error(f'column "{self.name(quantity)}": {text}')


class Cells:
    """Cells of a table as numbers, with one decimal mark for all columns that are used.

    Parameters
    ----------
    file, table
        Where the cells stand.
    decimal : str or None
        Decimal mark that the caller says.
    used : iterable of int
        Columns that were recognised.
    notes : list of str
        To which a decimal comma is added.
    """

    def __init__(
        self,
        file: LabFile,
        table: Table,
        decimal: str | None,
        used: Iterable[int],
        notes: list[str],
    ):
        self._file, self._table, self._used, self._notes = file, table, list(used), notes
        self._said, self._found = decimal, ""

    def numbers(self, index: int) -> Array:
        """Return a column in the unit of the file; nan for gaps."""
        rows = self._table.rows
        cells = [cells[index] for _, cells in rows]
        values = plain_numbers(cells)
        if values is not None and self._said != ",":
            return values
        mark = self._mark()
        values = np.empty(len(cells))
        for row, text in enumerate(cells):
            try:
                values[row] = number(text, mark)
            except ValueError as error:
                name = self._table.headings[index]
                raise self._file.error(f'column "{name}": {error}', rows[row][0]) from None
        return values

    def _mark(self) -> str:
        if self._said is not None:
            return self._said
        if not self._found:
            cells = [cells[index] for _, cells in self._table.rows for index in self._used]
            try:
                self._found = decimal_mark(cells)
            except ValueError as error:
                raise self._file.error(str(error), self._table.rows[0][0]) from None
            self._notes += ["decimal comma"] * (self._found == ",")
        return self._found
