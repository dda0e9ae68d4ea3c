"""Pull-off force by depth of the start for four Tabor numbers, at three rates.

Claims: at high rates a larger Tabor number holds more from a shallow start and less from a deep
one; (b) at 10^3 all reach one plateau, the analytic law; (c) at 10 depth and Tabor number hardly
matter.

Seen: (a) the order of the Tabor numbers turns round at 11.5 h0. (b) there is no plateau: forces
pass a maximum near 50 h0 and fall, for the bulk creeps. (c) beyond 3 h0 nothing matters much.

Needs: the shipped set. n = 0.6, k = 0.1; (a) at 10^8 as its caption has it (10^9 in the text).

Costs: 156 simulations and a model, a minute.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import K, Work, sphere, table
from .learned import FORCE_PAML, analytic, predicted
from .style import COLOURS, DEPTH, FORCE, MODEL, SIMULATED, panels

SIZE = (10.5, 4.2)
TABORS = (0.05, 0.2, 0.8, 3.2)
RATES = (1e8, 1e3, 1e1)
DEPTHS = np.geomspace(0.3, 150, 13)
_FINE = np.geomspace(0.3, 150, 41)
_EXPONENT = 0.6


def numbers(bench: Bench) -> Numbers:
    """Return forces by rate, Tabor number and depth, simulated and by PA-ML; the descriptor."""
    works = [
        Work(sphere(r, float(d), tabor=mu, exponent=_EXPONENT))
        for r in RATES
        for mu in TABORS
        for d in DEPTHS
    ]
    found = table(bench.each, works, (len(RATES), len(TABORS), len(DEPTHS)))
    solid = {"modulus_ratio": K, "exponent": _EXPONENT}
    learned = [
        [predicted(FORCE_PAML, rate=r, tabor=mu, preload=_FINE, **solid) for mu in TABORS]
        for r in RATES
    ]
    theory = [float(analytic(rate=r, tabor=3.2, preload=1.0, **solid)[0]) for r in RATES]
    return {
        "rate": np.array(RATES),
        "tabor": np.array(TABORS),
        "depth": DEPTHS,
        "simulated": found["force"],
        "error": found["force_error"],
        "fine_depth": _FINE,
        "paml": np.array(learned),
        "theory": np.array(theory),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel for each rate."""
    axes = panels(figure, 1, 3)
    for i, ax in enumerate(axes):
        for j, mu in enumerate(numbers["tabor"]):
            style = SIMULATED | {"color": COLOURS[j], "marker": "os^D"[j]}
            ax.plot(numbers["depth"], numbers["simulated"][i, j], **style, label=rf"$\mu$ = {mu:g}")
            ax.plot(numbers["fine_depth"], numbers["paml"][i, j], **MODEL, color=COLOURS[j])
        ax.axhline(numbers["theory"][i], color="0.4", ls="--", lw=1, label="descriptor")
        if i == 0:
            for level, words in ((1 / K, "$1/k$"), (4 / (3 * K), "$4/3k$")):
                ax.axhline(level, color="k", ls="-.", lw=0.8)
                ax.text(0.3, level + 0.15, words)
        ax.set_xscale("log")
        ax.set_ylim(0, None)
        ax.set_title(rf"rate $10^{{{np.log10(numbers['rate'][i]):.0f}}}$")
        ax.set_xlabel(DEPTH)
    axes[0].set_ylabel(FORCE)
    axes[1].plot([], [], **MODEL, color="0.4", label="PA-ML")
    axes[1].legend()
