"""Explain why a file lacks the requested test, from what its tables contain."""

from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise

import numpy as np

from viscotack.errors import InputError

from .formats.columns import MaterialColumns
from .sweeps import GAP

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
    if form_of(columns):
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


def sheets_with_test(tables: Sequence[MaterialColumns]) -> tuple[str, set[str], set[str]]:
    """Return the sheet with a test, the sheets read with it, and others with the same columns.

    It is the first sheet with a test, preferably with one that sweeps and lacks no unit. Sheets of
    sweeps with the same headings belong to one test if each has temperatures of its own.
    """

    def score(columns: MaterialColumns) -> tuple[bool, bool, bool]:
        test = test_of(columns) if columns.table.rows else None
        sweeps = test is not None and (test != "dma" or _sweeps(columns))
        return test is not None, sweeps, sweeps and not columns.lacking(*columns.quantities)

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
        return f"its moduli are not of `kind` {kind}; omit it, `poisson_ratio` converts them"
    for test in TESTS:
        if test in tests and test != wanted:
            return f"it contains {'a `shift_file`' if test == 'shifts' else f'`test` {test}'}"
    return next(filter(None, (_nonlinear(columns) for columns in tables)), "")


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
