"""Pull-off force by rate from four depths: where the analytic law ends.

Claims: the analytic law holds from 60 h0; at 30, 15 and 7.5 h0 it fails at high rates, and the
largest amplification falls with the depth; PA-ML follows the simulations.

Needs: the shipped set. mu = 3.0 (no row has it), k = 0.1.

Costs: 96 simulations and two models, half a minute.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..bench import Bench, Numbers
from .figure_5_5 import curves, drawn, legend
from .style import FORCE, RATE, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (9.0, 7.0)
CASES = ((3.0, 60.0), (3.0, 30.0), (3.0, 15.0), (3.0, 7.5))


def numbers(bench: Bench) -> Numbers:
    """Return the curves of each depth."""
    return {f"{mu:g}, {d:g}": curves(bench.each, tabor=mu, depth=d) for mu, d in CASES}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel for each Tabor number and depth."""
    axes = panels(figure, 2, 2, sharex=True, sharey=True)
    for ax, (name, of) in zip(axes, numbers.items(), strict=True):
        drawn(ax, of, "paml")
        mu, depth = name.split(", ")
        ax.set_title(rf"$\mu$ = {mu}, start at {depth} $h_0$")
    legend(axes[0])
    for ax in axes[2:]:
        ax.set_xlabel(RATE)
    for ax in axes[::2]:
        ax.set_ylabel(FORCE)
