"""Shift factors from the overlap of neighbouring sweeps."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.materials.shift import TabulatedShift

from . import vertical as moving
from .grouping import GAP, levels
from .overlap import Curve, Hold, Step, step_between, vertical_at
from .sweeps import FrequencySweeps, ShiftTable

FEWEST = 4  # points of one temperature; fewer carry no shape
MOST = 200  # more are averaged: a shift takes no longer, and is no less sure
BY = ("both", "storage", "loss", "tan")
BEST = ("both", "auto")  # by, vertical: the most that the data carry
THERMOMETER = 0.2  # K: how well the temperature of a chamber is known


def shift_factors(
    sweeps: FrequencySweeps,
    *,
    reference_temperature: float,
    by: str = "both",
    vertical: str | float = "auto",
    temperature_uncertainty: float = THERMOMETER,
) -> ShiftTable:
    """Return the shift of each temperature, found from the overlap of its neighbours.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Two or more temperatures, each with four or more frequencies.
    reference_temperature : float
        T0 [K], within the temperatures of the sweeps. Between two of them the shift is
        interpolated, and the table has no row with a shift of zero.
    by : {"both", "storage", "loss", "tan"}
        What must superpose. Both moduli say the most: storage alone is flat on a plateau, where
        an error of a few per cent looks like a shift by decades. The loss tangent does not know
        of any vertical shift; that is found afterwards.
    vertical : {"auto", "none", "free"} or float
        How far the moduli may move as well, by one factor for storage and loss: "auto", as far as
        the data fix it, held by a size that all steps have in common; "none"; "free", each step
        on its own; or by density and temperature, as rubber elasticity has it, with this
        coefficient of volume expansion [1/K].
    temperature_uncertainty : float
        Standard deviation with which the temperature of each sweep is known [K].

    Returns
    -------
    ShiftTable
        With the standard deviation of each shift relative to the reference: from the scatter of
        the points and of stretches of them about the common curve, from vertical shifts of the
        size that the data have, also where none was allowed, and from the thermometer; by less
        than both moduli, also from what both would say. It does not know of a solid that does not
        superpose; see :func:`viscotack.lab.superposition`.

    Raises
    ------
    ValueError
        If there are fewer than two temperatures, one of them has too few points, two neighbours
        do not overlap, or the reference lies outside.

    Notes
    -----
    Points within 1 K are one temperature, their mean. More than 200 points of one temperature are
    averaged over equal stretches of the logarithm of frequency.
    """
    each = temperature_levels(sweeps)
    return shifts_between(
        np.array([float(np.mean(level.temperature)) for level in each]),
        [curve(level) for level in each],
        reference_temperature=reference_temperature,
        by=by,
        vertical=vertical,
        temperature_uncertainty=temperature_uncertainty,
    )


def shifts_between(
    temperature: Array,
    curves: Sequence[Curve],
    *,
    reference_temperature: float,
    by: str,
    vertical: str | float,
    temperature_uncertainty: float,
) -> ShiftTable:
    """Return the shift of each curve, as :func:`shift_factors` does, in frequency or in time.

    Parameters
    ----------
    temperature : ndarray, shape (M,)
        [K], ascending.
    curves : sequence of Curve, M
        All that was measured, over log10 of frequency or minus log10 of time.
    """
    vertical = moving.checked(vertical)
    if by not in BY:
        raise InputError(f"by must be 'both', 'storage', 'loss' or 'tan', got {by!r}")
    if not 0 <= temperature_uncertainty < 50:
        raise InputError(
            "temperature_uncertainty must lie between 0 and 50 K, "
            f"got {temperature_uncertainty:g} K"
        )
    if len(curves) < 2:
        raise InputError(
            "a shift needs sweeps at two or more temperatures, got one; give a law of shift "
            "(--glass-transition, --wlf, --shift-file)"
        )
    if not temperature[0] - GAP <= reference_temperature <= temperature[-1] + GAP:
        raise InputError(
            f"--reference-temperature must lie between {temperature[0]:.2f} and "
            f"{temperature[-1]:.2f} K, got {reference_temperature:g} K; give a law of shift to go "
            "beyond (--glass-transition, --wlf, --shift-file)"
        )
    steps = steps_between(temperature, curves, by, vertical)
    shift, up, deviation = _summed(steps, temperature, reference_temperature)
    kelvin = _per_kelvin(temperature, shift, reference_temperature)
    uncertainty = np.hypot(deviation, temperature_uncertainty * kelvin)
    if (by, vertical) != BEST and len(curves[0].y) > 1:
        # whoever asks for less than the data carry is no surer than what the rest says
        try:
            most = steps_between(temperature, curves, *BEST)
        except ValueError:
            most = steps
        other = _summed(most, temperature, reference_temperature)[0]
        uncertainty = np.hypot(uncertainty, shift - other)
    return ShiftTable(temperature, shift, uncertainty, None if vertical == "none" else up)


def steps_between(
    temperature: Array, curves: Sequence[Curve], by: str, vertical: str | float
) -> list[Step]:
    """Return how far each curve must move to continue its colder neighbour."""
    holds = moving.holds(vertical, temperature, list(pairwise(curves)))
    steps = []
    for i, (colder, hotter) in enumerate(pairwise(curves)):
        try:
            steps.append(_step(colder, hotter, by, holds[i]))
        except ValueError as error:
            raise InputError(
                f"sweeps at {temperature[i]:.2f} and {temperature[i + 1]:.2f} K: {error}"
            ) from None
    return steps


def _step(colder: Curve, hotter: Curve, by: str, hold: Hold) -> Step:
    if by != "tan":
        return step_between(part(colder, by), part(hotter, by), hold)
    step = step_between(part(colder, by), part(hotter, by), Hold())
    return replace(step, vertical=vertical_at(colder, hotter, step.shift, hold))


def part(curve: Curve, by: str) -> Curve:
    """Return what must superpose of a curve."""
    if by == "both":
        return curve
    storage, loss = curve.y
    return Curve(curve.x, ({"storage": storage, "loss": loss, "tan": loss - storage}[by],))


def _per_kelvin(temperature: Array, shift: Array, reference: float) -> Array:
    """Return the change of each shift with an error of 1 K of its and of the reference's sweep."""
    slope = np.gradient(shift, temperature)
    inside = float(np.clip(reference, temperature[0], temperature[-1]))
    both = np.hypot(slope, np.interp(inside, temperature, slope))
    return np.where(np.abs(temperature - inside) <= GAP, 0.0, both)


