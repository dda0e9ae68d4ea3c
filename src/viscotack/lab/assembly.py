"""Assemble sweeps, relaxation and creep tests and shift factors in SI from tables of a file.

The columns of a table identify its test. The refusal of a file without the requested test gives the
reason, from what its tables contain.
"""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.shift import TabulatedShift

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
_SWEPT = 0.05  # relative range of a frequency or a temperature that is swept
_DRIFT = 5.0  # K: largest range of temperatures of one step test
# Pairs of columns that determine the complex modulus, the most direct ones first.
_FORMS = (
    ("storage", "loss"),
    *((size, angle) for size in ("storage", "magnitude") for angle in ("tan_delta", "phase")),
    ("dynamic_viscosity", "elastic_viscosity"),
    ("storage_compliance", "loss_compliance"),
    ("complex_viscosity", "tan_delta"),
    ("complex_viscosity", "phase"),
)
# what the table of each test needs
_EXPECTED = {
    "dma": "a frequency, a storage modulus and a loss modulus or tan(delta)",
    "relaxation": "a time and a modulus (or stress and strain)",
    "creep": "a time and a compliance (or stress and strain)",
    "shifts": "T and log_aT, or T and aT",
}
Test = TypeVar("Test", RelaxationTest, CreepTest)
# test -> measured quantity, numerator and denominator if it is not a column, and its name
_MEASURED: dict[type, tuple[str, str, str, str]] = {
    RelaxationTest: ("modulus", "stress", "strain", "relaxation"),
    CreepTest: ("compliance", "strain", "stress", "creep"),
}


class Opened(NamedTuple):
    """Tables of a file and the caller's options, the input of every reader of tests."""

    file: LabFile
    tables: list[Table]
    given: Options

    @property
    def columns(self) -> list[MaterialColumns]:
        """Columns of each table that has rows."""
        return [MaterialColumns(self.file, x, self.given) for x in self.tables if x.rows]

    @property
    def headings(self) -> str:
        """Headings of all tables as text for an error message."""
        found = dict.fromkeys(h for table in self.tables for h in table.headings if h)
        return ", ".join(f'"{heading}"' for heading in found) or "no headings"

    def source(self, notes: Sequence[str]) -> Source:
        """Return the source of the numbers, with each note once."""
        file = self.file
        return Source(file.path, file.sha256, file.format, tuple(dict.fromkeys(notes)))

    def lacks(self, wanted: str) -> InputError:
        """Return the error for a file without the requested test, with the reason."""
        every = self._replace(given=replace(self.given, kind=None)).columns
        tests = {test_of(columns) for columns in every}
        others = [test for test in _EXPECTED if test in tests and test != wanted]
        if not every:
            why = "there are no numbers below its headings"
        elif wanted in tests and self.given.kind:
            why = f"its moduli are not of `kind` {self.given.kind}; `poisson_ratio` converts them"
        elif others:
            what = "a `shift_file`" if others[0] == "shifts" else f"a test for `test` {others[0]}"
            why = f"it contains {what}"
        else:
            found = (_nonlinear(columns) for columns in every)
            why = next(filter(None, found), f"found {self.headings}")
        return self.file.error(f"no table with {_EXPECTED[wanted]}; {why}")


# ---- tests of tables -----------------------------------------------------------------------------


def test_of(columns: MaterialColumns) -> str | None:
    """Return the test that the columns of a table belong to, or None.

    If both stress and strain are present, the one held constant identifies the test.
    """
    if form_of(columns):
        return "dma"
    if _has_shifts(columns):
        return "shifts"
    if not ("time" in columns or "step_time" in columns):
        return None
    both = "stress" in columns and "strain" in columns
    steps = columns.table.levels
    if "stress" in columns and "strain" in steps:
        return "relaxation"
    if "strain" in columns and "stress" in steps:
        return "creep"
    modulus, compliance = "modulus" in columns or both, "compliance" in columns or both
    if modulus and compliance:
        return _by_what_is_held(columns) if both else None
    return "relaxation" if modulus else "creep" if compliance else None


