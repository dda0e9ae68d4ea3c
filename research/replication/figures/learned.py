"""The models of chapter 5, learned from the set that is shipped in place of the thesis's own.

``viscotack.datasets`` has 8,505 detachments whose inputs are spread as Table A.1 says, simulated by
this package: none is repeated, none has a placeholder for its work. What models learn from the
authors' published rows is in the study `published-rows`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from viscotack import datasets

from ..learning.features import Descriptor, Target, crack_amplification, features, target
from ..learning.learners import BOOSTING, FOREST, LEARNERS, Learner, check_installed, trained
from ..learning.splits import random_split
from ..learning.thesis import TABLES
from ..learning.validation import Score, Trial, score
from ..table import Detachments, read_detachments

# The authors'.
SEED = 42
# Models that the thesis means by ML and PA-ML, of the force and of the work.
FORCE_ML = (Target.FORCE, Descriptor.NONE, BOOSTING)
FORCE_PAML = (Target.FORCE, Descriptor.PUBLISHED, FOREST)
WORK_ML = (Target.WORK, Descriptor.NONE, FOREST)
WORK_PAML = (Target.WORK, Descriptor.PUBLISHED, FOREST)


@lru_cache(1)
def rows() -> Detachments:
    """Return the shipped set."""
    check_installed()
    return read_detachments(datasets.path("thesis"))


@lru_cache(8)
def model(which: Target, descriptor: Descriptor, learner: Learner) -> Any:
    """Return a model that has learned all rows."""
    X, y = features(rows(), descriptor), target(rows(), which)
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


def predicted(trial: tuple[Target, Descriptor, Learner], **columns: Any) -> Any:
    """Return the force or the work that a model gives to inputs."""
    X = features(asked(**columns), trial[1])
    return np.asarray(10 ** model(*trial).predict(X), dtype=float)


def analytic(**columns: Any) -> Any:
    """Return the descriptor as published, which the thesis calls XPB."""
    return crack_amplification(asked(**columns), Descriptor.PUBLISHED)


def of_table(number: str, each: Callable[..., Any]) -> dict[str, Any]:
    """Return the entries of a table of the thesis, from five random folds, beside the printed."""
    printed = next(table for table in TABLES if table.number == number)
    learners = [name for name in printed.entries]
    scores = list(each(_scored, [(number, name) for name in learners]))
    return {
        "model": learners,
        "mse": [1e3 * float(s.mse.mean()) for s in scores],
        "mse_spread": [1e3 * float(s.mse.std()) for s in scores],
        "r2": [float(s.r2.mean()) for s in scores],
        "r2_spread": [float(s.r2.std()) for s in scores],
        "size": [int(round(float(s.sizes.mean()))) for s in scores],
        "thesis_mse": [printed.entries[name].mse for name in learners],
        "thesis_mse_spread": [printed.entries[name].mse_spread for name in learners],
        "thesis_r2": [printed.entries[name].r2 for name in learners],
        "thesis_r2_spread": [printed.entries[name].r2_spread for name in learners],
    }


def _scored(entry: tuple[str, str]) -> Score:
    return scored(rows(), *entry)


def scored(of: Detachments, number: str, name: str) -> Score:
    """Return the score of a model of a table of the thesis on random folds of rows."""
    table = next(table for table in TABLES if table.number == number)
    learner = next(learner for learner in LEARNERS if learner.name == name)
    trial = Trial(table.target, table.descriptor, learner)
    return score(of, trial, random_split(len(of), SEED), seed=SEED)


def held_out(trial: tuple[Target, Descriptor, Learner], points: int) -> dict[str, Any]:
    """Return true and predicted log10 of some rows that their model had not seen."""
    found = score(rows(), Trial(*trial), random_split(len(rows()), SEED), seed=SEED)
    some = np.random.default_rng(SEED).permutation(len(found.true))[:points]
    return {
        "true": found.true[some],
        "predicted": found.predicted[some],
        "r2": found.pooled_r2,
        "mse": 1e3 * found.pooled_mse,
    }
