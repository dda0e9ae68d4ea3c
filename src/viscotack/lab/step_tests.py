"""Assemble relaxation tests, creep tests and shift factors in SI from the tables of a file."""

import math
from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .assembly import (
    headings_of,
    kept,
    kind_of,
    no_such_test,
    refuse_stiffer_than_diamond,
    refuse_what_is_lacking,
    source_of,
    temperatures,
)
from .diagnosis import test_of
from .formats.columns import MaterialColumns
from .formats.file import LabFile
from .formats.tables import Table, refuse_pooled
from .formats.unit_checks import doubtful_modulus
from .grouping import levels
from .options import Options
from .sweeps import CreepTest, RelaxationTest, ShiftTable

_DRIFT = 5.0  # K: largest range of temperatures of one test
Test = TypeVar("Test", RelaxationTest, CreepTest)
# test -> measured quantity, numerator and denominator if it is not a column, and its name
_MEASURED: dict[type, tuple[str, str, str, str]] = {
    RelaxationTest: ("modulus", "stress", "strain", "relaxation"),
    CreepTest: ("compliance", "strain", "stress", "creep"),
}


def tests(
    kind: type[Test],
    file: LabFile,
    format: str,
    tables: Sequence[Table],
    given: Options,
) -> list[Test]:
    """Return the tests of a kind in a file, one per temperature.

    Rows with monotonic time are one test, whose temperature may drift.
    """
    time, values, temperature, modulus, columns = _rows(file, tables, given, kind)
    steps = np.diff(time)
    runs_on = np.all(steps > 0) or np.all(steps < 0)
    whole = runs_on or np.any(np.isnan(temperature))
    source = source_of(file, format, [*file.notes, *columns.notes])
    held = _MEASURED[kind][2]
    found = []
    for part in [np.arange(time.size)] if whole else levels(temperature):
        known = temperature[part][~np.isnan(temperature[part])]
        if known.size and np.ptp(known) > _DRIFT:
            raise columns.error(
                f"the temperature varies by {np.ptp(known):.3g} K; a step test must have one "
                "temperature"
            )
        stated: dict[str, Any] = {
            held: _level(columns, held),
            "temperature": float(np.mean(known)) if known.size else None,
        }
        found.append(kind(time[part], values[part], modulus, source=source, **stated))
    return found


def shifts(file: LabFile, tables: Sequence[Table], given: Options) -> ShiftTable:
    """Return the shift factors of a file, as log10."""
    for table in tables:
        columns = MaterialColumns(file, table, given)
        if "temperature" in columns and ("log10_shift" in columns or "shift" in columns):
            break
    else:
        raise file.error(
            f"no table with columns T and log_aT, or T and aT; found {headings_of(tables)}"
        )
    temperature = columns.temperature()
    if "log10_shift" in columns:
        horizontal = columns.numbers("log10_shift")
    else:
        horizontal = _log10(columns, "shift")
    vertical = _log10(columns, "vertical_shift") if "vertical_shift" in columns else None
    keep = columns.keep
    if not keep.any():
        raise columns.error("no row has all required numbers")
    try:
        table = ShiftTable(
            temperature[keep],
            horizontal[keep],
            None,
            None if vertical is None else vertical[keep],
        )
    except ValueError as error:
        raise columns.error(str(error)) from None
    _refuse_inverse(columns, table)
    return table


def _refuse_inverse(columns: MaterialColumns, table: ShiftTable) -> None:
    """Raise an error if shifts rise with temperature, because they are 1/a_T."""
    if len(table) > 1 and np.all(np.diff(table.log10_shift) > 0):
        raise columns.error(
            "the shift factors rise with temperature, but a_T must exceed 1 where the solid is "
            "slower, below the reference temperature; give 1/a_T"
        )


