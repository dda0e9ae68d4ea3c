"""Pull-off force by rate from several depths: where the analytic law ends (5.6), and DMT (5.7).

Claims: (5.6) the analytic law holds from 60 h0; at 30, 15 and 7.5 h0 it fails at high rates, and
the largest amplification falls with the depth; PA-ML follows the simulations.

Claims: (5.7) PA-ML sees the passage to DMT, 4/(3k) instead of 1/k, which the analytic law cannot,
and the depth in DMT; it is less good at low rates.

Seen (5.6): From 60 h0 the law, the model and the simulations are one. From 7.5 h0 the law ends at
10 and the truth at 6.5, and the model follows the truth.

Seen (5.7): At mu = 0.16 from 75 h0 the force ends at 12.5, well above 1/k: the passage to DMT, of
which the law knows nothing. From 7.5 h0 the same solid ends below 6.

Needs: the shipped set. mu = 3.0 (no row has it) in 5.6, k = 0.1.

Costs: 96 simulations and two models, half a minute each.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .figure_5_5 import curves, drawn, legend
from .style import FORCE, RATE, panels

SIZE = (9.0, 7.0)
# Tabor number and depth, by figure.
CASES = {
    "5.6": ((3.0, 60.0), (3.0, 30.0), (3.0, 15.0), (3.0, 7.5)),
    "5.7": ((2.56, 75.0), (0.16, 75.0), (0.16, 15.0), (0.16, 7.5)),
}


def numbers(bench: Bench, name: str) -> Numbers:
    """Return the curves of each Tabor number and depth."""
    return {f"{mu:g}, {d:g}": curves(bench.each, tabor=mu, depth=d) for mu, d in CASES[name]}


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
