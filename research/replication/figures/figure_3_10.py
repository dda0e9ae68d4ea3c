"""Work of separation of four layers by crack speed: a bell.

Claims: little work at low and at high speed, a maximum between them.

Seen: A bell for each layer, seven works of adhesion high for the thickest. Its left end is 1.2 and
not 1: the crack runs away at the end of the slowest retraction.

Needs: the simulations of Fig. 3.8. The work is Eq. 3.36 with its limits and scale corrected.

Costs: nothing more.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import punch

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .figure_3_8 import SPEED
from .style import COLOURS, MARKERS, decades, panels

SIZE = (9.0, 3.8)


def numbers(bench: Bench) -> Numbers:
    """Return the work [dg0] by thickness and rate, and that of the elastic layer."""
    found = bench.of("3.8")
    elastic = punch.crossover.work_of_separation(
        found["thickness"], half_width=HALF_WIDTH, work_of_adhesion=1.0, base=punch.Frictionless()
    )
    parts = ("thickness", "rate", "speed", "separation")
    return {name: found[name] for name in parts} | {"elastic": np.asarray(elastic)}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the work by crack speed, and by the rate, which is what one sets."""
    left, right = panels(figure, 1, 2, sharey=True)
    for i, b in enumerate(numbers["thickness"]):
        style = {"color": COLOURS[i], "marker": MARKERS[i], "mfc": "none", "lw": 0.8}
        left.plot(
            numbers["speed"][i], numbers["separation"][i], **style, label=f"$b$ = {b:g} $a_0$"
        )
        right.plot(numbers["rate"], numbers["separation"][i], **style)
    for ax, words in ((left, SPEED), (right, r"retraction rate $r\,\tau/h_0$")):
        decades(ax, y=False)
        ax.set_xlabel(words)
        ax.axhline(1, color="0.5", lw=0.8)
    left.set_ylim(0, None)
    left.set_ylabel(r"work of separation / $\Delta\gamma_0$")
    left.legend()