def _summed(
    steps: Sequence[Step], temperature: Array, reference: float
) -> tuple[Array, Array, Array]:
    """Return shifts, vertical shifts and standard deviations relative to the reference."""
    columns = np.array([[s.shift, s.vertical, s.variance, s.common] for s in steps])
    sums = np.vstack((np.zeros(4), np.cumsum(columns, axis=0)))
    inside = float(np.clip(reference, temperature[0], temperature[-1]))
    shift, up = (
        np.asarray(
            TabulatedShift(inside, tuple(temperature), tuple(column)).log10_shift(temperature)
        )
        for column in sums[:, :2].T
    )
    variance, common = (
        np.abs(column - np.interp(inside, temperature, column)) for column in sums[:, 2:].T
    )
    deviation = np.sqrt(variance + common**2)
    return shift, up, np.where(deviation < 1e-6, 0.0, deviation)  # the reference, and round-off


def temperature_levels(sweeps: FrequencySweeps) -> list[FrequencySweeps]:
    """Return the points of each temperature, from cold to hot."""
    if np.any(np.isnan(sweeps.temperature)):
        raise InputError("the temperature of some points is not known; say it, --temperature")
    return [sweeps.chosen(points) for points in levels(sweeps.temperature)]


def curve(level: FrequencySweeps) -> Curve:
    """Return one temperature as a curve in decades: storage and loss."""
    order = np.argsort(level.angular_frequency, kind="stable")
    x = np.log10(level.angular_frequency[order])
    if x.size < FEWEST or np.ptp(x) < 0.1:
        raise InputError(
            f"{x.size} points at {np.mean(level.temperature):.2f} K, over "
            f"{np.ptp(x):.1g} decades of frequency: too few to find a shift from overlap; "
            "give a law of shift (--wlf, --shift-file) or leave them out (--leave-out)"
        )
    return thinned(Curve(x, (np.log10(level.storage[order]), np.log10(level.loss[order]))))


def thinned(curve: Curve) -> Curve:
    """Return a curve of at most MOST points: means over equal stretches, where it has more."""
    if curve.x.size <= MOST:
        return curve
    stretch = (MOST * (curve.x - curve.x[0]) / (np.ptp(curve.x) * (1 + 1e-12))).astype(int)
    _, stretch, count = np.unique(stretch, return_inverse=True, return_counts=True)
    x, *y = (np.bincount(stretch, column) / count for column in (curve.x, *curve.y))
    return Curve(x, tuple(y))
