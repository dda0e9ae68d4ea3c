"""Error of networks of the trajectory by layers and activation.

Claims: 100-100-100 with rectifiers is the best of the layouts tried.

Seen: More layers help, and rectifiers are ahead of the others throughout.

Needs: the key points of 2,000 rows of the shipped set, at random; the thesis does not print its
values.

Costs: 54 networks, three minutes of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from ..learning.learners import network
from ..learning.trajectories import learned_points
from ..learning.validation import folds, random_split
from .learned import SEED, rows
from .style import COLOURS, panels

SIZE = (6.6, 4.2)
LAYERS = ((50,), (100,), (50, 50), (100, 100), (50, 50, 50), (100, 100, 100))
ACTIVATIONS = ("relu", "tanh", "logistic")
_ROWS, _FOLDS = 2000, 3


def numbers(bench: Bench) -> Numbers:
    """Return mean and spread of the error over three folds, of standardised targets."""
    cells = [(layers, activation) for layers in LAYERS for activation in ACTIVATIONS]
    errors = np.array(list(bench.each(error, cells)))
    shape = (len(LAYERS), len(ACTIVATIONS))
    return {
        "layers": ["-".join(map(str, layers)) for layers in LAYERS],
        "activation": list(ACTIVATIONS),
        "mse": errors.mean(axis=1).reshape(shape),
        "spread": errors.std(axis=1).reshape(shape),
    }


def error(cell: tuple[tuple[int, ...], str]) -> list[float]:
    """Return the error on each of three folds."""
    some = rows().chosen(np.random.default_rng(SEED).permutation(len(rows()))[:_ROWS])
    X, Y = learned_points(some)
    Y = (Y - Y.mean(axis=0)) / Y.std(axis=0)
    found: list[float] = []
    for train, held in folds(random_split(len(X), SEED, _FOLDS)):
        model = network(X[train], Y[train], *cell, SEED, rounds=100, patience=10)
        found.append(float(np.mean((model.predict(X[held]) - Y[held]) ** 2)))
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the errors with their spread, a colour for each activation."""
    (ax,) = panels(figure, 1, 1)
    x = np.arange(len(numbers["layers"]))
    for i, activation in enumerate(numbers["activation"]):
        mse, spread = numbers["mse"][:, i], numbers["spread"][:, i]
        style = {"color": COLOURS[i], "marker": "os^"[i], "capsize": 3, "lw": 1}
        ax.errorbar(x + 0.08 * (i - 1), mse, spread, **style, label=activation)
    ax.set_xticks(x, numbers["layers"])
    ax.set_yscale("log")
    ax.set_xlabel("neurons by layer")
    ax.set_ylabel("mean square error, standardised")
    ax.legend(title="activation")
