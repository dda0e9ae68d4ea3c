"""Search of a space of designs by differential evolution (SciPy), and the front of what it saw."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.optimize

from viscotack.arrays import Array

from .margins import Candidate
from .space import Choice, DesignSpace

# Rating of a design without a prediction or without room.
NONE = -1e3
# Fewest members that SciPy accepts.
_FEWEST = 5
# Of differential evolution: forces are smooth, so that most variables may change together.
_RECOMBINATION, _MUTATION = 0.9, (0.3, 0.8)
# Largest number of designs of a front.
_MOST = 24


@dataclass(frozen=True)
class Effort:
    """Size of a search: designs in a generation, and generations, each times free variables + 1."""

    members: float
    generations: float

    def of(self, free: int) -> tuple[int, int]:
        """Return members for each free variable, and generations."""
        members = max(self.members * (free + 1), _FEWEST)
        return ceil(members / free), ceil(self.generations * (free + 1))


def search(
    rating: Callable[[Choice], float],
    space: DesignSpace,
    material: str,
    *,
    effort: Effort,
    seed: int,
    tell: Callable[[float], None] = lambda share: None,
) -> Choice:
    """Return the design with the largest rating that differential evolution finds.

    Parameters
    ----------
    rating : callable
        Number of a design; :data:`NONE` or less if it is none.
    space : DesignSpace
        Bounds of the variables.
    material : str
        Name of the material.
    effort : Effort
        Size of the search.
    seed : int
        Of the random numbers.
    tell : callable
        Called with the completed share.
    """

    def cost(places: Array) -> float:
        choice = space.choice(material, places)
        room = space.most_pads(choice.radius)
        # the penalty falls towards smaller areas
        return -NONE + choice.pads - room if choice.pads > room else -rating(choice)

    if not space.free:
        only = np.array([])
        cost(only)
        return space.choice(material, only)

    ends = space.ends()
    # begin fast to hold, slow to release, and in the middle of other ranges; just inside, because
    # SciPy rejects ends that round-off moves out
    share = {"hold_speed": 0.999, "release_speed": 0.001}
    begin = [
        low + share.get(name, 0.5) * (high - low)
        for name, (low, high) in zip(space.free, ends, strict=True)
    ]
    whole = [name == "pads" for name in space.free]
    # the name that every supported version of scipy knows; the checker knows the newest only
    generator: dict[str, Any] = {"seed": seed}
    members, most = effort.of(len(ends))
    generations = iter(range(1, most + 2))
    found = scipy.optimize.differential_evolution(
        cost,
        ends,
        integrality=whole,
        x0=np.where(whole, np.round(begin), begin),
        popsize=members,
        maxiter=most,
        tol=0,
        polish=False,
        recombination=_RECOMBINATION,
        mutation=_MUTATION,
        **generator,
        callback=lambda x, convergence: tell(next(generations) / (most + 1)),
    )
    return space.choice(material, np.asarray(found.x))


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


def front_of(seen: Iterable[Candidate], most: int = _MOST) -> tuple[Candidate, ...]:
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
