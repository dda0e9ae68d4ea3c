"""The recognised columns of a table as numbers in SI; only this module interprets units."""

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cached_property
from typing import Any, SupportsIndex

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.options import UNIT_OPTIONS, FileOptions, Options
from viscotack.lab.sweeps import KINDS

from . import numbers
from .file import LabFile
from .headings import (
    MATERIAL,
    POSSIBLE,
    UNITS,
    WORDS,
    Heading,
    Vocabulary,
    bare,
    in_kelvin,
    is_clock_unit,
    kelvin,
    kind_of_geometry,
    nearness_to_sample,
    no_unit,
    plain,
    possible,
    radians_per_second,
    recognise,
    same_unit,
    scale,
    unit_within,
)
from .tables import Table


def _cure(target: str) -> str:
    """Return how a caller states the unit of a column without one."""
    if target not in UNIT_OPTIONS:
        return "write it in the heading or below it"
    name, examples = UNIT_OPTIONS[target]
    return f"set `{name}` to {examples}"


# largest differences of two columns of one quantity: of temperatures [K], of others relative
_SAME_TEMPERATURE, _SAME = 0.5, 0.01
_LARGEST_POWER = 100.0  # of a logarithm
_HELD = 0.05  # relative to the level of a step; instruments hold it better than this
_TEMPERATURE = re.compile(r"(?:[Tt]\s*=\s*)?([+-]?[0-9]+(?:\.[0-9]*)?)\s*(°C|ºC|oC|degC|C|K|°F)?")
# headings that tell one sample, or one place or state of a sample, from another
_SAMPLE, _PLACE = (
    re.compile(
        f"({'|'.join(WORDS['apart'][what].split())})({'|'.join(WORDS['apart']['ending'].split())})?"
    )
    for what in ("sample", "place")
)
_STATUS = re.compile("status|statut|comment|kommentar|remark|bemerkung|date|datum|time$|zeit$")
# index and meaning of a column
_Place = tuple[int, Heading]