def sheets_with_test(tables: Sequence[MaterialColumns]) -> tuple[str, set[str], set[str]]:
    """Return the sheet with a test, the sheets read with it, and others with the same columns.

    It is the first sheet with a test, preferably with one that sweeps and lacks no unit. Sheets of
    sweeps with the same headings belong to one test if each has temperatures of its own.
    """

    def score(columns: MaterialColumns) -> tuple[bool, bool, bool]:
        test = test_of(columns) if columns.table.rows else None
        sweeps = test is not None and (test != "dma" or _sweeps(columns))
        return test is not None, sweeps, sweeps and not columns.lacking()

    sheet = max(tables, key=score).table.sheet
    swept = [x for x in tables if x.table.rows and test_of(x) == "dma" and _sweeps(x)]
    headings = next((x.table.headings for x in swept if x.table.sheet == sheet), ())
    alike = [one for one in swept if one.table.headings == headings]
    names = {one.table.sheet for one in alike} or {sheet}
    found: list[tuple[float, str]] = []
    for one in alike:
        with suppress(InputError):
            found += [(float(T), one.table.sheet) for T in np.unique(one.temperature())]
    known = [pair for pair in sorted(found) if np.isfinite(pair[0])]
    apart = all(b - a > GAP for (a, one), (b, other) in pairwise(known) if one != other)
    if {name for _, name in known} == names and apart:
        return sheet, names, set()
    return sheet, {sheet}, names - {sheet}


def _sweeps(columns: MaterialColumns) -> bool:
    """Return whether a frequency or a temperature varies by more than it scatters."""
    try:
        swept = [
            columns.numbers(quantity, needed=False)
            for quantity in ("frequency", "angular_frequency", "temperature")
            if quantity in columns
        ]
    except InputError:
        return False
    known = (values[np.isfinite(values)] for values in swept)
    return any(x.size and np.ptp(x) > _SWEPT * np.max(np.abs(x)) for x in known)


def form_of(columns: MaterialColumns) -> tuple[str, str] | None:
    """Return the two columns from which a complex modulus over frequency follows, or None."""
    if "frequency" not in columns and "angular_frequency" not in columns:
        return None
    return next((form for form in _FORMS if all(name in columns for name in form)), None)


def _nonlinear(columns: MaterialColumns) -> str:
    """Describe a table without a linear viscoelastic test; empty if unknown."""
    timed = "time" in columns or "step_time" in columns
    swept = "frequency" in columns or "angular_frequency" in columns
    stress, strain = "stress" in columns, "strain" in columns
    rate, viscosity = "shear_rate" in columns, "viscosity" in columns
    size = "storage" in columns or "magnitude" in columns
    # a wave of large amplitude has its rate beside strain and stress
    waves = timed and stress and strain and rate and not viscosity
    cases = (
        (waves, "it is waves of strain and stress"),
        (rate or viscosity, "it is a flow curve or the start-up of a steady flow"),
        (not swept and "storage" in columns and strain, "it is an amplitude sweep"),
        (timed and stress and strain, "neither stress nor strain is held; separate the steps"),
        (timed and stress, "it has a stress over time without strain or modulus"),
        (timed and strain, "it has a strain over time without stress or compliance"),
        (swept and size, "the complex modulus lacks a loss modulus or a loss angle"),
    )
    return next((words for holds, words in cases if holds), "")


def _by_what_is_held(columns: MaterialColumns) -> str | None:
    spread = {}
    for quantity in ("stress", "strain"):
        try:
            inside = columns.held(quantity)
        except ValueError:
            return None
        spread[quantity] = inside.mean() if inside.size else 0.0
    stress = columns.numbers("stress", needed=False)
    stress = np.abs(stress[np.isfinite(stress)])
    if not stress.size or np.median(stress) == 0.0:
        return None  # the recovery after creep holds no stress
    if max(spread.values()) < 0.5 or spread["stress"] == spread["strain"]:
        return None
    return "creep" if spread["stress"] > spread["strain"] else "relaxation"


# ---- frequency sweeps ----------------------------------------------------------------------------


