"""How wrong models are on rows that they were not shown: which are held out, and the score."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..table import Array
from .learners import Learner, size, trained

# Neighbouring values of an input closer than this in ln are one value: 3.19, 3.2 and 3.24 are.
_SAME = 0.06
FOLDS = 5
# In which fold each row is held out.
Split = npt.NDArray[np.intp]


def random_split(rows: int, seed: int, folds: int = FOLDS) -> Split:
    """Return folds of rows at random, those of scikit-learn's shuffled KFold."""
    from sklearn.model_selection import KFold

    fold = np.empty(rows, dtype=np.intp)
    parts = KFold(folds, shuffle=True, random_state=seed).split(np.empty((rows, 1)))
    for i, (_, held) in enumerate(parts):
        fold[held] = i
    return fold


def value_split(values: Array) -> Split:
    """Return a fold for each value of an input; neighbours within 6 % are one value.

    Examples
    --------
    >>> value_split(np.array([0.1, 0.5, 0.098, 0.1])).tolist()
    [0, 1, 0, 0]
    """
    known = np.unique(values)
    place = np.concatenate([[0], np.cumsum(np.diff(np.log(known)) > _SAME)]).astype(np.intp)
    return place[np.searchsorted(known, values)]


def folds(split: Split) -> Iterator[tuple[Split, Split]]:
    """Return training and held-out rows of each fold."""
    for i in range(split.max() + 1):
        yield np.flatnonzero(split != i), np.flatnonzero(split == i)


@dataclass(frozen=True, eq=False)
class Score:
    """What came of a model over the folds of a split."""

    mse: Array
    r2: Array  # about the mean of a fold's own rows
    sizes: Array  # trainable parameters
    predicted: Array  # the target of every row, from the model that had not seen it
    true: Array

    @property
    def pooled_r2(self) -> float:
        """R2 of all held-out predictions together, about the mean of all rows."""
        return r_squared(self.true, self.predicted)


def r_squared(true: Array, predicted: Array) -> float:
    """Return 1 - error over variance.

    Examples
    --------
    >>> r_squared(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))
    0.5
    """
    return float(1 - np.sum((true - predicted) ** 2) / np.sum((true - np.mean(true)) ** 2))


def score(X: Array, y: Array, learner: Learner, split: Split, *, seed: int) -> Score:
    """Train a model for each fold and judge it on the rows held out."""
    predicted = np.full(len(y), np.nan)
    found = []
    for train, held in folds(split):
        model = trained(learner, X[train], y[train], seed=seed)
        predicted[held] = model.predict(X[held])
        mse = float(np.mean((y[held] - predicted[held]) ** 2))
        found.append((mse, r_squared(y[held], predicted[held]), size(model)))
    return Score(*np.array(found).T, predicted=predicted, true=y)
