"""What was measured at several temperatures as one test at one temperature."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.lab.sweeps import (
    GAP,
    CreepTest,
    FrequencySweeps,
    MasterCurve,
    RelaxationTest,
)
from viscotack.model.materials.shift import WLF, Shift, TabulatedShift

from .master_curve import contradiction, master_curve, superposed
from .superposition import superposition

Tests = RelaxationTest | CreepTest | tuple[RelaxationTest, ...] | tuple[CreepTest, ...]


def at_one_temperature(
    measured: FrequencySweeps | Tests,
    *,
    reference_temperature: float | None,
    shift: Shift | None = None,
    by: str | None = None,
    vertical: str | float | None = None,
    leave_out: Sequence[float] = (),
) -> tuple[MasterCurve | RelaxationTest | CreepTest, WLF | TabulatedShift | None, tuple[str, ...]]:
    """Return one test at one temperature, the shift of its times, and doubts about it.

    Parameters
    ----------
    measured : FrequencySweeps, or tests over time
        What was measured, at one or several temperatures.
    reference_temperature : float or None
        Temperature of the result [K]; None only where there is one temperature.
    shift, by, vertical
        As in :func:`.master_curve`; tests over time have one curve a temperature, and no `by`.
    leave_out : sequence of float
        Temperatures [K] of sweeps or tests that are not used.

    Raises
    ------
    InputError
        If a temperature that is left out was not measured, or nothing else was; as
        :func:`.master_curve` and :func:`.superposed`.
    """
    several: Any = (measured,) if isinstance(measured, RelaxationTest | CreepTest) else measured
    for kelvin in leave_out:
        if isinstance(several, FrequencySweeps):
            several = several.chosen(
                _others(several.temperature, kelvin, several.source.path.split(", "))
            )
        else:
            known = np.array([t.temperature for t in several], dtype=float)
            keep = _others(known, kelvin, [t.source.path for t in several])
            several = tuple(t for t, kept in zip(several, keep, strict=True) if kept)
    if isinstance(several, FrequencySweeps):
        curve = master_curve(
            several,
            reference_temperature=reference_temperature,
            shift=shift,
            by=by,
            vertical=vertical,
        )
        cautions = [contradiction(curve)]
        if curve.shifts is not None:
            cautions += superposition(several, curve.shifts)
        table, doubts = curve.shifts, tuple(words for words in cautions if words)
    elif reference_temperature is None:
        if len(several) > 1 or vertical is not None:
            raise InputError(
                "needed, the temperature of the result, for tests at several temperatures",
                field="reference_temperature",
            )
        curve, table, doubts = several[0], None, ()
    else:
        vertical = "none" if vertical is None else vertical
        how: Any = {"reference_temperature": reference_temperature, "vertical": vertical}
        curve, table = superposed(several, shift=shift, **how)
        doubts = ()
    return curve, shift if isinstance(shift, WLF) else table, doubts


def _others(temperature: Any, asked: float, paths: Sequence[str]) -> Any:
    """Return which points are not of the sweep at a temperature [K]."""
    near = np.abs(temperature - asked) <= GAP
    paths = list(dict.fromkeys(paths))
    file = ", ".join(paths) if len(paths) < 4 else f"{paths[0]} and {len(paths) - 1} more"
    if not near.any():
        known = np.unique(np.round(temperature[np.isfinite(temperature)] - 273.15))
        there = ", ".join(f"{T:g} C" for T in known) or "temperatures that it does not say"
        raise InputError(
            f"leave_out: {file}: no test within 1 K of {asked - 273.15:.4g} C; there are some at "
            f"{there}",
            field="leave_out",
        )
    if near.all():
        words = f"leave_out: without {asked - 273.15:.4g} C nothing is left of {file}"
        raise InputError(words, field="leave_out")
    return ~near
