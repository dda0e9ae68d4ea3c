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
from ..learning.features import Descriptor
from ..learning.tuning import forest_curve
from .learned import SEED, rows
from .style import COLOURS, decades, panels


def numbers(bench: Bench) -> Numbers:
    """Return the error by number of trees, on rows learned from and held out."""
    found = forest_curve(rows(), Descriptor.PUBLISHED, seed=SEED, quick=False)
    return {
        "trees": np.array(found["trees"]),
        "learned": np.array(found["rmse_trained"]),
        "held_out": np.array(found["rmse_held_out"]),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both errors."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["trees"], numbers["learned"], "o:", color=COLOURS[0], label="rows learned from")
    ax.plot(numbers["trees"], numbers["held_out"], "o-", color=COLOURS[1], label="rows held out")
    decades(ax)
    ax.set_xlabel("trees")
    ax.set_ylabel(r"root mean square error of $\log_{10}$ force")
    ax.legend()
