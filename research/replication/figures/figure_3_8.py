"""Pull-off stress of four layers by the speed of the crack at pull-off.

Claims: thin layers and fast retraction make a high stress, until it is the strength.

Seen: The stress rises over three decades of crack speed to a plateau, which for the thinnest layer
is the strength.

Needs: nothing. Its simulations serve Fig. 3.9, 3.10 and A.1 as well.

Costs: 88 simulations to full separation, a minute of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import FOUR, Work, punch, table
from .style import COLOURS, MARKERS, SIMULATED, decades, panels

SPEED = r"crack speed at pull-off $V_c\,\tau/h_0$"
RATES = np.geomspace(1e-3, 1e4, 22)


def numbers(bench: Bench) -> Numbers:
    """Return what comes off how, by thickness [a0] and rate [h0/tau], in units of the package."""
    works = [Work(punch(b, float(r)), until="detached") for b in FOUR for r in RATES]
    found = table(bench.each, works, (len(FOUR), len(RATES)))
    return {"thickness": np.array(FOUR), "rate": RATES} | found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a curve of markers for each thickness."""
    (ax,) = panels(figure, 1, 1)
    for i, b in enumerate(numbers["thickness"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(numbers["speed"][i], numbers["force"][i], **style, label=f"$b$ = {b:g} $a_0$")
    decades(ax, y=False)
    ax.set_ylim(0, 1.05)
    ax.set_xlabel(SPEED)
    ax.set_ylabel(r"pull-off stress / $\sigma_0$")
    ax.legend()
