"""Work to pull-off at a high rate for four Tabor numbers, beside the estimate of Eq. 43.

Claims: Eq. 43, (4/3) a_po^2 pi^(2/3) mu, is an upper bound of the glassy work.

Seen: Squares are the estimate of Eq. 43 with the printed radii. It is close at mu = 0.8 and far
above the simulations at small Tabor numbers.

Needs: the shipped set; the printed radii at pull-off. Start at 73 h0, k = 0.1, n = 1.6, rate 10^5.

Costs: eight simulations and a forest, ten seconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, K, Work, sphere, table
from .figure_2_1 import UNIT
from .learned import WORK_PAML, predicted
from .style import COLOURS, SIMULATED, WORK, decades, panels

TABORS = (0.05, 0.2, 0.8, 3.2)
_RADII = (6.1377, 3.0689, 1.9564, 2.0139)
_DEPTH, _RATE, _FAST = 73.0, 1e5, 1e9


def jkr_work(tabor: object) -> object:
    """Return the work to pull-off of JKR [1.5 pi R dg0 h0], Eq. 46."""
    # in the units of Eq. 4.16 the depth is mu pi^(2/3) h0
    unit = float(jkr.work_to_pull_off(**UNIT)) / CHAPTER_4
    return unit * np.asarray(tabor) * np.pi ** (2 / 3)


def numbers(bench: Bench) -> Numbers:
    """Return the works by Tabor number: learned, simulated at two rates, and by two estimates."""
    mu = np.array(TABORS)
    works = [Work(sphere(r, _DEPTH, tabor=m, exponent=1.6)) for r in (_RATE, _FAST) for m in TABORS]
    found = table(bench.each, works, (2, len(TABORS)))
    case = {"modulus_ratio": K, "exponent": 1.6, "preload": _DEPTH, "rate": _RATE}
    return {
        "tabor": mu,
        "paml": predicted(WORK_PAML, tabor=mu, **case),
        "simulated": found["work"][0],
        "error": found["work_error"][0],
        "fast": found["work"][1],
        "radius": found["radius"][0],
        "printed_radius": np.array(_RADII),
        "estimate": 4 / 3 * np.array(_RADII) ** 2 * np.pi ** (2 / 3) * mu,
        "jkr_fast": np.asarray(jkr_work(mu)) * K ** (-2 / 3),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw them by Tabor number."""
    (ax,) = panels(figure, 1, 1)
    mu = numbers["tabor"]
    ax.plot(mu, numbers["estimate"], "s", color=COLOURS[1], label="Eq. 43, printed radii")
    ax.plot(mu, numbers["jkr_fast"], "k--", lw=1, label="JKR of the fast limit")
    ax.plot(mu, numbers["simulated"], **SIMULATED, marker="^", color=COLOURS[2], label="simulated")
    ax.plot(mu, numbers["fast"], **SIMULATED, marker="v", color=COLOURS[3], label="at $10^9$")
    ax.plot(mu, numbers["paml"], ".", color=COLOURS[0], ms=9, label="PA-ML")
    decades(ax)
    ax.set_xlabel(r"Tabor number $\mu$")
    ax.set_ylabel(f"{WORK}, rate $10^5$")
    ax.legend()
