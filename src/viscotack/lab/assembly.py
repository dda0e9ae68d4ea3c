"""Assemble sweeps, relaxation and creep tests and shift factors in SI from tables of a file."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.shift import TabulatedShift

from .diagnosis import cause, form_of, test_of
from .formats.columns import MaterialColumns, refuse_pooled
from .formats.file import LabFile
from .formats.numbers import doubtful_modulus
from .formats.tables import Table
from .options import Options
from .sweeps import (
    GAP,
    CreepTest,
    FrequencySweeps,
    RelaxationTest,
    Source,
    grouped,
    levels,
    numbered_on,
)

STIFFEST = 1.2e12  # Pa, diamond
_ONE_STATE = "all points have one temperature and one frequency (an amplitude or time sweep?)"
_TANGENTS = 1e-5, 1e4  # range for solids and most liquids; beyond it a unit is wrong
# Relative differences of tan(delta) and |E*| from the moduli, in addition to rounding: a larger one
# is noted, because instruments average over cycles, and refused.
_TOLERANCE, _DAMAGED = 0.02, 0.1


def sweeps(file: LabFile, tables: Sequence[Table], given: Options) -> FrequencySweeps:
    """Return the frequency sweeps of all tables that contain them, in the order of the file."""
    parts, read, states, notes = [], [], [], list(file.notes)
    for table in tables:
        columns = MaterialColumns(file, table, given)
        form = form_of(columns)
        if not table.rows or form is None:
            notes.append(f"ignored a table without sweeps: {headings_of([table])}")
            continue
        part = _part(columns, form)
        if _repeats_one_state(part, len(tables)):
            states.append(columns)
            notes.append(f"ignored the table from line {table.rows[0][0]}: {_ONE_STATE}")
            continue
        parts.append(part)
        read.append(columns)
        notes += columns.notes
    if states and not parts:
        raise states[0].error(f"{_ONE_STATE}; expected several frequencies or temperatures")
    if not parts:
        raise no_such_test(file, tables, given, "dma")
    refuse_pooled(read)
    if len({part.kind for part in parts}) > 1:
        raise file.error("some tables are tensile (E), others shear (G); set `kind` to one")
    source = source_of(file, notes)
    # a single table keeps its own sweep numbers
    return numbered_on(parts, source) if len(parts) > 1 else replace(parts[0], source=source)


def no_such_test(file: LabFile, tables: Sequence[Table], given: Options, wanted: str) -> InputError:
    """Return the error for a file without the requested test, with the content of the file."""
    expected = {
        "dma": "a frequency, a storage modulus and a loss modulus or tan(delta)",
        "relaxation": "a time and a modulus (or stress and strain)",
        "creep": "a time and a compliance (or stress and strain)",
    }
    every = [MaterialColumns(file, table, replace(given, kind=None)) for table in tables]
    why = cause(every, wanted, given.kind)
    return file.error(f"no table with {expected[wanted]}; {why or f'found {headings_of(tables)}'}")


def _repeats_one_state(part: FrequencySweeps, tables: int) -> bool:
    """Return whether all points of one of several tables have one frequency and one temperature."""
    omega, temperature = part.angular_frequency, part.temperature
    one_frequency = np.ptp(omega) <= 1e-3 * omega[0]
    # an unknown temperature cannot distinguish points
    if omega.size == 1:
        return tables > 1 and bool(np.all(np.isnan(temperature)))
    return bool(one_frequency and not np.ptp(temperature) > GAP)


def _part(columns: MaterialColumns, form: tuple[str, str]) -> FrequencySweeps:
    """Return the sweeps of one table, from the two columns that determine its moduli."""
    if "viscosity" in form[0] and columns.kind(*form) is None and columns.options.kind is None:
        columns.options = replace(columns.options, kind="G")
        columns.notes.append(f'"{columns.name(form[0])}" is taken as a viscosity in shear')
    frequency = () if "angular_frequency" in columns else ("frequency",)
    kind = kind_of(columns, form, "temperature", *frequency)
    omega = columns.angular_frequency()
    values: dict[str, Any] = {"temperature": temperatures(columns), "angular_frequency": omega}
    values["storage"], values["loss"] = _moduli(columns, form, omega)
    kelvins = np.nan_to_num(np.round(values["temperature"]))
    columns.states = list(zip(kelvins, np.round(100 * np.log(omega)), strict=True))
    if "sweep" in columns:
        values["sweep"] = columns.numbers("sweep")
    refuse_stiffer_than_diamond(columns, values["storage"], values["loss"])
    keep = kept(columns, values["storage"], values["loss"])
    tangent = float(np.median(values["loss"][keep] / values["storage"][keep]))
    if not _TANGENTS[0] < tangent < _TANGENTS[1]:
        raise columns.error(
            f"a median loss tangent of {tangent:.2g} is that of no solid; check both units"
        )
    columns.notes += doubtful_modulus(np.hypot(values["storage"], values["loss"])[keep])
    values = _without_repeats(columns, {name: column[keep] for name, column in values.items()})
    if "sweep" not in values:
        numbers, how = grouped(values["temperature"], values["angular_frequency"])
        values["sweep"] = numbers.astype(float)
        columns.notes += [how] * bool(how)
    elif np.any(values["sweep"] != np.round(values["sweep"])):
        raise columns.error(f'column "{columns.name("sweep")}" must contain whole numbers')
    return FrequencySweeps(**values, kind=kind)


def _moduli(columns: MaterialColumns, form: tuple[str, str], omega: Array) -> tuple[Array, Array]:
    """Return storage and loss modulus [Pa], from two columns that determine them."""
    one, other = form
    if form == ("storage", "loss"):
        storage, loss = columns.si(one), columns.si(other)
        _agree(columns, storage, loss)
        return storage, loss
    columns.notes.append(f'moduli from "{columns.name(one)}" and "{columns.name(other)}"')
    size = columns.si(one)
    if one == "storage":
        return size, size * _tangent(columns)
    if one == "dynamic_viscosity":  # eta' = G''/omega, eta'' = G'/omega
        return columns.si(other) * omega, size * omega
    if one == "storage_compliance":
        loss = columns.si(other)
        square = size**2 + loss**2
        with np.errstate(divide="ignore", invalid="ignore"):
            return size / square, loss / square
    angle = np.arctan(_tangent(columns))
    size = size * omega if one == "complex_viscosity" else size
    return size * np.cos(angle), size * np.sin(angle)


def _tangent(columns: MaterialColumns) -> Array:
    """Return tan(delta), from its column or from the loss angle."""
    if "tan_delta" in columns:
        return columns.numbers("tan_delta")
    angle = columns.si("phase")
    wrong = np.flatnonzero((angle < 0) | (angle >= np.pi / 2))
    for row in wrong:
        raise columns.error(
            f'"{columns.name("phase")}" is {angle[row]:g} rad, not 0 to 90 degrees',
            row,
        )
    return np.tan(angle)


def kind_of(columns: MaterialColumns, moduli: Sequence[str], *beside: str) -> str:
    """Return the kind of modulus ("E" or "G") stated by the file or the caller.

    One error lists everything about these columns that is missing in both.
    """
    lacking = columns.lacking(*beside, *moduli)
    columns.refuse_contradiction(*beside, *moduli)
    said, given = columns.kind(*moduli), columns.options.kind
    if said is None and given is None:
        name = next(columns.name(quantity) for quantity in moduli if quantity in columns)
        lacking.append(f'whether "{name}" is tensile or shear (set `kind` to E or G)')
    if lacking:
        raise columns.error(f"the file does not state {'; nor '.join(lacking)}")
    if said is not None and given is not None and said != given:
        raise columns.error(f"the file has a modulus of kind {said}, but `kind` is {given}")
    return said or given or ""


def _without_repeats(columns: MaterialColumns, values: dict[str, Array]) -> dict[str, Array]:
    """Remove rows that repeat an earlier row exactly."""
    rows = np.column_stack(list(values.values()))
    _, first = np.unique(rows, axis=0, return_index=True)
    if first.size < len(rows):
        columns.notes.append(f"{len(rows) - first.size} repeated rows removed")
    return {name: column[np.sort(first)] for name, column in values.items()}


def temperatures(columns: MaterialColumns) -> Array:
    """Return the temperature of each row [K], from the file or the caller; nan if unknown."""
    temperature, given = columns.temperature(), columns.options.temperature
    if given is None:
        return temperature
    if not np.all(np.isnan(temperature)):
        raise columns.error("the file states its temperatures; omit `temperature`")
    return np.full(temperature.size, given)


def kept(columns: MaterialColumns, *positive: Array) -> npt.NDArray[np.bool_]:
    """Return a mask of the usable rows, and note how many were rejected and why."""
    lines = np.array([line for line, _ in columns.table.rows])
    missing = ~columns.keep
    wrong = columns.keep & ~np.all([values > 0 for values in positive], axis=0)
    for rows, why in ((missing, "a number is missing"), (wrong, "a value is not positive")):
        if rows.any():
            shown = ", ".join(map(str, lines[rows][:10]))
            more = f" and {rows.sum() - 10} more" if rows.sum() > 10 else ""
            columns.notes.append(f"rejected because {why}: line {shown}{more}")
    keep = ~missing & ~wrong
    if not keep.any():
        raise columns.error("no row has all required numbers")
    return keep


def refuse_stiffer_than_diamond(columns: MaterialColumns, *moduli: Array) -> None:
    """Raise an error if a modulus exceeds that of diamond, because its unit must be wrong."""
    for modulus in moduli:
        for row in np.flatnonzero(modulus > STIFFEST):
            raise columns.error(
                f"{modulus[row]:g} Pa exceeds the modulus of diamond; check its unit",
                row,
            )


def _agree(columns: MaterialColumns, storage: Array, loss: Array) -> None:
    """Raise an error if tan(delta) or |E*| contradicts the storage and loss modulus of its row."""
    digits = [columns.resolution(name) * columns.factor(name) for name in ("storage", "loss")]
    sizes = np.hypot(storage, loss)
    if "tan_delta" in columns:
        with np.errstate(divide="ignore", invalid="ignore"):
            tangent = loss / storage
            slack = (digits[1] + np.abs(tangent) * digits[0]) / np.abs(storage)
        _same(columns, "tan_delta", 1.0, tangent, slack)
    if "magnitude" in columns and not columns.lacking("magnitude"):
        _same(columns, "magnitude", columns.factor("magnitude"), sizes, digits[0] + digits[1])


def _same(
    columns: MaterialColumns, name: str, factor: float, expected: Array, slack: Array
) -> None:
    found = factor * columns.numbers(name, needed=False)
    slack = slack + factor * columns.resolution(name)
    off = np.abs(found - expected)
    for row in np.flatnonzero(off > slack + _DAMAGED * np.abs(expected)):
        raise columns.error(
            f'"{columns.name(name)}" is {found[row]:g}, but the moduli give {expected[row]:g}: a '
            "damaged number or a wrong unit",
            row,
        )
    rows = np.flatnonzero(off > slack + _TOLERANCE * np.abs(expected))
    if rows.size:
        worst = float(np.max(off[rows] / np.abs(expected[rows])))
        columns.notes.append(
            f'"{columns.name(name)}" differs by up to {100 * worst:.2g} % from that of storage and '
            "loss modulus, as where an instrument averages it over cycles; it is not used"
        )


def headings_of(tables: Sequence[Table]) -> str:
    """Return the headings of all tables as text for an error message."""
    headings = [heading for table in tables for heading in table.headings if heading]
    return ", ".join(f'"{heading}"' for heading in dict.fromkeys(headings)) or "no headings"


def source_of(file: LabFile, notes: Sequence[str]) -> Source:
    """Return the source of the numbers, with each note once."""
    return Source(file.path, file.sha256, file.format, tuple(dict.fromkeys(notes)))


# ---- step tests and shift factors ----------------------------------------------------------------

_DRIFT = 5.0  # K: largest range of temperatures of one test
Test = TypeVar("Test", RelaxationTest, CreepTest)
# test -> measured quantity, numerator and denominator if it is not a column, and its name
_MEASURED: dict[type, tuple[str, str, str, str]] = {
    RelaxationTest: ("modulus", "stress", "strain", "relaxation"),
    CreepTest: ("compliance", "strain", "stress", "creep"),
}


def _of_test(kind: type, file: LabFile, tables: Sequence[Table], given: Options) -> MaterialColumns:
    """Return the columns of the single table with a test of a kind."""
    wanted, over, under, test = _MEASURED[kind]
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
            f"{len(found)} tables have a {test} test: {', '.join(numbers)}; choose one by `table`"
        )
    return found[0]


def tests(kind: type[Test], file: LabFile, tables: Sequence[Table], given: Options) -> list[Test]:
    """Return the tests of a kind in a file, one per temperature.

    Rows with monotonic time are one test, whose temperature may drift.
    """
    columns = _of_test(kind, file, tables, given)
    wanted, over, under, test = _MEASURED[kind]
    # prefer the time since the step to the time of the whole test
    timed = "step_time" if "step_time" in columns else "time"
    needed = (wanted,) if wanted in columns else (over, under)
    modulus = kind_of(columns, needed, timed, "temperature")
    time = columns.si(timed) - given.step_start
    if columns.is_clock(timed) and not given.step_start and np.nanmin(time) > np.ptp(time):
        raise columns.error(
            f'"{columns.name(timed)}" begins at {np.nanmin(time):g} s, a time of day; set '
            "`step_start`"
        )
    if not given.step_start and timed == "time":
        _refuse_late_start(columns, time)
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
    columns.states = list(zip(kelvins, np.round(time, 9), strict=True))
    refuse_pooled([columns])
    keep = kept(columns, time, values)
    time, values, temperature = time[keep], values[keep], temperature[keep]
    steps = np.diff(time)
    runs_on = np.all(steps > 0) or np.all(steps < 0)
    whole = runs_on or np.any(np.isnan(temperature))
    source = source_of(file, [*file.notes, *columns.notes])
    found = []
    for part in [np.arange(time.size)] if whole else levels(temperature):
        known = temperature[part][~np.isnan(temperature[part])]
        if known.size and np.ptp(known) > _DRIFT:
            raise columns.error(
                f"the temperature varies by {np.ptp(known):.3g} K; a step test has one"
            )
        stated: dict[str, Any] = {
            under: _level(columns, under),
            "temperature": float(np.mean(known)) if known.size else None,
        }
        found.append(kind(time[part], values[part], modulus, source=source, **stated))
    return found


def shifts(file: LabFile, tables: Sequence[Table], given: Options) -> TabulatedShift:
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
    order = np.flatnonzero(keep)[np.argsort(temperature[keep], kind="stable")]
    temperature, values = temperature[order], horizontal[order]
    up = () if vertical is None else tuple(vertical[order])
    reference = float(temperature[np.argmin(np.abs(values))])
    try:
        table = TabulatedShift(reference, tuple(temperature), tuple(values), vertical=up)
    except ValueError as error:
        raise columns.error(str(error)) from None
    if np.all(np.diff(values) > 0):
        raise columns.error(
            "the shifts rise with temperature; a_T exceeds 1 in the cold: give 1/a_T"
        )
    return table


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
        raise columns.error(
            f'"{columns.name("time")}" begins at {start:g} s, where the table before it ends: set '
            f'`step_start` to "{np.nanmax(end):g} s"'
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
            f'{left} of {held.size} points of "{columns.name(quantity)}" are more than 5 % off '
            f"its level; a {test} test needs a constant {quantity}"
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
            f'a shift factor must be positive, got {values[row]:g} in "{columns.name(quantity)}"',
            row,
        )
    return np.log10(values)
