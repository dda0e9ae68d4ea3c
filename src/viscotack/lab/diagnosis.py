"""Explain why a file lacks the requested test, from what its tables contain."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .arrays import KINDS
from .formats.columns import MaterialColumns
from .grouping import GAP

_SWEPT = 0.05  # relative range of a frequency or a temperature that is swept
# Pairs of columns that determine the complex modulus, the most direct ones first.
_FORMS = (
    ("storage", "loss"),
    *((size, angle) for size in ("storage", "magnitude") for angle in ("tan_delta", "phase")),
    ("dynamic_viscosity", "elastic_viscosity"),
    ("storage_compliance", "loss_compliance"),
    ("complex_viscosity", "tan_delta"),
    ("complex_viscosity", "phase"),
)
TESTS = ("dma", "relaxation", "creep", "shifts")


def test_of(columns: MaterialColumns) -> str | None:
    """Return the test that the columns of a table belong to, or None.

    If both stress and strain are present, the one held constant identifies the test.
    """
    if has_sweep(columns):
        return "dma"
    if "temperature" in columns and ("log10_shift" in columns or "shift" in columns):
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


def best_sheet(tables: Sequence[MaterialColumns]) -> str:
    """Return the first sheet with a test, preferably with one that sweeps and lacks no unit."""

    def score(columns: MaterialColumns) -> tuple[bool, bool, bool]:
        test = test_of(columns) if columns.table.rows else None
        sweeps = test is not None and (test != "dma" or _sweeps(columns))
        return test is not None, sweeps, sweeps and not columns.lacking(*columns.quantities)

    return max(tables, key=score).table.sheet


def sheets_with(sheet: str, tables: Sequence[MaterialColumns]) -> tuple[set[str], set[str]]:
    """Return the sheets that are read with a sheet, and others that have the same columns.

    Sheets of sweeps with the same headings belong to one test if each has temperatures of its own.
    """
    chosen = next(one for one in tables if one.table.sheet == sheet)
    headings = next(
        (x.table.headings for x in tables if x.table.sheet == sheet and _is_sweep(x)), ()
    )
    alike = [one for one in tables if one.table.headings == headings and _is_sweep(one)]
    names = {one.table.sheet for one in alike} or {chosen.table.sheet}
    found = sorted((float(t), one.table.sheet) for one in alike for t in _levels(one))
    known = {name for _, name in found} == names
    apart = all(b - a > GAP for (a, one), (b, other) in pairwise(found) if one != other)
    return (names, set()) if known and apart else ({sheet}, names - {sheet})


def _is_sweep(columns: MaterialColumns) -> bool:
    return bool(columns.table.rows) and test_of(columns) == "dma" and _sweeps(columns)


def _levels(columns: MaterialColumns) -> Array:
    """Return the temperatures of a table [K]; empty if they cannot be read."""
    try:
        kelvins = columns.temperature()
    except InputError:
        return np.empty(0)
    return np.unique(kelvins[np.isfinite(kelvins)])


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


def has_sweep(columns: MaterialColumns) -> bool:
    """Return whether the columns hold a frequency and two numbers that give a complex modulus."""
    swept = "frequency" in columns or "angular_frequency" in columns
    return swept and form_of(columns) is not None


def form_of(columns: MaterialColumns) -> tuple[str, str] | None:
    """Return the two columns from which a complex modulus follows, or None."""
    return next((form for form in _FORMS if all(name in columns for name in form)), None)


def cause(tables: Sequence[MaterialColumns], wanted: str, kind: str | None) -> str:
    """Return the reason why the tables of a file lack the requested test.

    Parameters
    ----------
    tables : sequence of MaterialColumns
        All tables of the file, whatever kind of modulus was requested.
    wanted : str
        One of :data:`TESTS`.
    kind : {"E", "G"} or None
        Requested kind.
    """
    if not any(columns.table.rows for columns in tables):
        return "there are no numbers below its headings"
    tests = {test_of(columns) for columns in tables if columns.table.rows} - {None}
    if wanted in tests and kind:
        other = "G" if kind == "E" else "E"
        return (
            f"its moduli are of {KINDS[other]} ({other}), but --kind {kind} requests "
            f"{KINDS[kind]}; omit --kind; --poisson-ratio converts one into the other"
        )
    for test in TESTS:
        if test in tests and test != wanted:
            words = {
                "dma": "frequency sweeps, --test dma",
                "relaxation": "a stress relaxation test, --test relaxation",
                "creep": "a creep test, --test creep",
                "shifts": "shift factors, --shift-file",
            }
            return f"it contains {words[test]}"
    return next(filter(None, (_nonlinear(columns) for columns in tables)), "")


def _nonlinear(columns: MaterialColumns) -> str:
    """Describe a table without a linear viscoelastic test; empty if unknown."""
    timed = "time" in columns or "step_time" in columns
    # a wave of large amplitude has its rate beside strain and stress
    waves = timed and "stress" in columns and "strain" in columns and "viscosity" not in columns
    if waves and "shear_rate" in columns:
        return (
            "it is strain, stress and rate over time, such as waves of a large amplitude; the "
            "moduli of a sweep are needed"
        )
    flows = "shear_rate" in columns or "viscosity" in columns
    if flows:
        return "it is a flow curve or the start-up of a steady flow: a shear rate or a viscosity"
    swept = "frequency" in columns or "angular_frequency" in columns
    if not swept and "storage" in columns and "strain" in columns:
        return "it is an amplitude sweep, a modulus over strain, without a column of frequency"
    if timed and "stress" in columns and "strain" in columns:
        return (
            "neither the stress nor the strain is held constant; a step and its recovery in one "
            "table must be separated"
        )
    if timed and "stress" in columns:
        return "it has a stress over time without the strain; add the strain or the modulus"
    if timed and "strain" in columns:
        return "it has a strain over time without the stress; add the stress or the compliance"
    if swept and ("storage" in columns or "magnitude" in columns):
        return "the complex modulus is incomplete; add a loss modulus or a loss angle"
    return ""


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
