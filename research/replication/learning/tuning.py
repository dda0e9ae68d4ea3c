"""Settings and learning curves: appendix X and Fig. 5.12 of the thesis."""

from itertools import product
from typing import Any

import numpy as np

from ..table import Array, Detachments
from .features import Descriptor, Target, features, target
from .learners import network
from .splits import random_split
from .thesis import STOPPED_AT

Part = dict[str, Any]

_RATES, _DEPTHS = (0.02, 0.05, 0.1, 0.3), (4, 6, 8)
# A boosting stops when this many rounds have not helped the rows held out.
_PATIENCE, _MOST_ROUNDS, _HELD_OUT = 50, 2000, 0.15
_TREES = (1, 2, 5, 10, 20, 50, 100, 200)
_LAYERS = ((50,), (100,), (50, 50), (100, 100), (50, 50, 50), (100, 100, 100))
_ACTIVATIONS = ("relu", "tanh", "logistic")


def grid_search(rows: Detachments, descriptor: Descriptor, *, seed: int, quick: bool) -> Part:
    """Return the error on 15 % of the rows by learning rate and depth, each stopped early."""
    from xgboost import XGBRegressor

    train, held, y_train, y_held = _parted(rows, descriptor, seed)
    cells, best = [], None
    grid = [(0.3, 4)] if quick else list(product(_RATES, _DEPTHS))
    for rate, depth in grid:
        model = XGBRegressor(
            learning_rate=rate,
            max_depth=depth,
            n_estimators=20 if quick else _MOST_ROUNDS,
            early_stopping_rounds=_PATIENCE,
            random_state=seed,
            n_jobs=1,
        )
        model.fit(train, y_train, eval_set=[(train, y_train), (held, y_held)], verbose=False)
        cell = {
            "learning_rate": rate,
            "depth": depth,
            "rounds": int(model.best_iteration) + 1,
            "mse_1e-3": 1e3 * float(model.best_score) ** 2,
        }
        cells.append(cell)
        if best is None or cell["mse_1e-3"] < best["mse_1e-3"]:
            curves = [model.evals_result()[f"validation_{i}"]["rmse"] for i in (0, 1)]
            every = max(1, len(curves[0]) // 200)
            best = cell | {
                "round": list(range(1, len(curves[0]) + 1, every)),
                "rmse_trained": curves[0][::every],
                "rmse_held_out": curves[1][::every],
            }
    return {
        "descriptor": descriptor.value,
        "grid": cells,
        "best": best,
        "thesis_rounds": STOPPED_AT,
    }


def forest_curve(rows: Detachments, descriptor: Descriptor, *, seed: int, quick: bool) -> Part:
    """Return the error of a forest on 15 % of the rows by the number of its trees."""
    from sklearn.ensemble import RandomForestRegressor

    train, held, y_train, y_held = _parted(rows, descriptor, seed)
    forest = RandomForestRegressor(warm_start=True, random_state=seed)
    errors: dict[str, list[float]] = {"rmse_trained": [], "rmse_held_out": []}
    trees = _TREES[:3] if quick else _TREES
    for count in trees:
        forest.set_params(n_estimators=count).fit(train, y_train)
        errors["rmse_trained"].append(_rmse(forest, train, y_train))
        errors["rmse_held_out"].append(_rmse(forest, held, y_held))
    return {"descriptor": descriptor.value, "trees": list(trees), **errors}


def architectures(X: Array, Y: Array, *, seed: int, quick: bool) -> list[Part]:
    """Return mean and spread of the error over three folds by layers and activation.

    Of standardised targets, one or many (Fig. 5.12).
    """
    import warnings

    scaled = (Y - Y.mean(axis=0)) / Y.std(axis=0)
    split = random_split(len(X), seed, 3)
    found = []
    for layers, activation in product(
        ((4,),) if quick else _LAYERS, _ACTIVATIONS[:1] if quick else _ACTIVATIONS
    ):
        errors = []
        for train, held in split.folds():
            model = network(layers, activation, seed, rounds=5 if quick else 100, patience=10)
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message="Stochastic Optimizer: Maximum")
                model.fit(X[train], scaled[train])
            errors.append(float(np.mean((model.predict(X[held]) - scaled[held]) ** 2)))
        found.append(
            {
                "layers": list(layers),
                "activation": activation,
                "mse": float(np.mean(errors)),
                "mse_spread": float(np.std(errors)),
            }
        )
    return found


def _parted(rows: Detachments, descriptor: Descriptor, seed: int) -> Any:
    """Return features to learn from and held out, then the targets of both."""
    from sklearn.model_selection import train_test_split

    X, y = features(rows, descriptor), target(rows, Target.FORCE)
    return train_test_split(X, y, test_size=_HELD_OUT, random_state=seed)


def _rmse(model: Any, X: Array, y: Array) -> float:
    return float(np.sqrt(np.mean((model.predict(X) - y) ** 2)))
