"""Table 3.1: six ways to load the punch before it is pulled at the same rate.

Claims: these are the loading protocols of Fig. 3.4 and 3.5; the pull-off stress hardly knows them.

Seen: The six protocols. At b = 0.005 a all reach the strength; at 0.15 a, where they differ most,
the stresses lie 1.4 % apart.

Needs: nothing; the stresses of two thicknesses are those of Fig. 3.5.

Costs: nothing.
"""

from __future__ import annotations

from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from . import cases
from .style import drawn_table

SIZE = (7.0, 2.6)
# Loading so fast that nothing relaxes [h0/tau].
VERY_FAST = 1e7
RATE = 10.0
# Depth at rest, depth of loading, rate of loading; None where the solid is relaxed there.
PROTOCOLS = (
    (0.0, 1.0, VERY_FAST),
    (1.0, 1.0, None),
    (0.0, 1.0, 5.0),
    (0.0, 2.0, VERY_FAST),
    (2.0, 2.0, None),
    (0.0, 2.0, 5.0),
)
# Thickness over half width: of Fig. 3.4, and where protocols differ most.
THIN, WORST = 0.005, 0.15


def start(number: int) -> dict[str, object]:
    """Return start and moves of a protocol, 1 to 6."""
    rest, load, rate = PROTOCOLS[number - 1]
    moves = () if rate is None else (vt.Approach(speed=rate, to=vt.AtDepth(load)),)
    return {"start": vt.AtDepth(rest), "moves": moves}


def numbers(bench: Bench) -> Numbers:
    """Return the protocols, and the pull-off stress of each of two thicknesses, as a table."""
    found = bench.of("3.5")
    thin, worst = (int(abs(found["thickness"] - b * cases.SIZE).argmin()) for b in (THIN, WORST))
    return {
        "columns": [
            "protocol",
            "rest",
            "load",
            "loading rate",
            "rate",
            "b = 0.005 a",
            "b = 0.15 a",
        ],
        "rows": [
            [
                f"{i + 1}",
                f"{rest:g} h0",
                f"{load:g} h0",
                "very slow" if rate is None else "very fast" if rate == VERY_FAST else f"{rate:g}",
                f"{RATE:g}",
                f"{found['stress'][thin][i]:.4f} s0",
                f"{found['stress'][worst][i]:.4f} s0",
            ]
            for i, (rest, load, rate) in enumerate(PROTOCOLS)
        ],
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the table."""
    drawn_table(numbers["columns"], numbers["rows"], figure)
