"""Pull-off force by crack speed, from four radii of the start.

Claims: from a large start the force follows one curve of the crack speed; a small start keeps it
from the full amplification.

Seen: One curve, Persson-Brener's, as long as the start is large enough; from 1.94 it ends at 11.

Needs: nothing. k = 0.1, mu = 3.24, n = 0.8.

Costs: 60 simulations, a quarter of a minute.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import persson_brener

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, Work, solid, sphere, table, tip_speed
from .style import COLOURS, MARKERS, SIMULATED, TIP_SPEED, decades, panels

RADII = (1.94, 2.50, 3.61, 5.28)
RATES = np.geomspace(0.1, 1e6, 15)


def numbers(bench: Bench) -> Numbers:
    """Return force [pi R dg0] and crack speed [l0/tau0] by start and rate, and theory."""
    works = [Work(sphere(float(r), vt.AtRadius(a), exponent=0.8)) for a in RADII for r in RATES]
    found = table(bench.each, works, (len(RADII), len(RATES)))
    speed = np.geomspace(1e-2, 1e7, 91)
    return {
        "start": np.array(RADII),
        "rate": RATES,
        "force": CHAPTER_4 * found["force"],
        "error": found["force_error"],
        "speed": tip_speed(found["speed"]),
        "theory_speed": speed,
        "theory": 1.5
        * np.asarray(persson_brener.amplification(speed, material=solid(exponent=0.8))),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw markers for each start, theory as a line."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["theory_speed"], numbers["theory"], "k-", label="Persson-Brener, 1.5 times")
    for i, a in enumerate(numbers["start"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(numbers["speed"][i], numbers["force"][i], **style, label=f"start at {a:g}")
    ax.axhline(15, color="0.5", lw=0.8)
    decades(ax)
    ax.set_ylim(1.2, 20)
    ax.set_yticks([1.5, 5, 10, 15], ["1.5", "5", "10", "15"])
    ax.minorticks_off()
    ax.set_xlabel(TIP_SPEED)
    ax.set_ylabel(r"pull-off force $\hat P_{po}$ / $\pi R\,\Delta\gamma_0$")
    ax.legend()