def sweeps(opened: Opened) -> FrequencySweeps:
    """Return the frequency sweeps of all tables that contain them, in the order of the file."""
    file, tables, given = opened
    parts, read, states, notes = [], [], [], list(file.notes)
    for table in tables:
        columns = MaterialColumns(file, table, given)
        form = form_of(columns)
        if not table.rows or form is None:
            headings = opened._replace(tables=[table]).headings
            notes.append(f"ignored a table without sweeps: {headings}")
            continue
        part = _part(columns, form)
        omega, temperature = part.angular_frequency, part.temperature
        one_state = np.ptp(omega) <= 1e-3 * omega[0] and not np.ptp(temperature) > GAP
        # a single point is a state of its own, if its temperature tells it from others
        if one_state and (omega.size > 1 or (len(tables) > 1 and np.all(np.isnan(temperature)))):
            states.append(columns)
            notes.append(f"ignored the table from line {table.rows[0][0]}: {_ONE_STATE}")
            continue
        parts.append(part)
        read.append(columns)
        notes += columns.notes
    if states and not parts:
        raise states[0].error(f"{_ONE_STATE}; expected several frequencies or temperatures")
    if not parts:
        raise opened.lacks("dma")
    refuse_pooled(read)
    if len({part.kind for part in parts}) > 1:
        raise file.error("some tables are tensile (E), others shear (G); set `kind` to one")
    source = opened.source(notes)
    # a single table keeps its own sweep numbers
    return numbered_on(parts, source) if len(parts) > 1 else replace(parts[0], source=source)


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
            f"a loss tangent of {tangent:.2g} is that of no solid; check both units"
        )
    columns.notes += doubtful_modulus(np.hypot(values["storage"], values["loss"])[keep])
    rows = np.column_stack([column[keep] for column in values.values()])
    _, first = np.unique(rows, axis=0, return_index=True)
    if first.size < len(rows):
        columns.notes.append(f"{len(rows) - first.size} repeated rows removed")
    values = dict(zip(values, rows[np.sort(first)].T, strict=True))
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
        name = columns.name("phase")
        raise columns.error(f'"{name}" is {angle[row]:g} rad, not 0 to 90 degrees', row)
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
            raise columns.error(f"{modulus[row]:g} Pa exceeds diamond's; check its unit", row)


def _agree(columns: MaterialColumns, storage: Array, loss: Array) -> None:
    """Raise an error if tan(delta) or |E*| contradicts the storage and loss modulus of its row."""
    digits = [columns.resolution(name) * columns.factor(name) for name in ("storage", "loss")]
    others: list[tuple[str, float, Array, Array]] = []
    if "tan_delta" in columns:
        with np.errstate(divide="ignore", invalid="ignore"):
            tangent = loss / storage
            slack = (digits[1] + np.abs(tangent) * digits[0]) / np.abs(storage)
        others.append(("tan_delta", 1.0, tangent, slack))
    if "magnitude" in columns and not columns.lacking("magnitude"):
        size = np.hypot(storage, loss)
        others.append(("magnitude", columns.factor("magnitude"), size, digits[0] + digits[1]))
    for name, factor, expected, slack in others:
        found = factor * columns.numbers(name, needed=False)
        off = np.abs(found - expected) - slack - factor * columns.resolution(name)
        for row in np.flatnonzero(off > _DAMAGED * np.abs(expected)):
            said = f'"{columns.name(name)}" is {found[row]:g}, but the moduli give'
            raise columns.error(f"{said} {expected[row]:g}; check its unit", row)
        rows = np.flatnonzero(off > _TOLERANCE * np.abs(expected))
        if rows.size:
            worst = float(np.max(np.abs(found / expected - 1)[rows]))
            columns.notes.append(
                f'"{columns.name(name)}" differs by up to {100 * worst:.2g} % from that of storage '
                "and loss modulus, as where an instrument averages it over cycles; it is not used"
            )


# ---- step tests and shift factors ----------------------------------------------------------------


