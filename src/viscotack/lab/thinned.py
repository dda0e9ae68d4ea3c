"""Many points as few: means over short pieces of a logarithmic axis, and the words that say so."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .observed import Observed

MOST = 500  # points that are fitted as they are
_FINEST = 40  # pieces a decade


def thinned(data: Observed) -> Observed:
    """Return measured numbers as at most about 500 means, with a note; few stay as they are.

    Of points that lie in one piece of the logarithmic axis (and in one sweep) the logarithms are
    averaged: place and numbers both, so that on a straight piece of a double-logarithmic curve the
    mean lies on the curve. Pieces are a fortieth of a decade, or so long that 500 are enough; the
    curvature of a standard solid is missed by less than 1e-4 in a fortieth of a decade. Each mean
    counts once, however many points are in it: a recorder that writes ten points a second has most
    of its points in the last decade, and would see nothing else.
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
        f"{data.at.size} points were averaged to {at.size}, over {finest} pieces a decade; each "
        "mean counts once"
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
    """Return the number of the piece of each point, in ascending order of sweep and place."""
    order = np.lexsort((at, sweep))
    piece = np.floor(finest * np.log10(at[order]))
    fresh = (np.diff(piece) != 0) | (np.diff(sweep[order]) != 0)
    return np.concatenate(([0], np.cumsum(fresh)))
