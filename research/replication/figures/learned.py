"""The models of chapter 5, learned from the set that is shipped in place of the thesis's own.

``viscotack.datasets`` has 8,505 detachments whose inputs are spread as Table A.1 says, simulated by
this package: none is repeated, none has a placeholder for its work. What models learn from the
authors' published rows is in the study `published-rows`.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from viscotack import datasets

from ..learning.features import Target, crack_amplification, features, target
from ..learning.learners import Learner, trained
from ..learning.thesis import TABLES
from ..learning.validation import Score, random_split, score
from ..table import Detachments, read_detachments

# The authors'.
SEED = 42
# What is learned, whether with the descriptor, and by what.
Trial = tuple[Target, bool, Learner]
# Models that the thesis means by ML and PA-ML, of the force and of the work.
FORCE_ML = (Target.FORCE, False, Learner.BOOSTING)
FORCE_PAML = (Target.FORCE, True, Learner.FOREST)
WORK_ML = (Target.WORK, False, Learner.FOREST)
WORK_PAML = (Target.WORK, True, Learner.FOREST)


@lru_cache(1)
def rows() -> Detachments:
    """Return the shipped set."""
    return read_detachments(datasets.path("thesis"))


@lru_cache(8)
def model(which: Target, descriptor: bool, learner: Learner) -> Any:
    """Return a model that has learned all rows."""
    X, y = features(rows(), descriptor=descriptor), target(rows(), which)
    return trained(learner, X, y, seed=SEED)


def asked(**columns: Any) -> Detachments:
    """Return rows of inputs, whose answers are not known; single numbers stand for all rows."""
    names = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
    values = np.broadcast_arrays(*(np.asarray(columns[name], dtype=float) for name in names))
    one = np.ones(values[0].size)
    return Detachments(
        **{name: np.ravel(value) for name, value in zip(names, values, strict=True)},
        pull_off_force=one,
        work_to_pull_off=one,
        work_known=one > 0,
    )


def predicted(trial: Trial, **columns: Any) -> Any:
    """Return the force or the work that a model gives to inputs."""
    X = features(asked(**columns), descriptor=trial[1])
    return np.asarray(10 ** model(*trial).predict(X), dtype=float)


def analytic(**columns: Any) -> Any:
    """Return the descriptor as published, which the thesis calls XPB."""
    return crack_amplification(asked(**columns))


def of_table(number: str, each: Callable[..., Any]) -> dict[str, Any]:
    """Return the entries of a table of the thesis, from five random folds, beside the printed."""
    printed = TABLES[number]
    trials = [(printed.target, printed.descriptor, Learner(name)) for name in printed.entries]
    scores = list(each(_scored, trials))
    return {
        "model": list(printed.entries),
        "mse": [1e3 * float(s.mse.mean()) for s in scores],
        "mse_spread": [1e3 * float(s.mse.std()) for s in scores],
        "r2": [float(s.r2.mean()) for s in scores],
        "size": [int(round(float(s.sizes.mean()))) for s in scores],
        "thesis_mse": [entry.mse for entry in printed.entries.values()],
        "thesis_mse_spread": [entry.mse_spread for entry in printed.entries.values()],
        "thesis_r2": [entry.r2 for entry in printed.entries.values()],
    }


def _scored(trial: Trial) -> Score:
    which, descriptor, learner = trial
    X, y = features(rows(), descriptor=descriptor), target(rows(), which)
    return score(X, y, learner, random_split(len(y), SEED), seed=SEED)


def held_out(trial: Trial, points: int) -> dict[str, Any]:
    """Return true and predicted log10 of some rows that their model had not seen."""
    found = _scored(trial)
    some = np.random.default_rng(SEED).permutation(len(found.true))[:points]
    return {
        "true": found.true[some],
        "predicted": found.predicted[some],
        "r2": found.pooled_r2,
    }
