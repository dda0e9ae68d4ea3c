"""Forces predicted by models with the descriptor.

Claims: forest and XGBoost with the descriptor are better than without.

Needs: the shipped set; each row is predicted by a model that has not seen it.

Costs: ten models, a quarter of a minute.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..bench import Bench, Numbers
from ..learning.features import Descriptor, Target
from ..learning.learners import BOOSTING
from .learned import FORCE_PAML, held_out
from .style import COLOURS, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (8.0, 3.9)
TRIALS = {
    "Forest": FORCE_PAML,
    "XGBoost": (Target.FORCE, Descriptor.PUBLISHED, BOOSTING),
}
_POINTS = 800


def numbers(bench: Bench) -> Numbers:
    """Return log10 of the force of some rows, simulated and predicted, with R2 of all."""
    return {name: held_out(trial, _POINTS) for name, trial in TRIALS.items()}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw predicted by simulated forces."""
    for ax, (name, of) in zip(panels(figure, 1, 2), numbers.items(), strict=True):
        ax.plot(of["true"], of["predicted"], "o", ms=2, mfc="none", mew=0.5, color=COLOURS[0])
        ends = np.array([0, np.max(of["true"])])
        ax.plot(ends, ends, "k--", lw=0.8)
        ax.set_title(f"{name}: $R^2$ = {of['r2']:.4f}")
        ax.set_xlabel("$\\log_{10}$ force, simulated")
    figure.axes[0].set_ylabel("$\\log_{10}$ force, predicted")
