"""A table as a file has it, in text, and its columns as numbers in SI.

Every format is brought into this one shape first; what the words mean is decided here, once.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from .arrays import KINDS
from .lab_file import LabFile
from .numbers import decimal_mark, half_digit, number
from .quantities import (
    Heading,
    bare,
    kelvin,
    kind_of_geometry,
    no_unit,
    radians_per_second,
    recognise,
    scale,
)

Array = npt.NDArray[np.float64]

_UNITS = {
    "storage": "Pa",
    "loss": "Pa",
    "magnitude": "Pa",
    "modulus": "Pa",
    "stress": "Pa",
    "compliance": "1/Pa",
    "time": "s",
    "step_time": "s",
}


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
    notes : tuple of str
        What the layout decided.
    """

    headings: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    words: str = ""
    temperature: float | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Units:
    """What the caller says where a file does not: units and the decimal mark."""

    frequency: str | None = None
    modulus: str | None = None
    decimal: str | None = None


def tabulated(
    file: LabFile,
    headings: Sequence[str],
    units: Sequence[str] | None,
    rows: Iterable[tuple[int, Sequence[str]]],
    *,
    words: str = "",
    temperature: float | None = None,
    notes: tuple[str, ...] = (),
) -> Table:
    """Return a table whose rows are as long as its headings, or say which row is not."""
    width = _width(headings)
    chosen = []
    for line, cells in rows:
        cells = tuple(cell.strip() for cell in cells)
        if _width(cells) > width or len(cells) < width:
            raise file.error(
                f"{len(cells)} cells where the headings have {width}; a cell is missing or added, "
                "or the file is cut",
                line,
            )
        chosen.append((line, cells[:width]))
    given = [recognise(heading) for heading in headings[:width]]
    own = [heading.unit if heading else "" for heading in given]
    if units is not None:
        # a row of units wins only where the heading itself has none
        beside = [*units, *[""] * width][:width]
        own = [mine or bare(theirs) for mine, theirs in zip(own, beside, strict=True)]
    names = tuple(heading.strip() for heading in headings[:width])
    return Table(names, tuple(own), tuple(chosen), words, temperature, notes)


