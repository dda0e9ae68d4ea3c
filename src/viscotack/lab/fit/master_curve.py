"""Master curves: time-temperature superposition of sweeps and tests at many temperatures.

A time t at temperature T is shifted to t/a_T, as a frequency 1/t is shifted to omega a_T. With one
curve per temperature, there is no second modulus to separate a vertical shift from a time shift; on
the plateau of a melt this matters, and the stated uncertainty includes it.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.grouping import GAP, refuse_unlike
from viscotack.lab.joining import joined_source
from viscotack.lab.sweeps import CreepTest, FrequencySweeps, MasterCurve, RelaxationTest, ShiftTable
from viscotack.materials.shift import WLF, Arrhenius, Shift, TabulatedShift

from .kramers_kronig import causal_misfit
from .overlap import Curve
from .shift_factors import (
    FEWEST,
    THERMOMETER,
    shift_factors,
    shifts_between,
    temperature_levels,
    thinned,
)

# methods that use most of the data come first
_WAYS = (("both", "none"), ("storage", "none"))
_CAUSAL = 0.03  # Kramers-Kronig misfit within the accuracy of rheometers
_CLEARLY = 0.8  # ratio of misfits that counts as clearly better
_PARTS = {
    "both": "storage and loss",
    "storage": "storage alone",
    "loss": "loss alone",
    "tan": "the loss tangent",
}


def master_curve(
    sweeps: FrequencySweeps,
    *,
    reference_temperature: float | None,
    shift: Shift | ShiftTable | None = None,
    by: str | None = None,
    vertical: str | float | None = None,
) -> MasterCurve:
    r"""Shift all sweeps to one temperature, ascending in frequency.

    A point at omega and T is shifted to omega a_T. With a shift law, a temperature ramp at
    one frequency also gives a master curve (Sec. 4.6.1 of Maghami, PhD thesis (2025)).

    Parameters
    ----------
    sweeps : FrequencySweeps
        Measured points.
    reference_temperature : float or None
        Temperature of the curve [K]. None only for sweeps at one temperature, known or
        unknown, which are not shifted.
    shift : WLF, Arrhenius, TabulatedShift or ShiftTable, optional
        A law is taken relative to the reference temperature and shifts every point by its own
        temperature. A row of a table shifts the points within 1 K of it, vertically as well;
        between rows it is interpolated. By default the shifts follow from the
        overlap of neighbouring sweeps, see :func:`shift_factors`.
    by : {"both", "storage", "loss", "tan"}, optional
        Which moduli must superpose, for shifts from overlap. If both `by` and `vertical` are None,
        :func:`most_carried` chooses; with `vertical` alone, both moduli.
    vertical : {"auto", "none", "free"} or float, optional
        Allowed vertical shift, for shifts from overlap, see
        :func:`shift_factors`; by default "none".

    Returns
    -------
    MasterCurve
        Includes the shift of each temperature and, for shifts from overlap, its uncertainty.

    Raises
    ------
    ValueError
        If temperatures are unknown, a law is undefined at one of them, overlap does not
        determine the shifts, or sweeps at one temperature contradict each other.

    References
    ----------
    Williams, Landel & Ferry (1955), doi:10.1021/ja01619a008.

    Examples
    --------
    A temperature ramp at 1 Hz, shifted to 20 C:

    >>> ramp = FrequencySweeps(
    ...     [173.15, 293.15], [6.283, 6.283], [1.2e8, 2e6], [6e7, 1e5], "E", [0, 0]
    ... )
    >>> wlf = WLF.from_glass_transition(158.15)
    >>> curve = master_curve(ramp, reference_temperature=293.15, shift=wlf)
    >>> [f"{omega:.3g}" for omega in curve.angular_frequency]
    ['6.28', '3.07e+09']
    """
    refuse_unlike(sweeps)
    if reference_temperature is None:
        return _unshifted(sweeps, shift)
    if np.any(np.isnan(sweeps.temperature)):
        raise InputError("the temperature of some points is unknown; set --temperature")
    if shift is not None and (by is not None or vertical is not None):
        raise InputError("by and vertical apply to shifts from overlap only; omit shift=")
    reference_temperature = float(reference_temperature)
    if shift is None:
        if np.ptp(sweeps.temperature) <= GAP and _near(sweeps.temperature, reference_temperature):
            return replace(_unshifted(sweeps, None), reference_temperature=reference_temperature)
        _refuse_ramp(sweeps)
        if by is None and vertical is None:
            return most_carried(sweeps, reference_temperature=reference_temperature)
        by, vertical = by or "both", "none" if vertical is None else vertical
        shift = shift_factors(
            sweeps, reference_temperature=reference_temperature, by=by, vertical=vertical
        )
        how = f"shifts from the overlap of {_PARTS[by]}, {moved_words(vertical)}"
    else:
        how = shift_words(shift)
    levels = np.array([float(np.mean(t.temperature)) for t in temperature_levels(sweeps)])
    horizontal, up, table = shifted_by(shift, sweeps.temperature, levels, reference_temperature)
    return MasterCurve(
        reference_temperature=reference_temperature,
        angular_frequency=sweeps.angular_frequency * 10**horizontal,
        storage=sweeps.storage * 10**up,
        loss=sweeps.loss * 10**up,
        kind=sweeps.kind,
        shifts=table,
        source=sweeps.source.noted(f"{how}, reference {reference_temperature:.2f} K"),
        temperature=sweeps.temperature,
        sweep=sweeps.sweep,
    )


def most_carried(sweeps: FrequencySweeps, *, reference_temperature: float) -> MasterCurve:
    """Return the master curve of the shift method that uses most of the data.

    The first choice superposes both moduli. If this does not determine the shifts, or if those of
    storage alone give a clearly more causal pair (Kramers-Kronig, equal weights), they are used
    instead, and a note states so. Moduli do not move vertically.

    Raises
    ------
    ValueError
        As :func:`shift_factors`, if no method determines the shifts.
    """
    best, misfit, first = None, np.inf, None
    for by, vertical in _WAYS:
        try:
            curve = master_curve(
                sweeps, reference_temperature=reference_temperature, by=by, vertical=vertical
            )
        except InputError as error:
            first = first or error
            continue
        off = causal_misfit(curve)
        total = np.inf if off is None else float(np.hypot(*off))
        if best is None or total < _CLEARLY * misfit:
            best, misfit = curve, total
        if misfit < _CAUSAL:
            break  # no improvement possible
    if best is None:
        raise first or InputError("overlap does not determine the shifts")
    if first is None:
        return best
    note = f"storage and loss do not determine the shifts: {first}"
    return replace(best, source=best.source.noted(note))


def moved_words(vertical: str | float) -> str:
    """Describe the allowed vertical shift in a few words."""
    words = {
        "auto": "moduli shifted vertically as the data determine",
        "none": "moduli not shifted vertically",
        "free": "moduli shifted vertically without restriction",
    }
    if isinstance(vertical, str):
        return words[vertical]
    return f"moduli shifted vertically by density and temperature, expansion {vertical:g} 1/K"


def _unshifted(sweeps: FrequencySweeps, shift: Shift | ShiftTable | None) -> MasterCurve:
    known = not np.any(np.isnan(sweeps.temperature))
    if shift is not None or (known and np.ptp(sweeps.temperature) > GAP):
        raise InputError("sweeps at several temperatures, or a shift, need reference_temperature=")
    return MasterCurve(
        reference_temperature=float(np.mean(sweeps.temperature)) if known else None,
        angular_frequency=sweeps.angular_frequency,
        storage=sweeps.storage,
        loss=sweeps.loss,
        kind=sweeps.kind,
        source=sweeps.source,
        temperature=sweeps.temperature,
        sweep=sweeps.sweep,
    )


def shifted_by(
    shift: Shift | ShiftTable, temperature: Array, levels: Array, reference: float
) -> tuple[Array, Array, ShiftTable]:
    """Return the horizontal and vertical shift of each point, and the table at the levels."""
    if isinstance(shift, ShiftTable):
        return *_by_table(temperature, shift, reference), shift
    law = shift.at_reference(reference)
    horizontal = np.asarray(law.log10_shift(temperature))
    table = ShiftTable(levels, np.asarray(law.log10_shift(levels)), None)
    return horizontal, np.zeros_like(horizontal), table


def _by_table(temperature: Array, table: ShiftTable, reference: float) -> tuple[Array, Array]:
    """Return the horizontal and the vertical shift of each point."""
    vertical = np.zeros(len(table)) if table.log10_vertical is None else table.log10_vertical
    return (
        _interpolated(temperature, table.temperature, table.log10_shift, reference),
        _interpolated(temperature, table.temperature, vertical, reference),
    )


def _interpolated(temperature: Array, rows: Array, values: Array, reference: float) -> Array:
    """Interpolate a column of a table at each temperature, minus its value at the reference.

    A point within 1 K of a row uses that row, because chambers never reach their set point exactly.
    """
    asked = np.append(temperature, reference)
    nearest = np.argmin(np.abs(asked[:, None] - rows), axis=1)
    found = values[nearest].astype(float)
    beside = np.abs(asked - rows[nearest]) > GAP
    # the reference is interpolated, not rounded to a row
    beside[-1] = rows[0] < reference < rows[-1]
    if beside.any():
        if rows.size < 2:
            raise InputError(
                f"the table of shifts has one row, at {rows[0]:.2f} K; "
                f"a shift at {asked[beside][0]:.2f} K is needed"
            )
        curve = TabulatedShift(float(rows[0]), tuple(rows), tuple(values))
        found[beside] = values[0] + np.asarray(curve.log10_shift(asked[beside]))
    return found[:-1] - found[-1]


def _refuse_ramp(sweeps: FrequencySweeps) -> None:
    omega = sweeps.angular_frequency
    if np.ptp(omega) <= 1e-3 * omega[0] and np.ptp(sweeps.temperature) > GAP:
        raise InputError(
            "a temperature ramp at one frequency has no overlap; give "
            "shift=WLF.from_glass_transition(...) or another law"
        )


def _near(temperature: Array, reference: float) -> bool:
    return bool(np.all(np.abs(temperature - reference) <= GAP))


def shift_words(shift: Shift | ShiftTable) -> str:
    """Describe the applied shift in a few words."""
    return f"shifted by {shift.words() if isinstance(shift, WLF | Arrhenius) else 'a table'}"


Test = TypeVar("Test", RelaxationTest, CreepTest)


def superposed(
    tests: Sequence[Test],
    *,
    reference_temperature: float,
    shift: Shift | ShiftTable | None = None,
    vertical: str | float = "none",
    temperature_uncertainty: float = THERMOMETER,
) -> tuple[Test, ShiftTable]:
    """Superpose tests at several temperatures; return one test and the shifts.

    Parameters
    ----------
    tests : sequence of RelaxationTest, or of CreepTest
        One or more, each with its temperature and four or more points; all of one kind of modulus.
    reference_temperature : float
        Temperature of the result [K].
    shift : WLF, Arrhenius, TabulatedShift or ShiftTable, optional
        As in :func:`viscotack.lab.master_curve`; without it the shifts follow from overlap.
    vertical, temperature_uncertainty
        As in :func:`viscotack.lab.shift_factors`. With one curve per temperature, "auto" assumes
        typical vertical shifts where the curve is straight; a coefficient of expansion is more
        exact. By default "none".

    Returns
    -------
    test : RelaxationTest or CreepTest
        All points at the reference temperature, ascending in time.
    shifts : ShiftTable
        Shift of each temperature.

    Raises
    ------
    ValueError
        If the tests are of different kinds, a temperature is unknown, two tests have the same
        temperature, or overlap does not determine the shifts.

    Examples
    --------
    A solid with one relaxation time, ten times faster at a temperature 10 K higher:

    >>> time = np.geomspace(0.1, 10, 20)
    >>> cold = RelaxationTest(time, 1e6 * (1 + np.exp(-time)), "G", temperature=293.15)
    >>> hot = RelaxationTest(time, 1e6 * (1 + np.exp(-10 * time)), "G", temperature=303.15)
    >>> curve, shifts = superposed([hot, cold], reference_temperature=293.15)
    >>> len(curve), [round(float(value), 1) for value in shifts.log10_shift]
    (40, [0.0, -1.0])
    """
    ordered = _ordered(tests)
    temperature = np.array([test.temperature for test in ordered], dtype=float)
    if shift is None:
        shift, how = _shifts_of_tests(
            ordered, temperature, reference_temperature, vertical, temperature_uncertainty
        )
    else:
        how = shift_words(shift)
    slower, up, table = shifted_by(shift, temperature, temperature, reference_temperature)
    first = ordered[0]
    sources = list(dict.fromkeys(test.source for test in ordered))
    one = first.source if len(sources) == 1 else joined_source(sources)
    source = one.noted(f"{how}; {len(ordered)} tests, reference {reference_temperature:.2f} K")
    time = np.concatenate([t.time / 10**s for t, s in zip(ordered, slower, strict=True)])
    column = "modulus" if isinstance(first, RelaxationTest) else "compliance"
    sign = 1 if column == "modulus" else -1
    values = [getattr(test, column) * 10 ** (sign * v) for test, v in zip(ordered, up, strict=True)]
    answer = replace(
        first,
        time=time,
        temperature=float(reference_temperature),
        source=source,
        **{column: np.concatenate(values)},
    )
    return answer, table


def _shifts_of_tests(
    tests: Sequence[RelaxationTest | CreepTest],
    temperature: Array,
    reference: float,
    vertical: str | float,
    uncertainty: float,
) -> tuple[ShiftTable, str]:
    """Return the shifts from overlap, and the method in words."""
    table = shifts_between(
        temperature,
        [_curve_of_test(test) for test in tests],
        reference_temperature=reference,
        by="both",
        vertical=vertical,
        temperature_uncertainty=uncertainty,
    )
    return table, f"shifts from the overlap of the tests, {moved_words(vertical)}"


def _ordered(tests: Sequence[Test]) -> list[Test]:
    """Return the tests from cold to hot."""
    if not tests:
        raise InputError("superposition needs one or more tests, got none")
    kinds = {(type(test).__name__, test.kind) for test in tests}
    if len(kinds) > 1:
        words = " and ".join(sorted(f"{name} ({kind})" for name, kind in kinds))
        raise InputError(f"only tests of one kind can be superposed, got {words}")
    unknown = [test.source.path or "a test" for test in tests if test.temperature is None]
    if unknown:
        raise InputError(f"the temperature of {unknown[0]} is unknown; set --temperature")
    ordered = sorted(tests, key=lambda test: test.temperature or 0.0)
    temperature = np.array([test.temperature for test in ordered], dtype=float)
    near = np.flatnonzero(np.diff(temperature) <= GAP)
    if near.size:
        raise InputError(
            f"two tests have the same temperature, {temperature[near[0]]:.2f} K; superpose only "
            "one of them"
        )
    return ordered


def _curve_of_test(test: RelaxationTest | CreepTest) -> Curve:
    """Return the modulus, or the inverse compliance, of a test as a curve over -log10(time)."""
    x = -np.log10(test.time[::-1])
    if x.size < FEWEST or np.ptp(x) < 0.1:
        raise InputError(
            f"{x.size} points at {test.temperature:.2f} K are too few to find a shift from "
            "overlap; give a shift law (--wlf, --shift-file) or omit this test (--leave-out)"
        )
    if isinstance(test, RelaxationTest):
        return thinned(Curve(x, (np.log10(test.modulus[::-1]),)))
    return thinned(Curve(x, (-np.log10(test.compliance[::-1]),)))
