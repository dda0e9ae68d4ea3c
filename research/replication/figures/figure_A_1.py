"""Effective surface energy of four layers beside Persson and Brener limited by size.

Claims: Eq. 4 of appendix II, with beta = 64 Sigma0/(9 sqrt 3), agrees with the simulations as
Greenwood's theory does.

Seen: Persson-Brener with the same limit: the picture of Fig. 3.9 again.

Needs: the simulations of Fig. 3.8.

Costs: nothing more.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .figure_3_9 import by_theory, curves


def numbers(bench: Bench) -> Numbers:
    """Return the energies simulated and by theory."""
    found = bench.of("3.9")
    some = {name: found[name] for name in ("thickness", "speed", "energy")}
    return some | {"persson_brener": by_theory("persson-brener")}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw simulations as markers, theory dashed."""
    curves(figure.subplots(), numbers, numbers["persson_brener"], "Persson-Brener, Eq. (4)")
