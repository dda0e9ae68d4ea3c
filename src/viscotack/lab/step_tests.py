"""From the tables of a file to tests in time and to shift factors, in SI."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .assembly import (
    Given,
    headings_of,
    kept,
    kind_of,
    refuse_stiffer_than_diamond,
    source_of,
    temperatures,
)
from .lab_file import LabFile
from .sweeps import CreepTest, RelaxationTest, ShiftTable
from .table import Columns, Table

Array = npt.NDArray[np.float64]


def relaxation(file: LabFile, format: str, tables: Sequence[Table], given: Given) -> RelaxationTest:
    """Return the one stress relaxation test of a file."""
    time, modulus, kind, temperature, columns = _test(file, tables, given, "modulus")
    return RelaxationTest(
        time,
        modulus,
        kind,
        strain=_level(columns, "strain"),
        temperature=temperature,
        source=source_of(file, format, [*file.notes, *columns.notes]),
    )


def creep(file: LabFile, format: str, tables: Sequence[Table], given: Given) -> CreepTest:
    """Return the one creep test of a file."""
    time, compliance, kind, temperature, columns = _test(file, tables, given, "compliance")
    return CreepTest(
        time,
        compliance,
        kind,
        stress=_level(columns, "stress"),
        temperature=temperature,
        source=source_of(file, format, [*file.notes, *columns.notes]),
    )


def shifts(file: LabFile, tables: Sequence[Table], given: Given) -> ShiftTable:
    """Return the shift factors of a file, as log10."""
    for table in tables:
        columns = Columns(file, table, given.units)
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
        raise columns.error("no row has all the numbers that are needed")
    try:
        return ShiftTable(
            temperature[keep],
            horizontal[keep],
            None,
            None if vertical is None else vertical[keep],
        )
    except ValueError as error:
        raise columns.error(str(error)) from None


def _test(
    file: LabFile, tables: Sequence[Table], given: Given, wanted: str
) -> tuple[Array, Array, str, float | None, Columns]:
    """Return time, modulus or compliance, kind and temperature of the one table that has them."""
    over, under = ("stress", "strain") if wanted == "modulus" else ("strain", "stress")
    found = []
    for table in tables:
        columns = Columns(file, table, given.units, given.kind)
        timed = "time" in columns or "step_time" in columns
        if timed and (wanted in columns or (over in columns and under in columns)):
            found.append(columns)
    if len(found) != 1:
        raise file.error(
            f"expected one table with a time and a {wanted} (or stress and strain), found "
            f"{len(found)}; {'export one step' if found else f'columns: {headings_of(tables)}'}"
        )
    (columns,) = found
    # the time of the whole test runs on from step to step; the step has its own
    time = columns.si("step_time" if "step_time" in columns else "time")
    if wanted in columns:
        kind = kind_of(columns, given, wanted)
        values = columns.si(wanted)
    else:
        kind = kind_of(columns, given, over, under)
        numerator, denominator = columns.si(over), columns.si(under)
        columns.keep &= denominator != 0
        values = numerator / np.where(denominator == 0, math.nan, denominator)
        columns.notes.append(f"{wanted} from {over} over {under}")
    temperature = temperatures(columns, given)
    if wanted == "modulus":
        refuse_stiffer_than_diamond(columns, values)
    keep = kept(columns, time, values)
    known = temperature[keep][~np.isnan(temperature[keep])]
    if known.size and np.ptp(known) > 5:
        raise columns.error(
            f"the temperature runs over {np.ptp(known):.3g} K; a step test has one temperature"
        )
    return time[keep], values[keep], kind, float(np.mean(known)) if known.size else None, columns


def _level(columns: Columns, quantity: str) -> float | None:
    """Return the middle of a column that the instrument held constant, in SI."""
    if quantity not in columns:
        return None
    values = columns.factor(quantity) * columns.numbers(quantity, needed=False)
    values = np.abs(values[columns.keep & np.isfinite(values)])
    return float(np.median(values)) if values.size else None


def _log10(columns: Columns, quantity: str) -> Array:
    values = columns.numbers(quantity)
    for row in np.flatnonzero(values <= 0):
        raise columns.error(
            f"a shift factor must be positive, got {values[row]:g} in column "
            f'"{columns.name(quantity)}"; is it a logarithm?',
            int(row),
        )
    return np.log10(values)
