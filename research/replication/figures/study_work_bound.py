"""Work to pull-off of every row of the shipped sets beside a bound that holds at all rates.

Claims: Eq. 43 bounds the work from above, Eq. 46 from below.

Seen: Each dot a simulated detachment. Where the range is short, on the right, none passes the
bound; far left, where forces pull outside the contact, it does not apply.

Needs: the shipped sets "thesis" and "broad". The bound is derived in docs/replication.md: the work
of JKR with the energy Delta-gamma0/k up to where its depth is least, 1.1569 mu pi^(2/3) k^(-5/3).

Costs: a second.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack import datasets
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import CHAPTER_4
from .figure_2_1 import UNIT
from .style import COLOURS, decades, panels

SIZE = (6.6, 4.4)
# Contacts of shorter range than this in the glassy state are near to JKR.
LEAST_TABOR = 1.0
# Ends of ranges of the modulus ratio for which the largest share is stated.
RATIOS = (1e-3, 0.05, 0.2, 0.3, 1.0)
_SHOWN = 500


def numbers(bench: Bench) -> Numbers:
    """Return works over the bound by glassy Tabor number, of rows that start in compression."""
    unit = float(jkr.work_to_instability(**UNIT)) / CHAPTER_4
    share, glassy, ratio, below, all_below = [], [], [], [], 0
    for name in ("thesis", "broad"):
        rows = datasets.load(name)
        k, mu, work = (
            rows.column(column).to_numpy()
            for column in ("modulus_ratio", "tabor", "work_to_pull_off")
        )
        start = rows.column("trajectory_force").to_pylist()
        pressed = np.array([force[0] > 0 for force in start])
        known = pressed & np.isfinite(work)
        share.append((work / (unit * mu * np.pi ** (2 / 3) * k ** (-5 / 3)))[known])
        glassy.append((mu * k ** (1 / 3))[known])
        ratio.append(k[known])
        jkr_work = float(jkr.work_to_pull_off(**UNIT)) / CHAPTER_4 * mu * np.pi ** (2 / 3)
        below.append(float(np.min((work / jkr_work)[known])))
        all_below += int(np.sum((work < jkr_work)[known]))
    every, tabor = np.concatenate(share), np.concatenate(glassy)
    short, k = tabor > LEAST_TABOR, np.concatenate(ratio)
    ranges = list(zip(RATIOS, RATIOS[1:], strict=False))
    some = np.random.default_rng(1).permutation(len(every))[:_SHOWN]
    return {
        "unit": unit,
        "rows": len(every),
        "short_rows": int(np.sum(short)),
        "largest_short": float(np.max(every[short])),
        "largest_by_ratio": [
            float(np.max(every[short & (k >= low) & (k < high)])) for low, high in ranges
        ],
        "largest": float(np.max(every)),
        "largest_at_tabor": float(tabor[int(np.argmax(every))]),
        "glassy_tabor": tabor[some],
        "share": every[some],
        "least_over_eq_46": min(below),
        "rows_below_eq_46": all_below,
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the share of the bound by glassy Tabor number."""
    (ax,) = panels(figure, 1, 1)
    style = {"ls": "", "marker": "o", "ms": 3, "mfc": "none", "mew": 0.6, "color": COLOURS[0]}
    ax.plot(numbers["glassy_tabor"], numbers["share"], **style, label="simulated rows")
    ax.axhline(1, color="k", lw=1, label="bound of short range")
    decades(ax)
    ax.set_xlabel(r"glassy Tabor number $\mu k^{1/3}$")
    ax.set_ylabel(r"work / $1.157\,\mu\pi^{2/3}k^{-5/3}$")
    ax.legend()
