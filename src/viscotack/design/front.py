"""Front of designs of which none is better in every target (Pareto)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .margins import Candidate

# Largest number of designs of a front.
MOST = 24


def nondominated(values: Array) -> npt.NDArray[np.bool_]:
    """Return which rows are not dominated by another one; all columns are maximised.

    A row is dominated by one that is at least as large in every column and larger in one.

    Examples
    --------
    >>> nondominated(np.array([[1.0, 3.0], [2.0, 2.0], [1.0, 2.0], [3.0, 1.0]])).tolist()
    [True, True, False, True]
    """
    order = np.argsort(-values.sum(axis=1), kind="stable")
    kept: list[int] = []
    for i in order:
        others = values[kept]
        above = np.all(others >= values[i], axis=1) & np.any(others > values[i], axis=1)
        if not above.any():
            kept.append(int(i))
    found = np.zeros(len(values), dtype=bool)
    found[kept] = True
    return found


def front_of(seen: Iterable[Candidate], most: int = MOST) -> tuple[Candidate, ...]:
    """Return designs of which none has all margins larger, by the first target.

    The margins are those of the less favourable ends of the intervals. Of many designs those are
    kept that are farthest from the others.
    """
    some = [each for each in seen if np.isfinite(each.margin)]
    if not some:
        return ()
    values = np.array([list(each.margins.values()) for each in some])
    _, first = np.unique(values, axis=0, return_index=True)
    best = first[nondominated(values[first])]
    chosen = _apart(values[best], most)
    found = [some[best[i]] for i in chosen]
    return tuple(sorted(found, key=lambda x: next(iter(x.margins.values()))))


def _apart(values: Array, most: int) -> Sequence[int]:
    """Return the numbers of rows far from each other, beginning with the largest worst column."""
    chosen = [int(np.argmax(values.min(axis=1)))]
    distance = np.linalg.norm(values - values[chosen[0]], axis=1)
    while len(chosen) < min(most, len(values)):
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(values - values[chosen[-1]], axis=1))
    return chosen
