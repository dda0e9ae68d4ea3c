"""Learning curve of XGBoost with the descriptor: error by round.

Claims: the error on rows held out falls and levels off; boosting stopped after 689 rounds.

Seen: The error of rows held out has levelled off long before boosting stops.

Needs: the shipped set; 15 % held out, the grid of learning rates and depths of the study.

Costs: twelve boostings, three minutes of processor time.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from ..learning.features import Target, features, target
from ..learning.thesis import STOPPED_AT
from .learned import SEED, rows
from .style import COLOURS, decades, panels

RATES, DEPTHS = (0.02, 0.05, 0.1, 0.3), (4, 6, 8)
# A boosting stops when this many rounds have not helped the rows held out.
_PATIENCE, _MOST_ROUNDS, _HELD_OUT = 50, 2000, 0.15


def parted() -> Any:
    """Return features to learn from and held out, then the forces of both."""
    from sklearn.model_selection import train_test_split

    X, y = features(rows(), descriptor=True), target(rows(), Target.FORCE)
    return train_test_split(X, y, test_size=_HELD_OUT, random_state=SEED)


def numbers(bench: Bench) -> Numbers:
    """Return the error by round of the best of the grid, and when each cell stopped."""
    from xgboost import XGBRegressor

    train, held, y_train, y_held = parted()
    models = [
        XGBRegressor(
            learning_rate=rate,
            max_depth=depth,
            n_estimators=_MOST_ROUNDS,
            early_stopping_rounds=_PATIENCE,
            random_state=SEED,
            n_jobs=1,
        ).fit(train, y_train, eval_set=[(train, y_train), (held, y_held)], verbose=False)
        for rate, depth in product(RATES, DEPTHS)
    ]
    best = min(models, key=lambda model: model.best_score)
    learned, held_out = (best.evals_result()[f"validation_{i}"]["rmse"] for i in (0, 1))
    every = max(1, len(learned) // 200)
    return {
        "round": np.arange(1, len(learned) + 1, every),
        "learned": np.array(learned[::every]),
        "held_out": np.array(held_out[::every]),
        "learning_rate": best.learning_rate,
        "depth": best.max_depth,
        "stopped_at": best.best_iteration + 1,
        "mse": 1e3 * best.best_score**2,
        "rounds_of_the_grid": np.array([model.best_iteration + 1 for model in models]),
        "thesis_rounds": STOPPED_AT,
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both errors, and where it stopped here and there."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["round"], numbers["learned"], ":", color=COLOURS[0], label="rows learned from")
    ax.plot(numbers["round"], numbers["held_out"], color=COLOURS[1], label="rows held out")
    ax.axvline(
        numbers["stopped_at"], color="0.5", lw=1, label=f"best here, {numbers['stopped_at']}"
    )
    ax.axvline(numbers["thesis_rounds"], color="k", ls="--", lw=1, label="thesis, 689")
    decades(ax)
    ax.set_xlabel("boosting round")
    ax.set_ylabel(r"root mean square error of $\log_{10}$ force")
    ax.legend()
