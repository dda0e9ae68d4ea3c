r"""The network of section 5.5: six points of the retraction at once.

Travel to the pull-off and the forces at 25, 50, 75, 87.5 and 100 % of it, from Tabor number,
modulus ratio, exponent, rate and preload, the lengths over the Tabor number. 70 % of the rows are
learned from, 15 % say when to stop, 15 % judge.

The authors' modified logarithm, :math:`\mathrm{sgn}(y) \ln |y|`, jumps at zero and gives 0.5
and -2 the same value, so forces cannot be had back from it. :math:`\mathrm{sgn}(y) \ln(1 + |y|)`
stands in its place.
"""

import warnings
from typing import Any

import numpy as np

from ..table import Array, Detachments
from .learners import network, network_size
from .splits import group_split
from .tuning import architectures
from .validation import r_squared

POINTS = (
    "travel to pull-off",
    "force at 25 %",
    "force at 50 %",
    "force at 75 %",
    "force at 87.5 %",
    "force at pull-off",
)
SHARES = (0.0, 0.25, 0.5, 0.75, 0.875, 1.0)
_LAYERS, _HELD_OUT, _SHOWN = (100, 100, 100), 0.15, 6
ABSENT = (
    "the table has no trajectories (columns travel_to_pull_off and force_at_25 to force_at_87_5); "
    "the authors published none, a campaign of this package writes them"
)


def trajectories(rows: Detachments, *, seed: int, quick: bool) -> dict[str, Any]:
    """Return how well the six points are met, on random rows and on new (mu, k, n)."""
    if rows.key_points is None:
        return {"absent": ABSENT}
    from sklearn.model_selection import train_test_split

    X, Y = learned_points(rows)
    train, test = train_test_split(np.arange(len(rows)), test_size=_HELD_OUT, random_state=seed)
    model = _fit(X[train], Y[train], seed, quick)
    found = model.predict(X[test])
    points = _points(found, rows.tabor[test])
    solid = np.stack([rows.tabor, rows.modulus_ratio, rows.exponent], axis=1)
    groups = np.ravel(np.unique(solid, axis=0, return_inverse=True)[1])
    new = np.empty_like(Y)
    for some, held in group_split("a new (mu, k, n)", groups, seed).folds():
        new[held] = _fit(X[some], Y[some], seed, quick).predict(X[held])
    shown = test[:_SHOWN]
    return {
        "size": network_size(model),
        "rows": {"learned from": len(train), "judged": len(test)},
        "points": [
            {
                "point": name,
                "r2": r_squared(Y[test, i], found[:, i]),
                "r2_new_mu_k_n": r_squared(Y[:, i], new[:, i]),
                "median_error": float(np.median(_relative(points, rows.key_points[test])[:, i])),
            }
            for i, name in enumerate(POINTS)
        ],
        "shown": [
            {
                "tabor": float(rows.tabor[row]),
                "modulus_ratio": float(rows.modulus_ratio[row]),
                "exponent": float(rows.exponent[row]),
                "preload": float(rows.preload[row]),
                "rate": float(rows.rate[row]),
                "true": rows.key_points[row].tolist(),
                "predicted": points[i].tolist(),
            }
            for i, row in enumerate(shown)
        ],
        "architectures": architectures(X[train], Y[train], seed=seed, quick=quick),
    }


def predictor(rows: Detachments, seed: int) -> Any:
    """Return a network that has learned the six points of all rows; `points_of` asks it."""
    X, Y = learned_points(rows)
    return _fit(X, Y, seed, quick=False)


def points_of(model: Any, rows: Detachments) -> Array:
    """Return the six points, shape (n, 6), that a network gives to the inputs of rows."""
    return _points(model.predict(_inputs(rows)), rows.tabor)


def learned_points(rows: Detachments) -> tuple[Array, Array]:
    """Return what the network learns from, and what it learns."""
    return _inputs(rows), _targets(rows)


def kept_sign(y: Array) -> Array:
    """Return sgn(y) ln(1 + abs(y)).

    Examples
    --------
    >>> [f"{x:.3f}" for x in kept_sign(np.array([-2.0, 0.0, 0.5]))]
    ['-1.099', '0.000', '0.405']
    """
    return np.sign(y) * np.log1p(np.abs(y))


def _inputs(rows: Detachments) -> Array:
    return np.stack(
        [
            kept_sign(rows.preload / rows.tabor),
            np.log(rows.rate),
            rows.tabor,
            np.log(rows.modulus_ratio),
            rows.exponent,
        ],
        axis=1,
    )


def _targets(rows: Detachments) -> Array:
    assert rows.key_points is not None
    travel = rows.key_points[:, :1] / rows.tabor[:, None]
    return kept_sign(np.hstack([travel, rows.key_points[:, 1:]]))


def _points(found: Array, tabor: Array) -> Array:
    plain = np.sign(found) * np.expm1(np.abs(found))
    return np.column_stack([plain[:, 0] * tabor, plain[:, 1:]])


def _relative(found: Array, true: Array) -> Array:
    """Return errors over the travel, or over the greatest force of the retraction's points."""
    scale = np.abs(true)
    scale[:, 1:] = scale[:, 1:].max(axis=1, keepdims=True)
    return np.abs(found - true) / scale


def _fit(X: Array, Y: Array, seed: int, quick: bool) -> Any:
    # of the rows that are not judged, those that say when to stop are 15 % of all
    model = network(
        (8,) if quick else _LAYERS,
        "relu",
        seed,
        rounds=5 if quick else 500,
        validation=_HELD_OUT / (1 - _HELD_OUT),
    )
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Stochastic Optimizer: Maximum iterations")
        return model.fit(X, Y)