class Columns:
    """The recognised columns of one table, as numbers in SI.

    Parameters
    ----------
    file : LabFile
        Used in error messages.
    table : Table
        The table that was read.
    options : FileOptions
        Statements of the caller: columns and units.
    words : Vocabulary
        Meaning of headings.
    """

    def __init__(self, file: LabFile, table: Table, options: FileOptions, words: Vocabulary):
        self.file, self.table, self.options, self.words = file, table, options, words
        self.notes: list[str] = list(table.notes)
        said = self._chosen_by_caller()
        # columns chosen by the caller that the table lacks
        self.lost = {one.name for what, one in options.chosen.items() if what not in said}
        self._found = {name: [at] for name, at in said.items()}
        chosen = {index for index, _ in said.values()}
        for index, text in enumerate(table.headings):
            heading = words.recognise(text, table.units[index])
            if heading is None or heading.quantity in options.chosen:
                continue
            # a column that the caller names for a purpose has no other one
            if heading.quantity == "temperature" and index in chosen:
                continue
            # instruments head columns of waves and temperatures that they did not measure
            if table.rows and not any(row[index] for _, row in table.rows):
                continue
            kind = getattr(options, "kind", None)
            if not (kind and heading.kind and heading.kind != kind):
                self._found.setdefault(heading.quantity, []).append((index, heading))
        self.keep = np.ones(len(table.rows), dtype=bool)
        # of each row: what was measured, such as temperature and frequency; set by the reader
        self.states: Sequence[Any] = ()
        self._chosen: dict[str, _Place] = {}

    def _chosen_by_caller(self) -> dict[str, _Place]:
        """Return the columns that the caller names by heading or number, if the table has them."""
        found: dict[str, _Place] = {}
        names = [text.casefold() for text in self.table.headings]
        for quantity, (name, unit) in self.options.chosen.items():
            if name.casefold() in names:
                index = names.index(name.casefold())
            elif name.isdecimal() and 0 < int(name) <= len(names):
                index = int(name) - 1
            else:
                continue
            text = self.table.headings[index]
            taken = [other for other, (at, _) in found.items() if at == index]
            if taken:
                raise self.error(f'"{text}" is chosen as {taken[0]} and as {quantity}')
            heading = self.words.recognise(text, self.table.units[index])
            own = (heading and heading.unit) or self.table.units[index] or unit_within(text)
            if unit and own and not same_unit(own, unit):
                raise self.error(f'the file states {own} for "{text}", but `columns` {unit}')
            kind, base = (heading.kind, heading.base) if heading else (None, None)
            found[quantity] = index, Heading(quantity, kind, own or unit, base)
        return found

    @property
    def columns_in_use(self) -> set[int]:
        """Indices of the columns with a meaning."""
        return {index for columns in self._found.values() for index, _ in columns}

    def __contains__(self, quantity: str) -> bool:
        return quantity in self._found

    def error(self, what: str, row: SupportsIndex | None = None) -> InputError:
        """Return an error that names the line of a row, by default of the first row."""
        rows = self.table.rows
        return self.file.error(what, rows[0 if row is None else row][0] if rows else None)

    def name(self, quantity: str) -> str:
        """Return the heading of a quantity as written in the file."""
        return self.table.headings[self._found[quantity][0][0]]

    # ---- numbers in the unit of the file -----------------------------------------------------

    def numbers(self, quantity: str, *, needed: bool = True) -> Array:
        """Return a column in the unit of the file; rows without a needed number are rejected."""
        index, heading = self._column(quantity)
        values = self._numbers(index)
        if heading.base is not None:
            self.notes.append(f'"{self.name(quantity)}": the logarithm is undone')
            for row in np.flatnonzero(np.abs(values) > _LARGEST_POWER):
                raise self.error(f'{values[row]:g} in "{self.name(quantity)}" is no logarithm', row)
            values = heading.base**values
        if needed:
            self.keep &= ~np.isnan(values)
        return values

    def resolution(self, quantity: str) -> Array:
        """Return half a unit of the last digit written, in the unit of the file."""
        index, heading = self._column(quantity)
        digits = np.array([numbers.half_digit(cells[index]) for _, cells in self.table.rows])
        if heading.base is None:
            return digits
        return digits * math.log(heading.base) * self.numbers(quantity, needed=False)

    def held(self, quantity: str) -> npt.NDArray[np.bool_]:
        """Return a mask of the rows in which a column is within 5 % of its level.

        The level is the median of the upper half. Other rows belong to the ramp before or after the
        step.
        """
        values = np.abs(self.numbers(quantity, needed=False))
        known = values[np.isfinite(values)]
        if not known.size or not known.max():
            return np.zeros(values.size, dtype=bool)
        level = np.median(known[known > 0.5 * known.max()])
        return np.abs(values - level) <= _HELD * level

    def is_clock(self, quantity: str) -> bool:
        """Return whether a column has times such as 00:01:30."""
        return self._is_clock(self._column(quantity)[0])

    def _is_clock(self, index: int) -> bool:
        """Return whether a column has clock times: hh:mm:ss, or mm:ss where its unit says so."""
        first = next(filter(None, (row[index].strip() for _, row in self.table.rows)), "")
        unit = unit_within(self.table.headings[index]) or self.table.units[index]
        return bool(numbers.CLOCK.fullmatch(first)) or (":" in first and is_clock_unit(unit))

    def _numbers(self, index: int) -> Array:
        """Return a column in the unit of the file; nan for gaps."""
        rows = self.table.rows
        cells = [cells[index] for _, cells in rows]
        values = numbers.plain_numbers(cells) if self.options.decimal != "," else None
        if values is None:
            clock = self._is_clock(index)
            mark = "" if clock else self._decimal_mark
            values = np.empty(len(cells))
            for row, text in enumerate(cells):
                try:
                    values[row] = numbers.seconds(text) if clock else numbers.number(text, mark)
                except ValueError as error:
                    name = self.table.headings[index]
                    raise self.error(f'column "{name}": {error}', row) from None
        values, filled = numbers.without_fillers(values)
        if filled:
            name = self.table.headings[index]
            self.notes.append(f'"{name}": {filled} numbers such as -9999 are gaps')
        return values

    @cached_property
    def _decimal_mark(self) -> str:
        """Decimal mark of all columns in use."""
        if self.options.decimal is not None:
            return self.options.decimal
        used = self.columns_in_use
        try:
            found = numbers.decimal_mark(
                cells[index] for _, cells in self.table.rows for index in used
            )
        except ValueError as error:
            raise self.error(str(error)) from None
        self.notes += ["decimal comma"] * (found == ",")
        return found

    # ---- units ---------------------------------------------------------------------------------

    def si(self, quantity: str) -> Array:
        """Return a column in SI, except temperatures and frequencies."""
        return self.factor(quantity) * self.numbers(quantity)

    def factor(self, quantity: str) -> float:
        """Return the factor from the unit of a column to SI."""
        target = UNITS.get(quantity, "1")
        unit = self._unit(quantity)
        if no_unit(unit) and target != "1":
            unit = self.options.unit(target)
            if no_unit(unit):
                raise self.error(f'column "{self.name(quantity)}" has no unit; {_cure(target)}')
        with self._located(quantity):
            return scale(unit, target)

    def has_unit(self, quantity: str) -> bool:
        """Return whether the file states the unit of a column."""
        return not no_unit(self._unit(quantity))

    def _unit(self, quantity: str) -> str:
        index, heading = self._column(quantity)
        return "s" if self._is_clock(index) else heading.unit or self.table.units[index]

    def refuse_contradiction(self, *quantities: str) -> None:
        """Refuse a unit of the caller that no column needs and that the file contradicts."""
        for target in ("Pa", "s", "N", "m", "K"):
            unit = self.options.unit(target)
            targeted = [name for name in quantities if name in self and UNITS.get(name) == target]
            if not unit or any(no_unit(self._unit(name)) for name in targeted):
                continue
            for name in targeted:
                if not same_unit(self._unit(name), unit):
                    stated = f'"{self.name(name)}" is in {bare(self._unit(name))}'
                    raise self.error(f"{stated}, but `{UNIT_OPTIONS[target][0]}` is {unit}")

    @contextmanager
    def _located(self, quantity: str, row: SupportsIndex | None = None) -> Iterator[None]:
        """Name the column, and the line of a row, in an error about its unit."""
        try:
            yield
        except ValueError as error:
            raise self.error(f'column "{self.name(quantity)}": {error}', row) from None

    # ---- temperature ---------------------------------------------------------------------------

    def temperature(self) -> Array:
        """Return the temperature of each row [K]; nan where the file states none."""
        if "temperature" not in self:
            stated, text = self.table.temperature, self.table.label
            if text:
                match = _TEMPERATURE.fullmatch(text.replace(",", "."))
                if match is None:
                    raise self.error(f"{text!r} above the columns is no temperature such as 20 °C")
                try:
                    # `lacking` has already rejected a label without a unit
                    unit = match[2] or self.options.temperature_unit or ""
                    stated = in_kelvin(float(match[1]), unit)
                except InputError as error:
                    raise self.error(str(error)) from None
            return np.full(len(self.table.rows), math.nan if stated is None else stated)
        unit = self._unit("temperature")
        unit = self.options.unit("K") if no_unit(unit) else unit
        with self._located("temperature"):
            if no_unit(unit):
                raise InputError(f"no unit; {_cure('K')}")
            factor, offset = kelvin(unit)
        # where every row has a gap, the temperature is unknown, and no row is lost
        known = not np.all(np.isnan(self.numbers("temperature", needed=False)))
        kelvins = self.numbers("temperature", needed=known) * factor + offset
        for row in np.flatnonzero((kelvins <= POSSIBLE[0]) | (kelvins >= POSSIBLE[1])):
            with self._located("temperature", row):
                possible(kelvins[row])
        self.notes += numbers.doubtful_temperature(kelvins, offset == 0.0)
        return kelvins

    # ---- one of several columns ----------------------------------------------------------------

    def _column(self, quantity: str) -> _Place:
        """Return the column of a quantity: the first of equal ones, the temperature of the sample.

        Of several others it is unknown which one is meant.
        """
        if quantity in self._chosen:
            return self._chosen[quantity]

        def far(place: _Place) -> int:
            name = self.table.headings[place[0]]
            return -nearness_to_sample(name) if quantity == "temperature" else 0

        first, *others = sorted(self._found[quantity], key=far)
        for other in others:
            names = [self.table.headings[index] for index, _ in (first, other)]
            kinds = {heading.kind for _, heading in (first, other)} - {None}
            apart = self._apart(quantity, first, other)
            if len(kinds) > 1:
                raise self.error(
                    f'"{names[0]}" and "{names[1]}" are one quantity; set `kind` to E or G'
                )
            if not np.any(apart > 1):
                self.notes.append(f'two equal columns; "{names[0]}" is used')
            elif far(other) > far(first):
                worst = f"{np.nanmax(apart) * _SAME_TEMPERATURE:.3g} K"
                unused = f'"{names[1]}" differs by up to {worst} and is not used'
                self.notes.append(f'"{names[0]}" is the temperature; {unused}')
            else:
                both = f'two columns of {quantity}: "{names[0]}" and "{names[1]}"'
                raise self.error(f"{both}; {self.words.choose(quantity, first[0] + 1)}")
        self._chosen[quantity] = first
        return first

    def _apart(self, quantity: str, first: _Place, other: _Place) -> Array:
        """Return the difference of two columns over what is negligible; nan where unknown."""
        one, two = (self._numbers(index) for index, _ in (first, other))
        units = [heading.unit or self.table.units[index] for index, heading in (first, other)]
        if quantity == "temperature":
            try:
                (a, b), (c, d) = (kelvin(u or self.options.temperature_unit or "") for u in units)
            except InputError:
                return np.full(one.size, math.nan)
            return np.abs(a * one + b - c * two - d) / _SAME_TEMPERATURE
        if bare(units[0]) != bare(units[1]):
            return np.full(one.size, math.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            apart = np.abs(one - two) / (_SAME * np.abs(one))
        # a gap beside a number is a difference
        return np.where(one == two, 0.0, np.where(np.isnan(two) & ~np.isnan(one), math.inf, apart))


class MaterialColumns(Columns):
    """Columns of a test of a material: with a kind of modulus, and a frequency."""

    options: Options

    def __init__(self, file: LabFile, table: Table, options: Options):
        super().__init__(file, table, options, MATERIAL)

    def kind(self, *quantities: str) -> str | None:
        """Return the kind of modulus stated by headings, neighbouring columns or text, or None."""
        headings = [h for q in quantities for _, h in self._found.get(q, [])]
        said = {heading.kind for heading in headings} - {None}
        if len(said) > 1:
            raise self.error("a column is tensile (E), another is shear (G); set `kind` to E or G")
        if said:
            return said.pop()
        known = [heading.kind for heading in map(recognise, self.table.headings) if heading]
        texts = (*self.table.headings, self.table.words)
        beside = {*known, *map(kind_of_geometry, texts)} - {None}
        kind = beside.pop() if len(beside) == 1 else None
        if kind is not None:
            self.notes.append(f"kind {kind!r} from the word {KINDS[kind]} beside the moduli")
        return kind

    def lacking(self, *quantities: str) -> list[str]:
        """Return what the units and labels of columns, or of all, lack, with the cure."""
        found: dict[str, list[str]] = {}
        quantities = quantities or tuple(self._found)
        for quantity in quantities:
            target = UNITS.get(quantity, "1")
            unknown = quantity in self and no_unit(self._unit(quantity))
            if unknown and target != "1" and not self.options.unit(target):
                found.setdefault(_cure(target), []).append(f'"{self.name(quantity)}"')
        lacking = [f"the unit of {' and '.join(names)} ({cure})" for cure, names in found.items()]
        label = _TEMPERATURE.fullmatch(self.table.label.replace(",", "."))
        unknown = label and not (label[2] or self.options.temperature_unit)
        if "temperature" in quantities and unknown:
            words = f"whether {self.table.label!r} above the columns is a temperature in C or K"
            lacking.append(f"{words} ({_cure('K')})")
        return lacking

    def angular_frequency(self) -> Array:
        """Return the angular frequency [rad/s] of each row, from one column or two that agree."""
        names = [name for name in ("angular_frequency", "frequency") if name in self]
        if len(names) == 2 and self.lacking("frequency"):
            names.pop()  # redundant, and its unit is ambiguous
        omega, *others = map(self._angular, names)
        for other in others:
            with np.errstate(divide="ignore", invalid="ignore"):
                # half a digit of each, in rad/s
                digits = [
                    self.resolution(name) * np.abs(values / self.numbers(name))
                    for name, values in zip(names, (omega, other), strict=True)
                ]
            own, alien = (f'"{self.name(name)}"' for name in names)
            apart, near = np.abs(omega - other), 0.01 * np.abs(omega)
            for row in np.flatnonzero(apart > near + digits[0] + digits[1]):
                both = f"{own} is {omega[row]:g} rad/s but {alien} gives {other[row]:g} rad/s"
                raise self.error(both, row)
            if np.any(apart > near):
                if not np.nanmedian(digits[0]) < np.nanmedian(digits[1]):
                    omega, own, alien = other, alien, own
                self.notes.append(f"{own} is used; {alien} agrees within its digits")
        for row in np.flatnonzero(omega <= 0):
            raise self.error(f"a frequency must be positive, got {omega[row]:g} rad/s", row)
        return omega

    def _angular(self, name: str) -> Array:
        unit, said = self._unit(name), self.options.frequency_unit
        angular = name == "angular_frequency"
        if no_unit(unit) and said is None and angular:
            self.notes.append(f'"{self.name(name)}" has no unit; rad/s assumed')
            return self.numbers(name)
        with self._located(name):
            factor = radians_per_second(said or unit, angular="rad" in said if said else angular)
            if said and not no_unit(unit):
                own = factor
                with suppress(ValueError):  # an ambiguous unit is decided by the caller
                    own = radians_per_second(unit, angular=angular)
                if not math.isclose(own, factor):
                    raise InputError(f"the unit is {bare(unit)}, but `frequency_unit` is {said}")
        return self.numbers(name) * factor


def refuse_pooled(read: Sequence[Columns]) -> None:
    """Refuse tables with a column that tells samples, positions or states apart.

    Raises
    ------
    ValueError
        If a column that names a sample or a recipe differs, or any other one that is text, or names
        a position, segment or state, differs between rows of one state.
    """
    columns: dict[str, list[tuple[str, Any]]] = {}
    for one in read:
        table, known = one.table, one.columns_in_use
        for index, heading in enumerate(table.headings):
            if heading and index not in known and no_unit(table.units[index]):
                rows = zip(table.rows, one.states, strict=True)
                cells = [(row[index].strip(), state) for (_, row), state in rows]
                columns.setdefault(heading, []).extend(cells)
    for heading, cells in columns.items():
        values = dict.fromkeys(cell for cell, _ in cells if cell)
        text = not any(
            numbers.is_number(cell) or cell[:1] in "-*" or ":" in cell for cell in values
        )
        name = plain(heading)
        sample, place = _SAMPLE.fullmatch(name), _PLACE.fullmatch(name)
        # a number of its own in each row counts the points
        counts = len(values) == len(cells) and not text
        tells_apart = text or sample or place
        if len(values) < 2 or counts or not tells_apart or _STATUS.search(name):
            continue
        pairs = {(state, cell) for cell, state in cells if cell}
        if sample or len(pairs) > len({state for state, _ in pairs}):
            first, *others = values
            some = ", ".join([first, *others[:4], *["..."] * (len(others) > 4)])
            raise read[0].file.error(
                f'column "{heading}" tells several samples or states apart ({some}); choose one by '
                f'`where`, such as "{heading}={first}"'
            )
