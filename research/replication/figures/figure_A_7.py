"""Work to pull-off by rate between the two estimates that the thesis calls bounds.

Claims: the work lies between the rubbery bound, Eq. 46, and the glassy one, Eq. 43.

Seen: Between its two ends the work is 2.4 times what is called its upper bound.

Needs: the shipped set. mu = 3.2, start at 73 h0, k = 0.1, n = 1.6. The third line is a bound that
holds at all rates, derived in docs/replication.md: the work of the largest force that is possible
over the way from zero force.

Costs: 25 simulations and a forest, ten seconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import K, Work, sphere, table
from .figure_A_6 import jkr_work
from .learned import WORK_PAML, predicted
from .style import COLOURS, MODEL, RATE, SIMULATED, WORK, decades, panels

TABOR, DEPTH, EXPONENT = 3.2, 73.0, 1.6
RATES = np.geomspace(0.1, 1e8, 37)
POINTS = np.geomspace(0.01, 1e7, 28)
_PRINTED_RADIUS = 2.0139


def numbers(bench: Bench) -> Numbers:
    """Return the work by rate, learned and simulated, with the estimates."""
    works = [Work(sphere(float(r), DEPTH, tabor=TABOR, exponent=EXPONENT)) for r in POINTS]
    found = table(bench.each, works)
    case = {"tabor": TABOR, "modulus_ratio": K, "exponent": EXPONENT, "preload": DEPTH}
    return {
        "rate": RATES,
        "paml": predicted(WORK_PAML, rate=RATES, **case),
        "simulated_rate": POINTS,
        "simulated": found["work"],
        "error": found["work_error"],
        "depth": found["depth"],
        "force": found["force"],
        "rubbery": float(np.asarray(jkr_work(TABOR))),
        "glassy": float(4 / 3 * _PRINTED_RADIUS**2 * np.pi ** (2 / 3) * TABOR),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw works by rate and the two levels."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["rate"], numbers["paml"], **MODEL, color=COLOURS[0], label="PA-ML")
    style = SIMULATED | {"marker": "^", "color": COLOURS[1]}
    ax.plot(numbers["simulated_rate"], numbers["simulated"], **style, label="simulated")
    ax.axhline(numbers["rubbery"], color="k", ls="--", lw=1, label="Eq. 46, rubbery")
    ax.axhline(numbers["glassy"], color="k", ls="-.", lw=1, label="Eq. 43, glassy")
    decades(ax)
    ax.set_ylim(3, 200)
    ax.set_xlabel(RATE)
    ax.set_ylabel(WORK)
    ax.legend(loc="upper right")
