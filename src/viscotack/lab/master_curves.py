"""Time-temperature superposition: sweeps at many temperatures as one curve at one of them."""

from dataclasses import replace

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.materials.shift import WLF, Arrhenius, Shift, TabulatedShift

from .grouping import GAP
from .kramers_kronig import causal_misfit
from .shifting import BEST, shift_factors, temperature_levels
from .sweeps import FrequencySweeps, MasterCurve, ShiftTable

# what uses most of the data comes first
_WAYS = (BEST, ("both", "none"), ("storage", "none"))
_CAUSAL = 0.03  # a pair of moduli as causal as rheometers make it
_CLEARLY = 0.8  # of the misfit
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
    r"""Return all sweeps shifted to one temperature, ascending in frequency.

    A point measured at omega and T lands at omega a_T. With a law of shift a temperature ramp at
    one frequency becomes a master curve as well (Sec. 4.6.1 of the thesis).

    Parameters
    ----------
    sweeps : FrequencySweeps
        Points to be shifted.
    reference_temperature : float or None
        Temperature of the curve [K]. None only for sweeps of one temperature, which the file may
        not even say: then nothing is shifted.
    shift : WLF, Arrhenius, TabulatedShift or ShiftTable, optional
        A law is seen from the reference temperature and shifts every point by its own
        temperature. The row of a table shifts the points within 1 K of it, a vertical shift
        included; between rows it is interpolated. Without it the shifts are found from the
        overlap of neighbouring sweeps, see :func:`shift_factors`.
    by : {"both", "storage", "loss", "tan"}, optional
        What must superpose, where shifts are found from overlap. Left out with `vertical`: the
        most that the data carry, see :func:`most_carried`.
    vertical : {"auto", "none", "free"} or float, optional
        How far moduli may move as well, where shifts are found from overlap, see
        :func:`shift_factors`; "auto" where `by` alone is given.

    Returns
    -------
    MasterCurve
        With the shift of each temperature and, where it was found, its uncertainty.

    Raises
    ------
    ValueError
        If temperatures are unknown, a law has no value for one of them, or overlap does not fix
        the shifts.

    References
    ----------
    Williams, Landel & Ferry (1955), doi:10.1021/ja01619a008.

    Examples
    --------
    A temperature ramp at 1 Hz, seen from 20 C:

    >>> ramp = FrequencySweeps(
    ...     [173.15, 293.15], [6.283, 6.283], [1.2e8, 2e6], [6e7, 1e5], "E", [0, 0]
    ... )
    >>> wlf = WLF.from_glass_transition(158.15)
    >>> curve = master_curve(ramp, reference_temperature=293.15, shift=wlf)
    >>> [f"{omega:.3g}" for omega in curve.angular_frequency]
    ['6.28', '3.07e+09']
    """
    if reference_temperature is None:
        return _unshifted(sweeps, shift)
    if np.any(np.isnan(sweeps.temperature)):
        raise InputError("the temperature of some points is not known; say it, --temperature")
    if shift is not None and (by is not None or vertical is not None):
        raise InputError("by and vertical are for shifts found from overlap; leave shift= out")
    reference_temperature = float(reference_temperature)
    if shift is None:
        if np.ptp(sweeps.temperature) <= GAP and _near(sweeps.temperature, reference_temperature):
            return replace(_unshifted(sweeps, None), reference_temperature=reference_temperature)
        _refuse_ramp(sweeps)
        if by is None and vertical is None:
            return most_carried(sweeps, reference_temperature=reference_temperature)
        by, vertical = by or BEST[0], BEST[1] if vertical is None else vertical
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
    """Return the master curve by the shifts that use most of what sweeps at many temperatures say.

    Both moduli, moved as far as the data fix it. Where they do not fix the shifts, or where
    shifts by both moduli at rest, or by storage alone, make the moduli a clearly better causal
    pair (Kramers and Kronig, all points counting alike): those, and a note says so.

    Raises
    ------
    ValueError
        As :func:`shift_factors`, if no way fixes the shifts.
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
            break  # nothing to be gained
    if best is None:
        raise first or InputError("no shift was found")
    if first is None:
        return best
    note = f"storage and loss together, free to move, do not fix the shifts: {first}"
    return replace(best, source=best.source.noted(note))


def moved_words(vertical: str | float) -> str:
    """Return in a few words how far moduli may move."""
    words = {
        "auto": "moduli moved as far as the data fix it",
        "none": "moduli not moved",
        "free": "moduli moved freely",
    }
    if isinstance(vertical, str):
        return words[vertical]
    return f"moduli moved by density and temperature, expansion {vertical:g} 1/K"


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
    """Return the horizontal and the vertical shift of each point, and the table of the levels."""
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
    """Return a column of a table at each temperature, less its value at the reference.

    A point within 1 K of a row belongs to that row: the chamber is never quite at its set point.
    """
    asked = np.append(temperature, reference)
    nearest = np.argmin(np.abs(asked[:, None] - rows), axis=1)
    found = values[nearest].astype(float)
    beside = np.abs(asked - rows[nearest]) > GAP
    # the reference itself is interpolated, not rounded to a row
    beside[-1] = rows[0] < reference < rows[-1]
    if beside.any():
        if rows.size < 2:
            raise InputError(
                f"the table of shifts has one row, at {rows[0]:.2f} K; "
                f"asked at {asked[beside][0]:.2f} K"
            )
        curve = TabulatedShift(float(rows[0]), tuple(rows), tuple(values))
        found[beside] = values[0] + np.asarray(curve.log10_shift(asked[beside]))
    return found[:-1] - found[-1]


def _refuse_ramp(sweeps: FrequencySweeps) -> None:
    omega = sweeps.angular_frequency
    if np.ptp(omega) <= 1e-3 * omega[0] and np.ptp(sweeps.temperature) > GAP:
        raise InputError(
            "a temperature ramp at one frequency has no overlap to find shifts from; give "
            "shift=WLF.from_glass_transition(...) or another law"
        )


def _near(temperature: Array, reference: float) -> bool:
    return bool(np.all(np.abs(temperature - reference) <= GAP))


def shift_words(shift: Shift | ShiftTable) -> str:
    """Return in a few words how points are shifted."""
    return f"shifted by {shift.words() if isinstance(shift, WLF | Arrhenius) else 'a table'}"
