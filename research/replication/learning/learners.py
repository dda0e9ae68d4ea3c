"""The kinds of model that are compared, with the settings that the thesis's authors used.

Trees, forest and boosting have the settings that scikit-learn and xgboost give when none are
stated; inputs and target of the network are standardised. Nothing is learned by code of this
project.
"""

import warnings
from enum import StrEnum
from typing import Any

from ..table import Array


class Learner(StrEnum):
    """A kind of model, as the tables call it."""

    LINEAR = "Linear Regression"
    TREE = "Regression Tree"
    FOREST = "Random Forest"
    BOOSTING = "XGBoost"


def trained(learner: Learner, X: Array, y: Array, *, seed: int) -> Any:
    """Return an estimator that has learned rows of features and targets."""
    from sklearn.ensemble import RandomForestRegressor
    from sklearn.linear_model import LinearRegression
    from sklearn.tree import DecisionTreeRegressor
    from xgboost import XGBRegressor

    estimators = {
        Learner.LINEAR: LinearRegression(),
        Learner.TREE: DecisionTreeRegressor(random_state=seed),
        Learner.FOREST: RandomForestRegressor(random_state=seed),
        Learner.BOOSTING: XGBRegressor(n_estimators=100, random_state=seed, n_jobs=1),
    }
    return estimators[learner].fit(X, y)


def size(model: Any) -> int:
    """Return the number of trainable parameters of an estimator, counted as in the thesis.

    Coefficients; leaves less one of a tree; of the first tree, times trees, for the forest; leaves
    for boosting.
    """
    if hasattr(model, "get_booster"):
        return sum(tree.count("leaf=") for tree in model.get_booster().get_dump())
    if hasattr(model, "coef_"):
        return model.coef_.size + 1
    if hasattr(model, "estimators_"):
        return len(model.estimators_) * (model.estimators_[0].get_n_leaves() - 1)
    return model.get_n_leaves() - 1


def network(
    X: Array,
    y: Array,
    layers: tuple[int, ...],
    activation: str,
    seed: int,
    *,
    rounds: int,
    validation: float = 0.1,
    patience: int = 20,
) -> Any:
    """Return a trained network, Adam at 1e-3, that stopped when a part held out said so."""
    from sklearn.compose import TransformedTargetRegressor
    from sklearn.neural_network import MLPRegressor
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    net = MLPRegressor(
        hidden_layer_sizes=layers,
        activation=activation,  # pyright: ignore[reportArgumentType]
        learning_rate_init=1e-3,
        max_iter=rounds,
        early_stopping=True,
        validation_fraction=validation,
        n_iter_no_change=patience,
        random_state=seed,
    )
    model = TransformedTargetRegressor(
        make_pipeline(StandardScaler(), net), transformer=StandardScaler()
    )
    with warnings.catch_warnings():
        # that the last of the rounds was reached is seen in the error on rows held out
        warnings.filterwarnings("ignore", message="Stochastic Optimizer: Maximum iterations")
        return model.fit(X, y)
