"""Work to pull-off by rate for four Tabor numbers.

Claims: the work grows with the Tabor number at every rate.

Seen: Works in the order of the Tabor numbers at every rate. The model is poor at mu = 0.2, of which
the set has no row.

Needs: the shipped set. Start at 73 h0, k = 0.1, n = 1.6 and 0.6.

Costs: 88 simulations and a forest, half a minute.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import K, Work, sphere, table
from .figure_5_8 import TABORS
from .learned import WORK_PAML, predicted
from .style import COLOURS, MODEL, RATE, SIMULATED, WORK, decades, panels

SIZE = (10.0, 4.2)
EXPONENTS = (1.6, 0.6)
_DEPTH = 73.0
RATES = np.geomspace(0.1, 1e9, 41)
POINTS = np.geomspace(0.1, 1e6, 11)


def numbers(bench: Bench) -> Numbers:
    """Return works by exponent, Tabor number and rate."""
    found: Numbers = {"rate": RATES, "simulated_rate": POINTS, "tabor": np.array(TABORS)}
    for n in EXPONENTS:
        works = [
            Work(sphere(float(r), _DEPTH, tabor=mu, exponent=n)) for mu in TABORS for r in POINTS
        ]
        simulated = table(bench.each, works, (len(TABORS), len(POINTS)))
        solid = {"modulus_ratio": K, "exponent": n, "preload": _DEPTH}
        found[f"{n:g}"] = {
            "paml": np.array(
                [predicted(WORK_PAML, rate=RATES, tabor=mu, **solid) for mu in TABORS]
            ),
            "simulated": simulated["work"],
            "error": simulated["work_error"],
        }
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel for each exponent."""
    axes = panels(figure, 1, 2, sharey=True)
    for ax, n in zip(axes, EXPONENTS, strict=True):
        of = numbers[f"{n:g}"]
        for i, mu in enumerate(numbers["tabor"]):
            style = SIMULATED | {"color": COLOURS[i], "marker": "os^D"[i]}
            ax.plot(
                numbers["simulated_rate"], of["simulated"][i], **style, label=rf"$\mu$ = {mu:g}"
            )
            ax.plot(numbers["rate"], of["paml"][i], **MODEL, color=COLOURS[i])
        decades(ax)
        ax.set_title(f"$n$ = {n:g}")
        ax.set_xlabel(RATE)
    axes[0].set_ylabel(WORK)
    axes[1].plot([], [], **MODEL, color="0.4", label="PA-ML")
    axes[1].legend(loc="lower right")
