"""Which rows are held out: at random, or by something that the model is then new to."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..table import Array

Rows = npt.NDArray[np.intp]

# Neighbouring values of an input closer than this in ln are one value: 3.19, 3.2 and 3.24 are.
_SAME = 0.06
# Inputs that agree to this many decimals of their features are the same input.
_DECIMALS = 6
FOLDS = 5
RANDOM = "random rows"


@dataclass(frozen=True, eq=False)
class Split:
    """A way of holding rows out, one fold after another; every row is held out once.

    Attributes
    ----------
    name : str
        What a fold has that the training rows have not.
    fold : ndarray of int, shape (n,)
        In which fold a row is held out.
    labels : tuple of str
        Name of each fold.
    """

    name: str
    fold: npt.NDArray[np.intp]
    labels: tuple[str, ...]

    def folds(self) -> Iterator[tuple[Rows, Rows]]:
        """Return training and held-out rows of each fold."""
        for i in range(len(self.labels)):
            yield np.flatnonzero(self.fold != i), np.flatnonzero(self.fold == i)


def random_split(rows: int, seed: int, folds: int = FOLDS) -> Split:
    """Return folds of rows at random, those of scikit-learn's shuffled KFold."""
    from sklearn.model_selection import KFold

    fold = np.empty(rows, dtype=np.intp)
    parts = KFold(folds, shuffle=True, random_state=seed).split(np.empty((rows, 1)))
    for i, (_, held) in enumerate(parts):
        fold[held] = i
    return Split(RANDOM, fold, tuple(f"fold {i + 1}" for i in range(folds)))


def value_split(name: str, values: Array) -> Split:
    """Return a fold for each value of an input; neighbours within 6 % are one value.

    Examples
    --------
    >>> value_split("k", np.array([0.1, 0.5, 0.098, 0.1])).labels
    ('0.098 to 0.1', '0.5')
    """
    known = np.unique(values)
    place = np.concatenate([[0], np.cumsum(np.diff(np.log(known)) > _SAME)]).astype(np.intp)
    labels = []
    for i in range(place[-1] + 1):
        low, high = known[place == i][[0, -1]]
        labels.append(f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}")
    return Split(f"a new {name}", place[np.searchsorted(known, values)], tuple(labels))


def group_split(name: str, groups: npt.NDArray[np.intp], seed: int, folds: int = FOLDS) -> Split:
    """Return folds that no group is in two of."""
    some = random_split(int(groups.max()) + 1, seed, min(folds, int(groups.max()) + 1))
    return Split(name, some.fold[groups], some.labels)
