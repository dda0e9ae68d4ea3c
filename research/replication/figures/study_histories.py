"""A sphere pressed on at a rate before it is pulled off, beside one that starts relaxed.

Claims: none of the thesis for the sphere; Fig. 3.5 says of the punch that history does not matter.

Seen: A sphere pressed on fast and pulled at once holds up to 85 % less when pulled fast; pulled
slowly it has forgotten. The punch of Fig. 3.5 stays in the grey band.

Needs: nothing. mu = 3.24, k = 0.1, standard solid and power law n = 0.6, pressed from apart to 40
h0 without dwell, pulled at 10 and at 1000.

Costs: 28 simulations, half a minute.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import STANDARD, Work, sphere, table
from .style import COLOURS, SIMULATED, decades, panels, words

SIZE = (9.0, 3.8)
_DEPTH, _GAP = 40.0, 6.0
SPEEDS = 10.0 ** np.arange(0, 6)
RATES = (10.0, 1000.0)
EXPONENTS = (STANDARD, 0.6)


def numbers(bench: Bench) -> Numbers:
    """Return the pull-off force by solid, rate and speed of approach, over that of rest."""
    works = []
    for n in EXPONENTS:
        for r in RATES:
            works.append(Work(sphere(r, _DEPTH, exponent=n)))
            for v in SPEEDS:
                moves = (vt.Approach(speed=float(v), to=vt.AtDepth(_DEPTH)),)
                works.append(Work(sphere(r, vt.Apart(_GAP), exponent=n, moves=moves)))
    found = table(bench.each, works, (len(EXPONENTS), len(RATES), 1 + len(SPEEDS)))
    force = found["force"]
    return {
        "exponent": np.array(EXPONENTS),
        "rate": np.array(RATES),
        "approach": SPEEDS,
        "relaxed": force[:, :, 0],
        "change": force[:, :, 1:] / force[:, :, :1] - 1,
        "error": found["force_error"][:, :, 1:],
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel for each rate of retraction."""
    for i, ax in enumerate(panels(figure, 1, 2, sharey=True)):
        for j, n in enumerate(numbers["exponent"]):
            style = SIMULATED | {"color": COLOURS[j], "marker": "os"[j], "ls": ":"}
            ax.plot(numbers["approach"], 100 * numbers["change"][j, i], **style, label=words(n))
        ax.axhspan(-2, 2, color="0.92", zorder=0)
        decades(ax, y=False)
        ax.set_title(f"pulled at {numbers['rate'][i]:g} $h_0/\\tau_0$")
        ax.set_xlabel(r"speed of approach / $h_0/\tau_0$")
    figure.axes[0].set_ylabel("force beside the relaxed start [%]")
    figure.axes[0].legend()
