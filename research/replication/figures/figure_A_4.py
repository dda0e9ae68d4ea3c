"""Forces predicted by models without the descriptor (A.4) and with it (A.5).

Claims: linear regression is poor, XGBoost is good; forest and XGBoost are better with the
descriptor than without.

Seen (A.4): Linear regression sees the trend and misses the ends; XGBoost is on the line.

Seen (A.5): With the descriptor the clouds are thinner.

Needs: the shipped set; each row is predicted by a model that has not seen it.

Costs: ten models, a quarter of a minute each.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from ..learning.features import Target
from ..learning.learners import BOOSTING, LINEAR
from .learned import FORCE_ML, FORCE_PAML, held_out
from .style import COLOURS, panels

SIZE = (8.0, 3.9)
TRIALS = {
    "A.4": {"Linear regression": (Target.FORCE, False, LINEAR), "XGBoost": FORCE_ML},
    "A.5": {
        "Forest": FORCE_PAML,
        "XGBoost": (Target.FORCE, True, BOOSTING),
    },
}
_POINTS = 800


def numbers(bench: Bench, name: str) -> Numbers:
    """Return log10 of the force of some rows, simulated and predicted, with R2 of all."""
    return {model: held_out(trial, _POINTS) for model, trial in TRIALS[name].items()}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw predicted by simulated forces."""
    for ax, (name, of) in zip(panels(figure, 1, 2), numbers.items(), strict=True):
        ax.plot(of["true"], of["predicted"], "o", ms=2, mfc="none", mew=0.5, color=COLOURS[0])
        ends = np.array([0, np.max(of["true"])])
        ax.plot(ends, ends, "k--", lw=0.8)
        ax.set_title(f"{name}: $R^2$ = {of['r2']:.4f}")
        ax.set_xlabel("$\\log_{10}$ force, simulated")
    figure.axes[0].set_ylabel("$\\log_{10}$ force, predicted")
