"""Learning curve of the forest with the descriptor: error by number of trees.

Claims: the error falls to a plateau and does not rise again.

Seen: After 20 trees nothing is gained, and nothing lost.

Needs: the shipped set; 15 % held out.

Costs: a forest of 200 trees, ten seconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .figure_A_8 import parted
from .learned import SEED
from .style import COLOURS, decades, panels

TREES = (1, 2, 5, 10, 20, 50, 100, 200)


def numbers(bench: Bench) -> Numbers:
    """Return the error by number of trees, on rows learned from and held out."""
    from sklearn.ensemble import RandomForestRegressor

    train, held, y_train, y_held = parted()
    forest = RandomForestRegressor(warm_start=True, random_state=SEED)
    errors = []
    for count in TREES:
        forest.set_params(n_estimators=count).fit(train, y_train)
        errors.append(
            [
                np.sqrt(np.mean((forest.predict(X) - y) ** 2))
                for X, y in ((train, y_train), (held, y_held))
            ]
        )
    learned, held_out = np.array(errors).T
    return {"trees": np.array(TREES), "learned": learned, "held_out": held_out}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both errors."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["trees"], numbers["learned"], "o:", color=COLOURS[0], label="rows learned from")
    ax.plot(numbers["trees"], numbers["held_out"], "o-", color=COLOURS[1], label="rows held out")
    decades(ax)
    ax.set_xlabel("trees")
    ax.set_ylabel(r"root mean square error of $\log_{10}$ force")
    ax.legend()
