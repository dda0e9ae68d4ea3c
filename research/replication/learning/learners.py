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


def check_installed() -> None:
    """Raise ModuleNotFoundError, with what to do, unless the learning libraries are there."""
    try:
        import sklearn
        import xgboost
    except ImportError as error:
        raise ModuleNotFoundError(
            f"learning needs scikit-learn and xgboost, and {error.name} is missing; install them "
            "with pip install --editable '.[research]'"
        ) from None
    assert sklearn and xgboost


@dataclass(frozen=True)
class Learner:
    """A kind of model.

    Attributes
    ----------
    name : str
        As the tables call it.
    make : callable
        Returns an estimator that has learned nothing yet, from a seed and whether it is to be
        a small one, for a trial.
    size : callable
        Returns the number of trainable parameters of one that has learned, counted as in the
        thesis: coefficients; leaves less one of a tree; of the first tree, times trees, for the
        forest; leaves for boosting; weights for the network.
    """

    name: str
    make: Callable[[int, bool], Any]
    size: Callable[[Any], int]


def trained(learner: Learner, X: Array, y: Array, *, seed: int, quick: bool = False) -> Any:
    """Return an estimator that has learned rows of features and targets."""
    estimator = learner.make(seed, quick)
    with warnings.catch_warnings():
        # That the last of the rounds was reached is seen in the error on rows held out.
        warnings.filterwarnings("ignore", message="Stochastic Optimizer: Maximum iterations")
        return estimator.fit(X, y)


def _linear(seed: int, quick: bool) -> Any:
    from sklearn.linear_model import LinearRegression

    return LinearRegression()


def _tree(seed: int, quick: bool) -> Any:
    from sklearn.tree import DecisionTreeRegressor

    return DecisionTreeRegressor(random_state=seed)


def _forest(seed: int, quick: bool) -> Any:
    from sklearn.ensemble import RandomForestRegressor

    return RandomForestRegressor(n_estimators=3 if quick else 100, random_state=seed)


def _boosting(seed: int, quick: bool) -> Any:
    from xgboost import XGBRegressor

    return XGBRegressor(n_estimators=5 if quick else 100, random_state=seed, n_jobs=1)


def network(
    layers: tuple[int, ...],
    activation: str,
    seed: int,
    *,
    rounds: int,
    validation: float = 0.1,
    patience: int = 20,
) -> Any:
    """Return a feed-forward network, Adam at 1e-3, that stops when a part held out says so."""
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
    return TransformedTargetRegressor(
        make_pipeline(StandardScaler(), net), transformer=StandardScaler()
    )


def _network(seed: int, quick: bool) -> Any:
    return network((8, 8) if quick else (100, 100, 100), "relu", seed, rounds=5 if quick else 200)


def network_size(model: Any) -> int:
    """Return the number of weights of a network that has learned."""
    net = model.regressor_[-1]
    return sum(w.size for w in [*net.coefs_, *net.intercepts_])


def _boosting_leaves(model: Any) -> int:
    return sum(tree.count("leaf=") for tree in model.get_booster().get_dump())


LINEAR = Learner("Linear Regression", _linear, lambda m: m.coef_.size + 1)
TREE = Learner("Regression Tree", _tree, lambda m: m.get_n_leaves() - 1)
FOREST = Learner(
    "Random Forest", _forest, lambda m: len(m.estimators_) * (m.estimators_[0].get_n_leaves() - 1)
)
BOOSTING = Learner("XGBoost", _boosting, _boosting_leaves)
NETWORK = Learner("Network", _network, network_size)

LEARNERS = (LINEAR, TREE, BOOSTING, FOREST, NETWORK)
