"""How wrong models are on rows that they were not shown: one fit after another, and its score."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..table import Array, Detachments
from .features import Descriptor, Target, features, target
from .learners import Learner, trained
from .splits import Split


@dataclass(frozen=True)
class Trial:
    """What is learned, from what, by what."""

    target: Target
    descriptor: Descriptor
    learner: Learner


@dataclass(frozen=True, eq=False)
class Score:
    """What came of a trial over the folds of a split.

    Attributes
    ----------
    mse, r2 : ndarray, shape (folds,)
        Mean square error of the log10, and R2 of each fold about the mean of
        its own rows (nan where these are all the same).
    predicted : ndarray, shape (n,)
        The log10 of every row, from the model that had not seen it.
    true : ndarray, shape (n,)
        What it should be.
    sizes : ndarray of int, shape (folds,)
        Trainable parameters.
    train_time_s : float
        Processor time of a fit, median over the folds [s].
    """

    mse: Array
    r2: Array
    predicted: Array
    true: Array
    sizes: Any
    train_time_s: float

    @property
    def pooled_r2(self) -> float:
        """R2 of all held-out predictions together, about the mean of all rows."""
        return r_squared(self.true, self.predicted)

    @property
    def pooled_mse(self) -> float:
        """Mean square error of all held-out predictions."""
        return float(np.mean((self.true - self.predicted) ** 2))


def relative(mse: float) -> float:
    """Return the relative error that a mean square error of log10 stands for.

    Examples
    --------
    >>> f"{relative(1e-4):.4f}"
    '0.0233'
    """
    return float(10 ** np.sqrt(mse) - 1)


def r_squared(true: Array, predicted: Array) -> float:
    """Return 1 - error over variance.

    Examples
    --------
    >>> r_squared(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0]))
    0.5
    """
    spread = np.sum((true - np.mean(true)) ** 2)
    return float(1 - np.sum((true - predicted) ** 2) / spread) if spread > 0 else float("nan")


def score(
    rows: Detachments, trial: Trial, split: Split, *, seed: int, quick: bool = False
) -> Score:
    """Train a model for each fold and judge it on the rows held out."""
    return _folded(
        features(rows, trial.descriptor),
        target(rows, trial.target),
        trial.learner,
        split,
        seed,
        quick,
    )


def scores(
    rows: Detachments,
    trials: Sequence[tuple[Trial, Split]],
    *,
    seed: int,
    jobs: int,
    quick: bool = False,
) -> list[Score]:
    """Return the score of each trial, the work shared by some processes of this machine."""
    X = {d: features(rows, d) for d in {trial.descriptor for trial, _ in trials}}
    y = {which: target(rows, which) for which in {trial.target for trial, _ in trials}}
    tasks = [
        (X[trial.descriptor], y[trial.target], trial.learner, split, seed, quick)
        for trial, split in trials
    ]
    return shared(_folded, tasks, jobs)


def shared(do: Callable[..., Any], tasks: Sequence[tuple[Any, ...]], jobs: int) -> list[Any]:
    """Return what a function makes of each task, in order, the work shared by some processes."""
    if jobs == 1:
        return [do(*task) for task in tasks]
    from joblib import Parallel, delayed

    found: Any = Parallel(n_jobs=jobs)(delayed(_alone)(do, *task) for task in tasks)
    return list(found)


def _alone(do: Callable[..., Any], *task: Any) -> Any:
    # Two workers with all threads of the machine each wait for each other.
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        return do(*task)


def _folded(X: Array, y: Array, learner: Learner, split: Split, seed: int, quick: bool) -> Score:
    predicted = np.full(len(y), np.nan)
    mse, r2, sizes, times = [], [], [], []
    for train, held in split.folds():
        began = time.process_time()
        model = trained(learner, X[train], y[train], seed=seed, quick=quick)
        times.append(time.process_time() - began)
        predicted[held] = model.predict(X[held])
        mse.append(float(np.mean((y[held] - predicted[held]) ** 2)))
        r2.append(r_squared(y[held], predicted[held]))
        sizes.append(learner.size(model))
    return Score(
        mse=np.array(mse),
        r2=np.array(r2),
        predicted=predicted,
        true=y,
        sizes=np.array(sizes),
        train_time_s=float(np.median(times)),
    )
