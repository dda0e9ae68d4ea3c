"""Assemble frequency sweeps in SI from the tables of a file; functions shared by all readers."""

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .diagnosis import cause, form_of, has_sweep
from .formats.columns import MaterialColumns
from .formats.file import LabFile
from .formats.tables import Table, refuse_pooled
from .formats.unit_checks import doubtful_modulus
from .grouping import GAP, grouped
from .joining import numbered_on
from .options import Options
from .sweeps import FrequencySweeps, Source

STIFFEST = 1.2e12  # Pa, diamond
_ONE_STATE = "all points have one temperature and one frequency (an amplitude or time sweep?)"
_TANGENTS = 1e-5, 1e4  # range for solids and most liquids; beyond it a unit is wrong
_FLAG = re.compile(r"(--[a-z-]+) ([\w/]+)")  # an option and its first value
# Relative differences of tan(delta) and |E*| from the moduli, in addition to rounding: a larger one
# is noted, because instruments average over cycles, and refused.
_TOLERANCE, _DAMAGED = 0.02, 0.1


def sweeps(file: LabFile, format: str, tables: Sequence[Table], given: Options) -> FrequencySweeps:
    """Return the frequency sweeps of all tables that contain them, in the order of the file."""
    parts, read, states, notes = [], [], [], list(file.notes)
    for table in tables:
        columns = MaterialColumns(file, table, given)
        if not table.rows or not has_sweep(columns):
            notes.append(f"ignored a table without sweeps: {headings_of([table])}")
            continue
        part = _part(columns)
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
    used = [columns.columns_in_use for columns in read]
    refuse_pooled(file, [columns.table for columns in read], used, [c.states for c in read])
    if len({part.kind for part in parts}) > 1:
        raise file.error("some tables are tensile (E), others shear (G); set --kind E or --kind G")
    source = source_of(file, format, notes)
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


def _part(columns: MaterialColumns) -> FrequencySweeps:
    """Return the sweeps of one table."""
    form = form_of(columns)
    assert form is not None, "checked by the caller"
    if "viscosity" in form[0] and columns.kind(*form) is None and columns.options.kind is None:
        columns.options = replace(columns.options, kind="G")
        columns.notes.append(f'"{columns.name(form[0])}" is taken as a viscosity in shear')
    frequency = () if "angular_frequency" in columns else ("frequency",)
    refuse_what_is_lacking(columns, form, "temperature", *frequency, *form)
    kind = kind_of(columns, *form)
    omega = columns.angular_frequency()
    values: dict[str, Any] = {
        "temperature": temperatures(columns),
        "angular_frequency": omega,
    }
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
            f"the median loss tangent is {tangent:.2g}, which no solid has; check the units of "
            "both moduli, or whether the sample was a liquid without elasticity"
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
            f'"{columns.name("phase")}" is {angle[row]:g} rad; a loss angle lies between 0 and 90 '
            "degrees; check its unit",
            int(row),
        )
    return np.tan(angle)


def refuse_what_is_lacking(
    columns: MaterialColumns, moduli: Sequence[str], *quantities: str
) -> None:
    """Raise one error that lists everything missing in both file and caller's options."""
    lacking = columns.lacking(*quantities)
    columns.refuse_contradiction(*quantities)
    if columns.kind(*moduli) is None and columns.options.kind is None:
        lacking.append(
            f'whether "{columns.name(moduli[0])}" is tensile or shear (--kind E or --kind G)'
        )
    if lacking:
        flags = [" ".join(pair) for text in lacking for pair in _FLAG.findall(text)[:1]]
        example = columns.file.command(" ".join(dict.fromkeys(flags))) if flags else ""
        what = "; nor ".join(lacking)
        raise columns.error(f"the file does not state {what}{'; ' * bool(flags)}{example}")


def _without_repeats(columns: MaterialColumns, values: dict[str, Array]) -> dict[str, Array]:
    """Remove rows that repeat an earlier row exactly."""
    rows = np.column_stack(list(values.values()))
    _, first = np.unique(rows, axis=0, return_index=True)
    if first.size < len(rows):
        columns.notes.append(f"{len(rows) - first.size} repeated rows removed")
    return {name: column[np.sort(first)] for name, column in values.items()}


def kind_of(columns: MaterialColumns, *quantities: str) -> str:
    """Return the kind of modulus ("E" or "G") stated by the file or the caller."""
    said, given = columns.kind(*quantities), columns.options.kind
    if said is not None and given is not None and said != given:
        raise columns.error(f"the file has a modulus of kind {said}, but --kind is {given}")
    return said or given or ""


def temperatures(columns: MaterialColumns) -> Array:
    """Return the temperature of each row [K], from the file or the caller; nan if unknown."""
    temperature, given = columns.temperature(), columns.options.temperature
    if given is None:
        return temperature
    if not np.all(np.isnan(temperature)):
        raise columns.error("the file states its temperatures; omit --temperature")
    return np.full(temperature.size, given)


def kept(columns: MaterialColumns, *positive: Array) -> npt.NDArray[np.bool_]:
    """Return a mask of the usable rows, and note how many were rejected and why."""
    lines = np.array([line for line, _ in columns.table.rows])
    missing = ~columns.keep
    wrong = columns.keep & ~np.all([values > 0 for values in positive], axis=0)
    for rows, why in ((missing, "a number is missing"), (wrong, "a value is not positive")):
        if rows.any():
            columns.notes.append(f"rejected because {why}: {_listed(lines[rows])}")
    keep = ~missing & ~wrong
    if not keep.any():
        raise columns.error("no row has all required numbers")
    return keep


def refuse_stiffer_than_diamond(columns: MaterialColumns, *moduli: Array) -> None:
    """Raise an error if a modulus exceeds that of diamond, because its unit must be wrong."""
    for modulus in moduli:
        for row in np.flatnonzero(modulus > STIFFEST):
            raise columns.error(
                f"a modulus of {modulus[row]:g} Pa exceeds that of diamond; check its unit",
                int(row),
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
            f'"{columns.name(name)}" is {found[row]:g}, but storage and loss modulus give '
            f"{expected[row]:g}; a number is damaged or a unit is wrong",
            int(row),
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


def _listed(lines: npt.NDArray[np.int64]) -> str:
    shown = ", ".join(str(line) for line in lines[:10])
    return f"line {shown}" if lines.size <= 10 else f"line {shown} and {lines.size - 10} more"


def source_of(file: LabFile, format: str, notes: Sequence[str]) -> Source:
    """Return the source of the numbers, with each note once."""
    return Source(file.path, file.sha256, format, tuple(dict.fromkeys(notes)))
