"""Learning curve of XGBoost with the descriptor: error by round.

Claims: the error on rows held out falls and levels off; boosting stopped after 689 rounds.

Seen: The error of rows held out has levelled off long before boosting stops.

Needs: the shipped set; 15 % held out, the grid of learning rates and depths of the study.

Costs: twelve boostings, three minutes of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from ..learning.features import Descriptor
from ..learning.tuning import grid_search
from .learned import SEED, rows
from .style import COLOURS, decades, panels


def numbers(bench: Bench) -> Numbers:
    """Return the error by round of the best of the grid, and when each cell stopped."""
    found = grid_search(rows(), Descriptor.PUBLISHED, seed=SEED, quick=False)
    best = found["best"]
    return {
        "round": np.array(best["round"]),
        "learned": np.array(best["rmse_trained"]),
        "held_out": np.array(best["rmse_held_out"]),
        "learning_rate": best["learning_rate"],
        "depth": best["depth"],
        "stopped_at": best["rounds"],
        "mse": best["mse_1e-3"],
        "rounds_of_the_grid": np.array([cell["rounds"] for cell in found["grid"]]),
        "thesis_rounds": found["thesis_rounds"],
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
