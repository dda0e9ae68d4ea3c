"""Assign points to frequency sweeps where a file does not number the sweeps."""

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

# K least difference between two sweeps; chambers hold the temperature within a few tenths
GAP = 1.0


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
    clusters = _clusters(temperature)
    if clusters is not None and _each_frequency_once(clusters, angular_frequency):
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


def _clusters(temperature: Array) -> npt.NDArray[np.int64] | None:
    if np.any(np.isnan(temperature)):
        return None
    clusters = np.empty(temperature.size, dtype=np.int64)
    for number, points in enumerate(levels(temperature)):
        clusters[points] = number
    return clusters


def _each_frequency_once(clusters: npt.NDArray[np.int64], angular_frequency: Array) -> bool:
    pairs = np.stack((clusters, np.round(1000 * np.log(angular_frequency))))
    return np.unique(pairs, axis=1).shape[1] == clusters.size


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
