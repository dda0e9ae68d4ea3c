"""Assign points to frequency sweeps, and refuse to pool sweeps that contradict each other."""

from itertools import combinations

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .sweeps import FrequencySweeps

# K least difference between two sweeps; chambers hold the temperature within a few tenths
GAP = 1.0
# K: sweeps closer than this must agree; a ramp may pass through neighbouring temperatures
_ONE_TEMPERATURE = 0.3
_UNLIKE = 0.1  # relative difference of sweeps of one state that is refused, if beyond their scatter
_COMPARED = 3  # points that sweeps need to be compared


def grouped(temperature: Array, angular_frequency: Array) -> tuple[npt.NDArray[np.int64], str]:
    """Assign each point to a frequency sweep; return the sweep numbers and a note.

    Parameters
    ----------
    temperature, angular_frequency : ndarray, shape (N,)
        Of the points, in the order of the file; temperatures may be nan (unknown).

    Returns
    -------
    numbers : ndarray of int, shape (N,)
        Sweep of each point, counted from 0.
    how : str
        Note on the method; empty for a single sweep.

    Notes
    -----
    Points within 1 K are one sweep if no frequency occurs twice among them, in any order.
    Otherwise a sweep ends where the frequency reverses direction. One frequency at many
    temperatures is one sweep.

    Examples
    --------
    >>> numbers, how = grouped(np.array([300.0, 290.1, 300.2, 290.0]), np.array([1.0, 1, 10, 10]))
    >>> numbers.tolist(), how
    ([0, 1, 0, 1], '2 sweeps separated by temperature')
    """
    one = np.zeros(temperature.size, dtype=np.int64)
    if np.ptp(angular_frequency) <= 1e-3 * angular_frequency[0]:
        return one, ""
    clusters = np.empty(temperature.size, dtype=np.int64)
    for number, points in enumerate(levels(temperature)):
        clusters[points] = number
    pairs = np.stack((clusters, np.round(1000 * np.log(angular_frequency))))
    # each frequency once at each temperature
    if not np.isnan(temperature).any() and np.unique(pairs, axis=1).shape[1] == clusters.size:
        how = "temperature"
    else:
        clusters, how = _runs(angular_frequency), "frequency reversal"
    # numbered in the order of the file
    _, first, numbers = np.unique(clusters, return_index=True, return_inverse=True)
    numbers = np.argsort(np.argsort(first))[numbers]
    count = first.size
    return numbers, f"{count} sweeps separated by {how}" if count > 1 else ""


def levels(temperature: Array) -> list[npt.NDArray[np.int64]]:
    """Return the indices of the points of each temperature, from cold to hot."""
    order = np.argsort(temperature, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(temperature[order]) > GAP) + 1)


def _runs(angular_frequency: Array) -> npt.NDArray[np.int64]:
    """Return the number of the monotonic run of frequencies that each point belongs to."""
    numbers = np.zeros(angular_frequency.size, dtype=np.int64)
    direction = 0.0
    for i in range(1, numbers.size):
        step = np.sign(angular_frequency[i] - angular_frequency[i - 1])
        numbers[i] = numbers[i - 1]
        if step * direction < 0:
            numbers[i] += 1
            direction = 0.0
        elif step:
            direction = step
    return numbers


def refuse_unlike(sweeps: FrequencySweeps) -> None:
    """Raise an error if sweeps at one temperature differ by more than their scatter.

    They are then of several samples, positions or states, which are no one material.
    """
    parts = _passes(sweeps)
    for (T, x, y), (other, u, v) in combinations(parts, 2):
        if abs(T - other) > _ONE_TEMPERATURE or np.isnan(T) != np.isnan(other):
            continue
        inside = (x >= u[0] - 1e-9) & (x <= u[-1] + 1e-9)
        if inside.sum() < _COMPARED:
            continue
        off = y[inside] - np.interp(x[inside], u, v)
        apart, scatter = abs(float(np.median(off))), float(np.std(off))
        if apart > max(np.log1p(_UNLIKE), 3 * scatter / np.sqrt(off.size)):
            where = "unknown temperature" if np.isnan(T) else f"{T - 273.15:.4g} C"
            raise InputError(
                f"{sweeps.source.path or 'the sweeps'}: sweeps at {where} differ by "
                f"{100 * np.expm1(apart):.2g} %: several samples, states or unstated "
                "temperatures; choose one by --where or --table"
            )


def _passes(sweeps: FrequencySweeps) -> list[tuple[float, Array, Array]]:
    """Return temperature, log10 of frequency and ln of the modulus of each run of frequencies.

    A sweep in which a frequency occurs repeatedly has several runs; a ramp of the temperature none.
    """
    found = []
    size = np.log(np.hypot(sweeps.storage, sweeps.loss))
    keys = np.round(1000 * np.log(sweeps.angular_frequency)).astype(np.int64)
    for number in np.unique(sweeps.sweep):
        own = np.flatnonzero(sweeps.sweep == number)
        temperature = sweeps.temperature[own]
        if np.ptp(temperature) > GAP:
            continue
        order = own[np.argsort(keys[own], kind="stable")]
        begins = np.flatnonzero(np.diff(keys[order], prepend=keys[order[0]] - 1))
        turn = np.arange(order.size) - np.repeat(begins, np.diff(begins, append=order.size))
        for each in range(int(turn.max()) + 1):
            points = order[turn == each]
            if points.size >= _COMPARED:
                x = np.log10(sweeps.angular_frequency[points])
                found.append((float(np.mean(temperature)), x, size[points]))
    return found