def first_headings(rows: Sequence[Sequence[str]]) -> int | None:
    """Return the index of the first row that names two or more quantities, or None."""
    for index, row in enumerate(rows):
        if len({heading.quantity for heading in map(recognise, row) if heading is not None}) >= 2:
            return index
    return None


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
        self._found: dict[str, tuple[int, Heading]] = {}
        for index, text in enumerate(table.headings):
            heading = recognise(text)
            if heading is None or (kind and heading.kind and heading.kind != kind):
                continue
            if heading.quantity in self._found:
                other = table.headings[self._found[heading.quantity][0]]
                cure = "give kind='E' or 'G'" if heading.kind else "keep one of them"
                raise self.error(f'two columns of one quantity: "{other}" and "{text}"; {cure}')
            self._found[heading.quantity] = index, heading
        self.keep = np.ones(len(table.rows), dtype=bool)
        self._decimal = self._mark()

    def __contains__(self, quantity: str) -> bool:
        return quantity in self._found

    def error(self, what: str, row: int | None = None) -> ValueError:
        """Return an error that names the line of a row, or of the first row."""
        rows = self.table.rows
        line = rows[row][0] if row is not None else rows[0][0] if rows else None
        return self.file.error(what, line)

    def name(self, quantity: str) -> str:
        """Return the heading of a quantity as the file has it."""
        return self.table.headings[self._found[quantity][0]]

    def kind(self, *quantities: str) -> str | None:
        """Return the kind of modulus that headings, neighbours or words around the table say."""
        said = {self._found[q][1].kind for q in quantities if q in self._found} - {None}
        if len(said) > 1:
            raise self.error("one column is tensile (E), another one is shear (G); give kind=")
        for kind in said:
            return kind
        beside = {
            heading.kind
            for heading in map(recognise, self.table.headings)
            if heading is not None and heading.kind
        } | {kind_of_geometry(text) for text in (*self.table.headings, self.table.words)}
        beside -= {None}
        if len(beside) != 1:
            return None
        for kind in beside:
            word = KINDS.get(kind or "")
            self.notes.append(f"the words around the moduli speak of {word}, so kind is {kind!r}")
            return kind

    def numbers(self, quantity: str, *, needed: bool = True) -> Array:
        """Return a column in the unit of the file; a row without a needed number is left out."""
        index = self._found[quantity][0]
        values = np.empty(len(self.table.rows))
        for row, (_, cells) in enumerate(self.table.rows):
            values[row] = self._number(cells[index], row, quantity)
        if needed:
            self.keep &= ~np.isnan(values)
        return values

    def resolution(self, quantity: str) -> Array:
        """Return half a unit of the last digit written, in the unit of the file."""
        index = self._found[quantity][0]
        return np.array([half_digit(cells[index]) for _, cells in self.table.rows])

    def factor(self, quantity: str) -> float:
        """Return the factor that takes a column of moduli, times or pure numbers to SI."""
        target = _UNITS.get(quantity, "1")
        unit = self._unit(quantity)
        if no_unit(unit) and target == "Pa" and self.units.modulus:
            unit = self.units.modulus
        if no_unit(unit) and target != "1":
            cure = "; give modulus_unit= or a unit in the file" if target == "Pa" else ""
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
            stated = self.table.temperature
            return np.full(len(self.table.rows), math.nan if stated is None else stated)
        try:
            factor, offset = kelvin(self._unit("temperature"))
        except ValueError as error:
            raise self._located("temperature", error) from None
        kelvins = self.numbers("temperature") * factor + offset
        for row in np.flatnonzero(~((kelvins > 0) & (kelvins < 3000) | np.isnan(kelvins))):
            raise self.error(f"a temperature of {kelvins[row]:g} K is not possible", int(row))
        return kelvins

    def angular_frequency(self) -> Array:
        """Return 2 pi f [rad/s] of each row, from one column or from two that agree."""
        found = {
            name: self._angular(name) for name in ("angular_frequency", "frequency") if name in self
        }
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
        unit = self._unit(name)
        angular = name == "angular_frequency"
        said = self.units.frequency
        try:
            if said is not None:
                factor = radians_per_second(said, angular="rad" in said)
                try:
                    own = factor if no_unit(unit) else radians_per_second(unit, angular=angular)
                except ValueError:
                    own = factor  # the file is ambiguous: the caller decides
                if not math.isclose(own, factor):
                    raise InputError(f"the file says {bare(unit)}, frequency_unit says {said}")
            elif no_unit(unit):
                raise InputError("no unit; give frequency_unit='Hz' or 'rad/s', or write it")
            else:
                factor = radians_per_second(unit, angular=angular)
        except ValueError as error:
            raise self._located(name, error) from None
        return self.numbers(name) * factor

    def _unit(self, quantity: str) -> str:
        index, heading = self._found[quantity]
        return heading.unit or self.table.units[index]

    def _located(self, quantity: str, error: ValueError) -> ValueError:
        text = str(error)
        if text.startswith(self.file.path):
            return error
        return self.error(f'column "{self.name(quantity)}": {text}')

    def _number(self, text: str, row: int, quantity: str) -> float:
        try:
            return number(text, self._decimal)
        except ValueError as error:
            raise self.error(f'column "{self.name(quantity)}": {error}', row) from None

    def _mark(self) -> str:
        """Return the decimal mark, from the numbers of the columns that are read."""
        if self.units.decimal is not None:
            return self.units.decimal
        rows, indices = self.table.rows, [index for index, _ in self._found.values()]
        try:
            mark = decimal_mark(cells[index] for _, cells in rows for index in indices)
        except ValueError as error:
            raise self.error(str(error)) from None
        self.notes += ["decimal comma"] * (mark == ",")
        return mark


def _width(cells: Sequence[str]) -> int:
    """Return the number of cells up to the last one that is not empty."""
    return max((i + 1 for i, cell in enumerate(cells) if cell.strip()), default=0)