def tests(kind: type[Test], opened: Opened) -> list[Test]:
    """Return the tests of a kind in a file, one per temperature.

    Rows with monotonic time are one test, whose temperature may drift.
    """
    wanted, over, under, test = _MEASURED[kind]
    candidates = [
        columns
        for columns in opened.columns
        if ("time" in columns or "step_time" in columns)
        and (wanted in columns or over in columns)
        and (wanted in columns or under in columns or under in columns.table.levels)
    ]
    if not candidates:
        raise opened.lacks(test)
    # of several steps, select the one with constant stress or strain
    candidates = [one for one in candidates if test_of(one) == test] or candidates
    if len(candidates) > 1:
        numbers = ", ".join(str(one.table.number) for one in candidates)
        raise opened.file.error(f"tables {numbers} have a {test} test; choose one by `table`")
    columns, start = candidates[0], opened.given.step_start
    # prefer the time since the step to the time of the whole test
    timed = "step_time" if "step_time" in columns else "time"
    needed = (wanted,) if wanted in columns else (over, under)
    modulus = kind_of(columns, needed, timed, "temperature")
    time = columns.si(timed) - start
    if columns.is_clock(timed) and not start and np.nanmin(time) > np.ptp(time):
        begins = f'"{columns.name(timed)}" begins at {np.nanmin(time):g} s'
        raise columns.error(f"{begins}, a time of day; set `step_start`")
    if not start and timed == "time":
        _refuse_late_start(columns, time)
    if wanted in columns:
        values = columns.si(wanted)
    else:
        values = columns.si(over)
        step: Any = columns.table.levels.get(under)
        if under in columns:
            step = columns.si(under)
            columns.keep &= step != 0
            step = np.where(step == 0, math.nan, step)
        values = values / step
        columns.notes.append(f"{wanted} from {over} over {under}")
    if "strain" in needed and "strain" in columns and not columns.has_unit("strain"):
        columns.notes.append(f'"{columns.name("strain")}" has no unit; a fraction is assumed')
    level = columns.table.levels.get(under)
    if under in columns:
        _leave_out_what_is_not_held(columns, under, test)
        held = np.abs(columns.factor(under) * columns.numbers(under, needed=False))
    temperature = temperatures(columns)
    if wanted == "modulus":
        refuse_stiffer_than_diamond(columns, values)
        columns.notes += doubtful_modulus(values[np.isfinite(values) & (values > 0)])
    kelvins = np.nan_to_num(np.round(temperature))
    columns.states = list(zip(kelvins, np.round(time, 9), strict=True))
    refuse_pooled([columns])
    keep = kept(columns, time, values)
    if under in columns:
        held = held[columns.keep & np.isfinite(held)]
        level = float(np.median(held)) if held.size else None
    time, values, temperature = time[keep], values[keep], temperature[keep]
    steps = np.diff(time)
    runs_on = np.all(steps > 0) or np.all(steps < 0)
    whole = runs_on or np.any(np.isnan(temperature))
    source = opened.source([*opened.file.notes, *columns.notes])
    found = []
    for part in [np.arange(time.size)] if whole else levels(temperature):
        known = temperature[part][~np.isnan(temperature[part])]
        if known.size and np.ptp(known) > _DRIFT:
            raise columns.error(f"the temperature varies by {np.ptp(known):.3g} K in one step")
        mean = float(np.mean(known)) if known.size else None
        stated: dict[str, Any] = {under: level, "temperature": mean}
        found.append(kind(time[part], values[part], modulus, source=source, **stated))
    return found


def shifts(opened: Opened) -> TabulatedShift:
    """Return the shift factors of a file, as log10."""
    columns = next((one for one in opened.columns if _has_shifts(one)), None)
    if columns is None:
        raise opened.lacks("shifts")
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
        raise columns.error("the shifts rise with temperature; give 1/a_T, above 1 in the cold")
    return table


def _has_shifts(columns: MaterialColumns) -> bool:
    return "temperature" in columns and ("log10_shift" in columns or "shift" in columns)


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
        begins = f'"{columns.name("time")}" begins at {start:g} s, where the table before it ends'
        raise columns.error(f'{begins}: set `step_start` to "{np.nanmax(end):g} s"')


def _leave_out_what_is_not_held(columns: MaterialColumns, quantity: str, test: str) -> None:
    """Remove the points before and after the step; raise an error if there is no step."""
    held = columns.held(quantity)
    left = int(np.count_nonzero(columns.keep & ~held))
    if 2 * left > np.count_nonzero(columns.keep):
        off = f'{left} of {held.size} points of "{columns.name(quantity)}" are over 5 % off'
        raise columns.error(f"{off} its level; a {test} test needs a constant {quantity}")
    if left:
        columns.notes.append(f"rejected {left} points: the {quantity} is over 5 % off its level")
    columns.keep &= held


def _log10(columns: MaterialColumns, quantity: str) -> Array:
    values = columns.numbers(quantity)
    for row in np.flatnonzero(values <= 0):
        name = columns.name(quantity)
        raise columns.error(f'a shift must be positive, got {values[row]:g} in "{name}"', row)
    return np.log10(values)
