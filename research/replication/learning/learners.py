"""The kinds of model that are compared, with the settings that the thesis's authors used.

Trees, forest and boosting have the settings that scikit-learn and xgboost give when none are
stated; inputs and target of the network are standardised. Nothing is learned by code of this
project.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..table import Array


@dataclass(frozen=True)
class Learner:
    """A kind of model, as the tables call it, made from a seed.

    Its size is the number of trainable parameters, counted as in the thesis: coefficients; leaves
    less one of a tree; of the first tree, times trees, for the forest; leaves for boosting.
    """

    name: str
    make: Callable[[int], Any]
    size: Callable[[Any], int]


def trained(learner: Learner, X: Array, y: Array, *, seed: int) -> Any:
    """Return an estimator that has learned rows of features and targets."""
    return learner.make(seed).fit(X, y)


def _linear(seed: int) -> Any:
    from sklearn.linear_model import LinearRegression

    return LinearRegression()


def _tree(seed: int) -> Any:
    from sklearn.tree import DecisionTreeRegressor

    return DecisionTreeRegressor(random_state=seed)


def _forest(seed: int) -> Any:
    from sklearn.ensemble import RandomForestRegressor

    return RandomForestRegressor(random_state=seed)


def _boosting(seed: int) -> Any:
    from xgboost import XGBRegressor

    return XGBRegressor(n_estimators=100, random_state=seed, n_jobs=1)


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


def _boosting_leaves(model: Any) -> int:
    return sum(tree.count("leaf=") for tree in model.get_booster().get_dump())


LINEAR = Learner("Linear Regression", _linear, lambda m: m.coef_.size + 1)
TREE = Learner("Regression Tree", _tree, lambda m: m.get_n_leaves() - 1)
FOREST = Learner(
    "Random Forest", _forest, lambda m: len(m.estimators_) * (m.estimators_[0].get_n_leaves() - 1)
)
BOOSTING = Learner("XGBoost", _boosting, _boosting_leaves)

LEARNERS = {learner.name: learner for learner in (LINEAR, TREE, BOOSTING, FOREST)}
