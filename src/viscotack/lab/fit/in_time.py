"""Time-temperature superposition of relaxation and creep tests into one long test.

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
from viscotack.lab.grouping import GAP
from viscotack.lab.joining import joined_source
from viscotack.lab.sweeps import CreepTest, RelaxationTest, ShiftTable
from viscotack.materials.shift import Shift

from .master_curve import moved_words, shift_words, shifted_by
from .overlap import Curve
from .shift_factors import FEWEST, THERMOMETER, shifts_between, thinned

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
    ordered = _checked(tests)
    temperature = np.array([test.temperature for test in ordered], dtype=float)
    if shift is None:
        shift, how = _found(
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


def _found(
    tests: Sequence[RelaxationTest | CreepTest],
    temperature: Array,
    reference: float,
    vertical: str | float,
    uncertainty: float,
) -> tuple[ShiftTable, str]:
    """Return the shifts from overlap, and the method in words."""
    table = shifts_between(
        temperature,
        [_curve(test) for test in tests],
        reference_temperature=reference,
        by="both",
        vertical=vertical,
        temperature_uncertainty=uncertainty,
    )
    return table, f"shifts from the overlap of the tests, {moved_words(vertical)}"


def _checked(tests: Sequence[Test]) -> list[Test]:
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


def _curve(test: RelaxationTest | CreepTest) -> Curve:
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
