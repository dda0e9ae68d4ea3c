"""Pull-off stress by thickness after six ways to load the punch.

Claims: the loading history changes the pull-off stress negligibly; the inset of the thesis stays
within 2 %.

Seen: The markers of a thickness lie on each other. On the right the differences, largest where the
layer passes from strength to crack, and inside the grey 2 % everywhere.

Needs: the protocols of Table 3.1. The thicknesses of the thesis are not printed.

Costs: 84 simulations, half a minute of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import Work, punch, table
from .style import COLOURS, MARKERS, SIMULATED, decades, panels
from .table_3_1 import RATE, start

SIZE = (9.0, 3.8)
_OVER_WIDTH = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


def numbers(bench: Bench) -> Numbers:
    """Return stress [sigma0] and its relative error by thickness [a0] and protocol."""
    b = HALF_WIDTH * np.array(_OVER_WIDTH)
    works = [Work(punch(float(x), RATE, **start(i))) for x in b for i in range(1, 7)]
    found = table(bench.each, works, (len(b), 6))
    return {
        "thickness": b,
        "stress": found["force"],
        "error": found["force_error"],
        "change": found["force"] / found["force"][:, 1:2] - 1,
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the stresses, and how far each is from that of the relaxed start."""
    left, right = panels(figure, 1, 2)
    for i in range(6):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        left.plot(numbers["thickness"], numbers["stress"][:, i], **style, label=f"protocol {i + 1}")
        right.plot(numbers["thickness"], 100 * numbers["change"][:, i], **(style | {"ls": ":"}))
    decades(left)
    decades(right, y=False)
    for ax in (left, right):
        ax.set_xlabel("layer thickness $b/a_0$")
    left.set_ylabel(r"pull-off stress / $\sigma_0$")
    left.set_yticks([0.2, 0.5, 1.0], ["0.2", "0.5", "1"])
    left.minorticks_off()
    right.set_ylabel("beside the relaxed start [%]")
    right.axhspan(-2, 2, color="0.92", zorder=0)
    left.legend()
