"""What a model goes by: permutation importance and partial dependence."""

from typing import Any

import numpy as np

from ..table import Detachments
from .features import Descriptor, Target, feature_names, features, target
from .learners import Learner, trained
from .splits import random_split

_REPEATS, _SAMPLE, _POINTS = 10, 400, 24


def insight(
    rows: Detachments,
    which: Target,
    descriptor: Descriptor,
    learner: Learner,
    *,
    seed: int,
    quick: bool,
) -> dict[str, Any]:
    """Return what shuffling a column of held-out rows costs, and the mean answer along it.

    Returns
    -------
    dict
        For each feature ``importance`` (fall of R2 on one held-out fold when the column is
        shuffled, mean and spread), and ``value`` and ``answer``: mean prediction (log10) over a
        sample of rows when the column is set to a value. Columns are not independent: the rows
        so made may be impossible, a descriptor that belies its own rate and solid.
    """
    from sklearn.inspection import partial_dependence, permutation_importance

    X, y = features(rows, descriptor), target(rows, which)
    train, held = next(random_split(len(rows), seed).folds())
    model = trained(learner, X[train], y[train], seed=seed, quick=quick)
    repeats = 2 if quick else _REPEATS
    shuffled = permutation_importance(
        model, X[held], y[held], n_repeats=repeats, random_state=seed, scoring="r2"
    )
    rng = np.random.default_rng(seed)
    sample = X[rng.choice(len(X), min(_SAMPLE, len(X)), replace=False)]
    found = {}
    for i, name in enumerate(feature_names(descriptor)):
        along = partial_dependence(
            model, sample, [i], grid_resolution=4 if quick else _POINTS, method="brute"
        )
        found[name] = {
            "importance": float(shuffled["importances_mean"][i]),
            "importance_spread": float(shuffled["importances_std"][i]),
            "value": along["grid_values"][0].tolist(),
            "answer": along["average"][0].tolist(),
        }
    return {
        "target": which.value,
        "descriptor": descriptor.value,
        "model": learner.name,
        "features": found,
    }
