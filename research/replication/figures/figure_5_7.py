"""Pull-off force by rate from JKR to DMT: two Tabor numbers, three depths.

Claims: PA-ML sees the passage to DMT, 4/(3k) instead of 1/k, which the analytic law cannot, and the
depth in DMT; it is less good at low rates.

Needs: the shipped set. k = 0.1.

Costs: 96 simulations and two models, half a minute.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..bench import Bench, Numbers
from .figure_5_5 import curves
from .figure_5_6 import draw as drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (9.0, 7.0)
CASES = ((2.56, 75.0), (0.16, 75.0), (0.16, 15.0), (0.16, 7.5))


def numbers(bench: Bench) -> Numbers:
    """Return the curves of each case."""
    return {f"{mu:g}, {d:g}": curves(bench.each, tabor=mu, depth=d) for mu, d in CASES}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel for each Tabor number and depth."""
    drawn(numbers, figure)