def _rows(
    file: LabFile, tables: Sequence[Table], given: Options, kind_of_test: type
) -> tuple[Array, Array, Array, str, MaterialColumns]:
    """Return time, modulus or compliance, temperature and kind of the single matching table."""
    wanted, over, under, test = _MEASURED[kind_of_test]
    found = []
    for table in tables:
        columns = MaterialColumns(file, table, given)
        timed = "time" in columns or "step_time" in columns
        known = under in columns or under in table.levels
        if table.rows and timed and (wanted in columns or (over in columns and known)):
            found.append(columns)
    if not found:
        raise no_such_test(file, tables, given, test)
    # of several steps, select the one with constant stress or strain
    found = [columns for columns in found if test_of(columns) == test] or found
    if len(found) > 1:
        numbers = [str(columns.table.number) for columns in found]
        raise file.error(
            f"{len(found)} tables have a {test} test: {', '.join(numbers)}; choose one with "
            f"--table, {file.command(f'--table {numbers[0]}')}"
        )
    (columns,) = found
    # prefer the time since the step to the time of the whole test
    timed = "step_time" if "step_time" in columns else "time"
    needed = (wanted,) if wanted in columns else (over, under)
    refuse_what_is_lacking(
        columns, [name for name in needed if name in columns], timed, "temperature", *needed
    )
    time = columns.si(timed) - given.step_start
    if columns.is_clock(timed) and not given.step_start and np.nanmin(time) > np.ptp(time):
        raise columns.error(
            f'"{columns.name(timed)}" begins at {np.nanmin(time):g} s, as a time of day does; '
            "state when the step was applied with --step-start"
        )
    if not given.step_start and timed == "time":
        _refuse_late_start(columns, time)
    kind = kind_of(columns, *needed)
    if wanted in columns:
        values = columns.si(wanted)
    else:
        values = _ratio(columns, over, under)
        columns.notes.append(f"{wanted} from {over} over {under}")
    if "strain" in needed and "strain" in columns and not columns.has_unit("strain"):
        columns.notes.append(f'"{columns.name("strain")}" has no unit; a fraction is assumed')
    _leave_out_what_is_not_held(columns, under, test)
    temperature = temperatures(columns)
    if wanted == "modulus":
        refuse_stiffer_than_diamond(columns, values)
        columns.notes += doubtful_modulus(values[np.isfinite(values) & (values > 0)])
    kelvins = np.nan_to_num(np.round(temperature))
    states = list(zip(kelvins, np.round(time, 9), strict=True))
    refuse_pooled(file, [columns.table], [columns.columns_in_use], [states])
    keep = kept(columns, time, values)
    return time[keep], values[keep], temperature[keep], kind, columns


def _refuse_late_start(columns: MaterialColumns, time: Array) -> None:
    """Raise an error if time continues from the table before and is no time since the step."""
    previous = columns.table.before
    if previous is None or previous.sheet != columns.table.sheet or not np.isfinite(time).any():
        return
    before = MaterialColumns(columns.file, previous, columns.options)
    if "time" not in before:
        return
    try:
        end, start = before.si("time"), float(np.nanmin(time))
    except InputError:
        return
    if np.isfinite(end).any() and 0 < np.nanmax(end) <= start:
        example = columns.file.command(f'--step-start "{np.nanmax(end):g} s"')
        raise columns.error(
            f'"{columns.name("time")}" begins at {start:g} s, where the table before it ends, so '
            "that it is not the time since the step; state when the step was applied with "
            f"--step-start, {example}"
        )


def _ratio(columns: MaterialColumns, over: str, under: str) -> Array:
    """Return stress over strain or its inverse; the step may be stated once in the file."""
    numerator = columns.si(over)
    if under not in columns:
        return numerator / columns.table.levels[under]
    denominator = columns.si(under)
    columns.keep &= denominator != 0
    return numerator / np.where(denominator == 0, math.nan, denominator)


def _leave_out_what_is_not_held(columns: MaterialColumns, quantity: str, test: str) -> None:
    """Remove the points before and after the step; raise an error if there is no step."""
    if quantity not in columns:
        return
    held = columns.held(quantity)
    left = int(np.count_nonzero(columns.keep & ~held))
    if 2 * left > np.count_nonzero(columns.keep):
        raise columns.error(
            f'"{columns.name(quantity)}" is not constant: {left} of {held.size} points deviate by '
            f"more than 5 % from its level; a {test} test needs a constant {quantity}"
        )
    if left:
        columns.notes.append(
            f"rejected {left} points: the {quantity} is more than 5 % off its level"
        )
    columns.keep &= held


def _level(columns: MaterialColumns, quantity: str) -> float | None:
    """Return the median of a column held constant by the instrument, in SI."""
    if quantity not in columns:
        return columns.table.levels.get(quantity)
    values = columns.factor(quantity) * columns.numbers(quantity, needed=False)
    values = np.abs(values[columns.keep & np.isfinite(values)])
    return float(np.median(values)) if values.size else None


def _log10(columns: MaterialColumns, quantity: str) -> Array:
    values = columns.numbers(quantity)
    for row in np.flatnonzero(values <= 0):
        raise columns.error(
            f"a shift factor must be positive, got {values[row]:g} in column "
            f'"{columns.name(quantity)}"; check whether it is a logarithm',
            int(row),
        )
    return np.log10(values)
