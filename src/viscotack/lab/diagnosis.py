"""What a file holds that was asked for something else, in words: the true cause of a refusal."""

from collections.abc import Sequence

from .arrays import KINDS
from .columns import Columns

TESTS = ("dma", "relaxation", "creep", "shifts")


def test_of(columns: Columns) -> str | None:
    """Return which test the columns of a table belong to, or None.

    Where stress and strain are both there, what was held says which test it was.
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


def has_sweep(columns: Columns) -> bool:
    """Return whether there are a frequency and two numbers that make a complex modulus."""
    if not ("frequency" in columns or "angular_frequency" in columns):
        return False
    angle = "phase" in columns or "tan_delta" in columns
    return ("storage" in columns and ("loss" in columns or angle)) or (
        "magnitude" in columns and angle
    )


def cause(tables: Sequence[Columns], wanted: str, kind: str | None) -> str:
    """Return why the tables of a file have not the test that was asked for.

    Parameters
    ----------
    tables : sequence of Columns
        Of the whole file, without regard to the kind that was asked for.
    wanted : str
        One of :data:`TESTS`.
    kind : {"E", "G"} or None
        What was asked for.
    """
    if not any(columns.table.rows for columns in tables):
        return "below its headings are no numbers"
    tests = {test_of(columns) for columns in tables if columns.table.rows} - {None}
    if wanted in tests and kind:
        other = "G" if kind == "E" else "E"
        return (
            f"its moduli are of {KINDS[other]} ({other}) and --kind {kind} asks for "
            f"{KINDS[kind]}; leave --kind out, --poisson-ratio turns one into the other"
        )
    for test in TESTS:
        if test in tests and test != wanted:
            words = {
                "dma": "frequency sweeps, --test dma",
                "relaxation": "a stress relaxation test, --test relaxation",
                "creep": "a creep test, --test creep",
                "shifts": "shift factors, --shift-file",
            }
            return f"it holds {words[test]}"
    return next(filter(None, (_nonlinear(columns) for columns in tables)), "")


def _nonlinear(columns: Columns) -> str:
    """Return what a table is that holds no linear viscoelastic test, or nothing."""
    timed = "time" in columns or "step_time" in columns
    flows = "shear_rate" in columns or "viscosity" in columns
    if flows and timed:
        return "it is the start-up or the course of a steady flow, not a test of linear response"
    if flows:
        return "it is a flow curve, viscosity or stress over shear rate, which holds no modulus"
    if timed and "stress" in columns:
        return "it has a stress over time without the strain: write the strain or the modulus"
    if timed and "strain" in columns:
        return "it has a strain over time without the stress: write the stress or the compliance"
    swept = "frequency" in columns or "angular_frequency" in columns
    if swept and ("storage" in columns or "magnitude" in columns):
        return "one number of the complex modulus is missing: a loss modulus or a loss angle"
    return ""


def _by_what_is_held(columns: Columns) -> str | None:
    spread = {}
    for quantity in ("stress", "strain"):
        try:
            inside = columns.held(quantity)
        except ValueError:
            return None
        spread[quantity] = inside.mean() if inside.size else 0.0
    if max(spread.values()) < 0.5 or spread["stress"] == spread["strain"]:
        return None
    return "creep" if spread["stress"] > spread["strain"] else "relaxation"
