r"""Master curves: time-temperature superposition of sweeps and tests at many temperatures.

A time t at temperature T is shifted to t/a_T, as a frequency 1/t is shifted to omega a_T. With one
curve per temperature, there is no second modulus to separate a vertical shift from a time shift; on
the plateau of a melt this matters, and the stated uncertainty includes it.

Storage and loss modulus belong to one causal solid if they obey the relation of Kramers and Kronig,

.. math:: E''(\omega) = -\frac{2\omega}{\pi} \int_0^\infty \frac{E'(u)}{\omega^2 - u^2}\,du

(Eq. 4.26 of Maghami, PhD thesis (2025); principal value). A master curve that obeys it may still be
wrong, but one that violates it has a wrong shift, a faulty sweep or a compliance error of the rig.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import (
    GAP,
    CreepTest,
    FrequencySweeps,
    MasterCurve,
    RelaxationTest,
    joined_source,
    refuse_unlike,
)
from viscotack.model.materials.shift import WLF, Arrhenius, Shift, TabulatedShift

from .prony import nonnegative
from .shift_factors import curve, shift_factors, shifts_between, temperature_levels

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
    shift: Shift | None = None,
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
    shift : WLF, Arrhenius or TabulatedShift, optional
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
    temperature, reference = sweeps.temperature, reference_temperature
    unknown, many = bool(np.any(np.isnan(temperature))), bool(np.ptp(temperature) > GAP)
    if reference is None:
        if shift is not None or many:
            known = temperature[np.isfinite(temperature)] - 273.15
            between = f"{known.min(initial=np.inf):.1f} to {known.max(initial=-np.inf):.1f} C"
            raise InputError(
                f"sweeps from {between}, or with a shift, need `reference_temperature`"
            )
        return _moved(sweeps, None if unknown else float(np.mean(temperature)))
    if unknown:
        raise InputError("the temperature of some points is unknown; set `temperature`")
    if shift is not None and (by is not None or vertical is not None):
        raise InputError("by and vertical apply to shifts from overlap only; omit shift=")
    reference = float(reference)
    if shift is not None:
        how = _named(shift)
    elif not many and np.all(np.abs(temperature - reference) <= GAP):
        return _moved(sweeps, reference)
    elif many and np.ptp(sweeps.angular_frequency) <= 1e-3 * sweeps.angular_frequency[0]:
        alone = "a temperature ramp at one frequency has no overlap"
        raise InputError(f"{alone}; give a law, such as WLF by `glass_transition`, or a table")
    elif by is None and vertical is None:
        return most_carried(sweeps, reference_temperature=reference)
    else:
        by, vertical = by or "both", "none" if vertical is None else vertical
        shift = shift_factors(sweeps, reference_temperature=reference, by=by, vertical=vertical)
        how = f"shifts from the overlap of {_PARTS[by]}, {_moving(vertical)}"
    levels, _ = temperature_levels(sweeps)
    horizontal, up, table = shifted_by(shift, temperature, levels, reference)
    curve = _moved(sweeps, reference, 10**horizontal, 10**up, table)
    return replace(curve, source=curve.source.noted(f"{how}, reference {reference:.2f} K"))


def _moved(
    sweeps: FrequencySweeps,
    reference: float | None,
    along: Array | float = 1.0,
    up: Array | float = 1.0,
    table: TabulatedShift | None = None,
) -> MasterCurve:
    """Return all points as one curve, their frequencies and moduli multiplied."""
    return MasterCurve(
        reference,
        sweeps.angular_frequency * along,
        sweeps.storage * up,
        sweeps.loss * up,
        sweeps.kind,
        table,
        sweeps.source,
        sweeps.temperature,
        sweeps.sweep,
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

    def curve(by: str) -> MasterCurve:
        return master_curve(sweeps, reference_temperature=reference_temperature, by=by)

    def misfit(curve: MasterCurve) -> float:
        off = causal_misfit(curve)
        return np.inf if off is None else float(np.hypot(*off))

    try:
        both = curve("both")
    except InputError as error:
        try:
            storage = curve("storage")
        except InputError:
            raise error from None
        note = f"storage and loss do not determine the shifts: {error}"
        return replace(storage, source=storage.source.noted(note))
    off = misfit(both)
    if off < _CAUSAL:
        return both  # no improvement possible
    try:
        storage = curve("storage")
    except InputError:
        return both
    return storage if misfit(storage) < _CLEARLY * off else both


def _moving(vertical: str | float) -> str:
    """Describe the allowed vertical shift in a few words."""
    how = {"auto": " as the data determine", "none": "", "free": " without restriction"}
    if isinstance(vertical, str):
        return f"moduli {'not ' * (vertical == 'none')}shifted vertically{how[vertical]}"
    return f"moduli shifted vertically by density and temperature, expansion {vertical:g} 1/K"


def _named(shift: Shift) -> str:
    return f"shifted by {shift.words() if isinstance(shift, WLF | Arrhenius) else 'a table'}"


def shifted_by(
    shift: Shift, temperature: Array, levels: Array, reference: float
) -> tuple[Array, Array, TabulatedShift | None]:
    """Return the horizontal and vertical shift of each point, and the table at several levels."""
    if isinstance(shift, TabulatedShift):
        along, up = (
            _interpolated(temperature, np.array(shift.temperature), np.array(values), reference)
            for values in (shift.values, shift.vertical or np.zeros(len(shift)))
        )
        return along, up, shift
    law = shift.at_reference(reference)
    horizontal = np.asarray(law.log10_shift(temperature))
    rows = tuple(levels), tuple(np.atleast_1d(law.log10_shift(levels)))
    table = TabulatedShift(float(levels[0]), *rows) if levels.size > 1 else None
    return horizontal, np.zeros_like(horizontal), table


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
        curve = TabulatedShift(float(rows[0]), tuple(rows), tuple(values))
        found[beside] = values[0] + np.asarray(curve.log10_shift(asked[beside]))
    return found[:-1] - found[-1]


Test = TypeVar("Test", RelaxationTest, CreepTest)


def superposed(
    tests: Sequence[Test],
    *,
    reference_temperature: float,
    shift: Shift | None = None,
    vertical: str | float = "none",
) -> tuple[Test, TabulatedShift | None]:
    """Superpose tests at several temperatures; return one test and the shifts.

    Parameters
    ----------
    tests : sequence of RelaxationTest, or of CreepTest
        One or more, each with its temperature and four or more points; all of one kind of modulus.
    reference_temperature : float
        Temperature of the result [K].
    shift : WLF, Arrhenius or TabulatedShift, optional
        As in :func:`viscotack.lab.master_curve`; without it the shifts follow from overlap.
    vertical : {"none", "auto", "free"} or float
        As in :func:`viscotack.lab.shift_factors`. With one curve per temperature, "auto" assumes
        typical vertical shifts where the curve is straight; a coefficient of expansion is more
        exact. By default "none".

    Returns
    -------
    test : RelaxationTest or CreepTest
        All points at the reference temperature, ascending in time.
    shifts : TabulatedShift or None
        Shift of each temperature; None for one temperature.

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
    >>> len(curve), [round(value, 1) for value in shifts.values]
    (40, [0.0, -1.0])
    """
    if not tests:
        raise InputError("superposition needs one or more tests, got none")
    kinds = {f"{type(test).__name__} ({test.kind})" for test in tests}
    if len(kinds) > 1:
        raise InputError(f"tests must be of one kind, got {' and '.join(sorted(kinds))}")
    unknown = [test.source.path or "a test" for test in tests if test.temperature is None]
    if unknown:
        raise InputError(f"the temperature of {unknown[0]} is unknown; set `temperature`")
    ordered = sorted(tests, key=lambda test: test.temperature or 0.0)
    temperature = np.array([test.temperature for test in ordered], dtype=float)
    close = np.flatnonzero(np.diff(temperature) <= GAP)
    if close.size:
        twice = temperature[close[0]]
        raise InputError(f"two tests have the same temperature, {twice:.2f} K; superpose one")
    first, (column,) = ordered[0], ordered[0].measured
    sign = first.power  # a compliance is the inverse of a modulus
    if shift is None:
        curves = [
            curve(T, -np.log10(test.time[::-1]), sign * np.log10(getattr(test, column)[::-1]))
            for T, test in zip(temperature, ordered, strict=True)
        ]
        shift = shifts_between(temperature, curves, reference_temperature, "both", vertical)
        how = f"shifts from the overlap of the tests, {_moving(vertical)}"
    else:
        how = _named(shift)
    slower, up, table = shifted_by(shift, temperature, temperature, reference_temperature)
    sources = list(dict.fromkeys(test.source for test in ordered))
    source = first.source if len(sources) == 1 else joined_source(sources)
    rows = list(zip(ordered, slower, up, strict=True))
    answer = replace(
        first,
        time=np.concatenate([test.time / 10**along for test, along, _ in rows]),
        temperature=float(reference_temperature),
        source=source.noted(f"{how}; {len(rows)} tests, reference {reference_temperature:.2f} K"),
        **{column: np.concatenate([getattr(t, column) * 10 ** (sign * v) for t, _, v in rows])},
    )
    return answer, table


_PER_DECADE = 5.0  # relaxation times; a time between grid points causes a 3 % error of loss
_TOLERANCE = 0.1  # relative deviation from the nearest causal pair that is accepted
_BEYOND = 1.5  # decades beyond the data, for relaxation outside the range


def causal_misfit(master: MasterCurve) -> tuple[float, float] | None:
    """Return the root mean square of ln(measured/causal) of storage and of loss modulus.

    Each relaxation mode obeys Eq. 4.26 exactly, and so does every sum of modes with positive
    weights. Non-negative least squares of relative residuals gives the nearest such sum, with five
    modes per decade and equal weights of all points and both moduli. None with fewer than four
    points or less than half a decade.
    """
    omega = master.angular_frequency
    decades = float(np.log10(omega[-1] / omega[0]))
    if omega.size < 4 or decades < 0.5:
        return None
    count = int(_PER_DECADE * (decades + 2 * _BEYOND)) + 1
    times = np.geomspace(10**-_BEYOND / omega[-1], 10**_BEYOND / omega[0], count)
    ratio = omega[:, None] * times
    # first column: rubbery modulus
    storage = np.hstack((np.ones((omega.size, 1)), ratio**2 / (1 + ratio**2)))
    loss = np.hstack((np.zeros((omega.size, 1)), ratio / (1 + ratio**2)))
    columns = np.vstack((storage / master.storage[:, None], loss / master.loss[:, None]))
    columns /= np.linalg.norm(columns, axis=0)
    sides = np.column_stack((columns, np.ones(2 * omega.size)))
    # QR: the triangular factor replaces thousands of rows
    triangle = np.asarray(np.linalg.qr(sides, mode="r"))
    causal = np.maximum(columns @ nonnegative(triangle[:, :-1], triangle[:, -1]), 1e-12)
    storage_off, loss_off = np.split(np.log(causal), 2)
    return float(np.sqrt(np.mean(storage_off**2))), float(np.sqrt(np.mean(loss_off**2)))


def contradiction(master: MasterCurve) -> str:
    """Describe how storage and loss modulus violate causality; empty if they do not.

    The nearest pair that obeys the Kramers-Kronig relation is fitted with equal weights of all
    points.

    Parameters
    ----------
    master : MasterCurve
        Storage and loss modulus.

    Returns
    -------
    str
        A sentence, or an empty string.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e9, tau0=1.0, poisson_ratio=0.5)
    >>> omega = np.geomspace(1e-2, 1e6, 40)
    >>> modulus = solid.complex_modulus(omega)
    >>> contradiction(MasterCurve(293.15, omega, modulus.real, modulus.imag, "E"))
    ''
    """
    off = causal_misfit(master)
    if off is None or max(off) <= _TOLERANCE:
        return ""
    return (
        "storage and loss modulus contradict each other (Kramers-Kronig): the nearest causal solid "
        f"is {100 * np.expm1(off[0]):.2g} % off in storage and {100 * np.expm1(off[1]):.2g} % in "
        "loss. A shift, a sweep or a calibration is wrong"
    )
