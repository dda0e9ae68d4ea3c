"""Work to pull-off by rate: two forests and simulation.

Claims: the work has a bell over the rate; a larger exponent raises it at low and lowers it at high
rates; with the descriptor the forest is smoother.

Seen: Bells over the rate; the lines of the exponents cross near their tops. The forest without the
descriptor moves in steps.

Needs: the shipped set. mu = 3.24, start at 73 h0, k = 0.1.

Costs: 36 simulations and two forests, a quarter of a minute.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import TABOR, K, Work, sphere, table
from .learned import WORK_ML, WORK_PAML, predicted
from .style import MODEL, RATE, SIMULATED, WORK, colour, decades, panels, words

SIZE = (10.0, 4.2)
EXPONENTS = (0.4, 0.6, 1.6)
_DEPTH = 73.0
RATES = np.geomspace(0.1, 1e9, 41)
POINTS = np.geomspace(0.1, 1e6, 15)


def numbers(bench: Bench) -> Numbers:
    """Return works by exponent and rate."""
    found: Numbers = {"rate": RATES, "simulated_rate": POINTS}
    for n in EXPONENTS:
        case = {"tabor": TABOR, "modulus_ratio": K, "exponent": n, "preload": _DEPTH}
        simulated = table(bench.each, [Work(sphere(float(r), _DEPTH, exponent=n)) for r in POINTS])
        found[f"{n:g}"] = {
            "ml": predicted(WORK_ML, rate=RATES, **case),
            "paml": predicted(WORK_PAML, rate=RATES, **case),
            "simulated": simulated["work"],
            "error": simulated["work_error"],
        }
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the forest without the descriptor on the left, with it on the right."""
    axes = panels(figure, 1, 2, sharey=True)
    for ax, name, title in zip(axes, ("ml", "paml"), ("forest", "forest, descriptor"), strict=True):
        for n in EXPONENTS:
            of, hue = numbers[f"{n:g}"], colour(n)
            ax.plot(numbers["rate"], of[name], **MODEL, color=hue, label=words(n))
            ax.plot(numbers["simulated_rate"], of["simulated"], **SIMULATED, marker="^", color=hue)
        decades(ax)
        ax.set_title(title)
        ax.set_xlabel(RATE)
    axes[0].set_ylabel(WORK)
    axes[0].plot([], [], **SIMULATED, marker="^", color="0.3", label="simulated")
    axes[0].legend()
