"""What was measured at several temperatures as one test at one temperature."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
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
    if isinstance(measured, FrequencySweeps):
        paths = measured.source.path.split(", ")
        sweeps = measured.chosen(_kept(measured.temperature, leave_out, paths))
        curve = master_curve(
            sweeps,
            reference_temperature=reference_temperature,
            shift=shift,
            by=by,
            vertical=vertical,
        )
        table, doubts = curve.shifts, [contradiction(curve)]
        if table is not None:
            doubts += superposition(sweeps, table)
    else:
        tests: Any = (measured,) if isinstance(measured, RelaxationTest | CreepTest) else measured
        known = np.array([test.temperature for test in tests], dtype=float)
        keep = _kept(known, leave_out, [test.source.path for test in tests])
        tests = [test for test, kept in zip(tests, keep, strict=True) if kept]
        table, doubts = None, []
        if reference_temperature is not None:
            vertical = "none" if vertical is None else vertical
            how: Any = {"reference_temperature": reference_temperature, "vertical": vertical}
            curve, table = superposed(tests, shift=shift, **how)
        elif len(tests) > 1 or vertical is not None:
            raise InputError(
                "needed, the temperature of the result, for tests at several temperatures",
                field="reference_temperature",
            )
        else:
            curve = tests[0]
    return curve, shift if isinstance(shift, WLF) else table, tuple(filter(None, doubts))


def _kept(
    temperature: Array, leave_out: Sequence[float], paths: Sequence[str]
) -> npt.NDArray[np.bool_]:
    """Return which points are not of the sweeps at the temperatures [K] that are left out."""
    keep = np.ones(temperature.size, dtype=bool)
    paths = list(dict.fromkeys(paths))
    file = ", ".join(paths) if len(paths) < 4 else f"{paths[0]} and {len(paths) - 1} more"
    for asked in leave_out:
        near = keep & (np.abs(temperature - asked) <= GAP)
        words = f"without {asked - 273.15:.4g} C nothing is left of {file}"
        if not near.any():
            known = np.unique(np.round(temperature[keep & np.isfinite(temperature)] - 273.15))
            there = ", ".join(f"{T:g} C" for T in known) or "temperatures that it does not say"
            words = (
                f"{file}: no test within 1 K of {asked - 273.15:.4g} C; there are some at {there}"
            )
        keep &= ~near
        if not (near.any() and keep.any()):
            raise InputError(f"leave_out: {words}", field="leave_out")
    return keep
