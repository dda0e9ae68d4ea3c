"""Tests at several temperatures as one test at one temperature, and whether they superpose.

A best shift always exists; whether the shifted sweeps form one curve is a separate question. The
test of it down-weights no outlier, and both moduli have equal weights.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.polynomial import Chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import (
    GAP,
    CreepTest,
    FrequencySweeps,
    MasterCurve,
    RelaxationTest,
    celsius,
)
from viscotack.model.materials.shift import WLF, Shift, TabulatedShift

from .master_curve import contradiction, master_curve, shifted_by, superposed
from .overlap import Curve
from .shift_factors import BEST, FEWEST, level_curves, steps_between, temperature_levels

_TOLERANCE = 0.1  # relative deviation from one curve above which sweeps do not superpose
_APART = 0.1  # decades; larger differences contradict each other
_SIGMAS = 3.0
_POINTS = 3  # smallest number of points of each sweep in the overlap for a comparison


def superposition(sweeps: FrequencySweeps, shifts: TabulatedShift) -> tuple[str, ...]:
    """Return the contradictions to superposition of shifted sweeps where neighbours overlap.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Measured sweeps, at two or more temperatures.
    shifts : TabulatedShift
        Shifts to test, from any method; interpolated between the rows of the table.

    Returns
    -------
    tuple of str
        A sentence for each contradiction; empty if the sweeps superpose.

    Raises
    ------
    ValueError
        If the table does not cover all temperatures of the sweeps.

    Examples
    --------
    >>> omega = np.geomspace(1, 100, 10)
    >>> sweeps = FrequencySweeps(
    ...     np.repeat([293.15, 303.15], 10),
    ...     np.tile(omega, 2),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     "E",
    ...     np.repeat([0, 1], 10),
    ... )
    >>> superposition(sweeps, TabulatedShift(293.15, (293.15, 303.15), (0.0, -1.0)))
    ()
    """
    temperature, levels = temperature_levels(sweeps)
    along, up, _ = shifted_by(shifts, temperature, temperature, shifts.temperature[0])
    shapely = [i for i, level in enumerate(levels) if len(level) >= FEWEST]
    curves = level_curves(temperature[shapely], [levels[i] for i in shapely])
    pairs = list(pairwise(shapely))
    between = [
        f"those at {celsius(temperature[i])} and {celsius(temperature[j])}" for i, j in pairs
    ]
    found = []
    moved = [c.moved(along[i], up[i]) for i, c in zip(shapely, curves, strict=True)]
    scatters = np.array([_scatters(a, b) for a, b in pairwise(moved)]).reshape(-1, 2, 2)
    for name, (common, own) in zip(("storage", "loss"), np.moveaxis(scatters, 0, -1), strict=True):
        # two noisy sweeps may still superpose
        off = common > np.maximum(np.log1p(_TOLERANCE), 2 * own)
        if off.any():
            worst = int(np.argmax(np.where(off, common, 0)))
            found.append(
                f"sweeps do not superpose in {name}: {between[worst]} differ by "
                f"{100 * np.expm1(common[worst]):.2g} % where they overlap ({off.sum()} such "
                "pairs): moduli that move with temperature (`vertical`), a glass, two "
                "processes or a faulty sweep (`leave_out`)"
            )
    try:
        steps = steps_between(temperature[shapely], curves, *BEST)
    except InputError:
        return tuple(found)
    used = np.array([along[j] - along[i] for i, j in pairs])
    asked = np.array([step.shift for step in steps])
    doubt = np.sqrt([step.variance + step.common**2 for step in steps])
    apart = np.abs(used - asked)
    off = apart > np.maximum(_APART, _SIGMAS * doubt)
    if off.any():
        worst = int(np.argmax(np.where(off, apart, 0)))
        found.append(
            f"storage and loss modulus give other shifts than those used: {between[worst]} are "
            f"shifted by {used[worst]:.2f} decades, not {asked[worst]:.2f} +- {doubt[worst]:.2f} "
            f"({off.sum()} such steps)"
        )
    return tuple(found)


def _scatters(a: Curve, b: Curve) -> list[tuple[float, float]]:
    """Return the scatter of each modulus about a common curve, and about separate curves.

    nan where too few points overlap.
    """
    low, high = max(a.x[0], b.x[0]) - 1e-9, min(a.x[-1], b.x[-1]) + 1e-9
    one, other = (c.chosen((c.x >= low) & (c.x <= high)) for c in (a, b))
    if min(one.x.size, other.x.size) < _POINTS:
        return [(np.nan, np.nan)] * 2
    x = np.concatenate((one.x, other.x))
    return [
        (
            _scatter(x, np.concatenate((ya, yb))),
            float(np.hypot(_scatter(one.x, ya), _scatter(other.x, yb)) / np.sqrt(2)),
        )
        for ya, yb in zip(one.y, other.y, strict=True)
    ]


def _scatter(x: Array, y: Array) -> float:
    """Return the scatter of ln(y) about the polynomial with the smallest one."""
    left = []
    # a temperature measured twice repeats its frequencies
    for degree in range(max(min(5, np.unique(np.round(x, 3)).size - 2), 0) + 1):
        residual = y - Chebyshev.fit(x, y, degree)(x)
        left.append(float(np.sum(residual**2)) / (x.size - degree - 1))
    return float(np.log(10) * np.sqrt(min(left)))


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
        words = f"without {celsius(asked)} nothing is left of {file}"
        if not near.any():
            known = np.unique(np.round(temperature[keep & np.isfinite(temperature)] - 273.15))
            there = ", ".join(f"{T:g} C" for T in known) or "temperatures that it does not say"
            words = f"{file}: no test within 1 K of {celsius(asked)}; there are some at {there}"
        keep &= ~near
        if not (near.any() and keep.any()):
            raise InputError(f"leave_out: {words}", field="leave_out")
    return keep
