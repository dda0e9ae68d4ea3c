"""Reduce many points to means over short intervals of a logarithmic axis."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .observed import Observed

MOST = 500  # largest number of points fitted without averaging
_FINEST = 40  # intervals per decade


def thinned(data: Observed) -> Observed:
    """Reduce measured numbers to at most about 500 means, with a note; fewer are unchanged.

    Points in one interval of the logarithmic axis (and in one sweep) are averaged in logarithms,
    both place and number, so that the mean of a straight piece of a double-logarithmic curve lies
    on the curve. Intervals have 1/40 decade, or the length that gives 500 of them; the curvature of
    a standard solid causes an error below 1e-4 in 1/40 decade. All means have equal weights,
    because a recorder with constant sampling rate has most of its points in the last decade, which
    would otherwise dominate.
    """
    if data.at.size <= MOST:
        return data
    sweep = data.sweep if data.sweep is not None else np.zeros(data.at.size, dtype=np.int64)
    finest = _FINEST
    while True:
        groups = _groups(data.at, sweep, finest)
        if groups[-1] < MOST or finest <= 1:
            break
        finest = max(1, int(0.8 * finest))
    order = np.lexsort((data.at, sweep))
    count = np.bincount(groups)

    def mean(values: Array) -> Array:
        return np.exp(np.bincount(groups, weights=np.log(values)[order]) / count)

    at = mean(data.at)
    ascending = np.argsort(at, kind="stable")
    first = sweep[order][np.concatenate(([0], np.flatnonzero(np.diff(groups)) + 1))]
    note = (
        f"{data.at.size} points were averaged to {at.size}, in {finest} intervals per decade, with "
        "equal weights"
    )
    return replace(
        data,
        at=at[ascending],
        values=np.array([mean(row) for row in data.values])[:, ascending],
        sweep=None if data.sweep is None else first[ascending],
        source=data.source.noted(note),
        points=data.at.size,
    )


def _groups(at: Array, sweep: npt.NDArray[np.int64], finest: int) -> npt.NDArray[np.int64]:
    """Return the interval of each point, in ascending order of sweep and place."""
    order = np.lexsort((at, sweep))
    piece = np.floor(finest * np.log10(at[order]))
    fresh = (np.diff(piece) != 0) | (np.diff(sweep[order]) != 0)
    return np.concatenate(([0], np.cumsum(fresh)))
