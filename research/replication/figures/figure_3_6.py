"""Pull-off stress by thickness at four rates, between the two elastic limits.

Claims: strength below b0; b^-1/2 between b0 and b1; constant beyond b1; all between the slow and
the fast elastic layer.

Seen: Four rates between the two elastic layers (dotted, simulated): none leaves them. The slope
-1/2 is seen at the lowest rate; at 100 the strength lasts to ten times the thickness. Elastic
theory lies above the elastic simulations by the length that the crack has run.

Needs: nothing. The thicknesses of the thesis are not printed; here 30 from 0.001 to 10 half widths.

Costs: 180 simulations, a minute of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import Work, glassy_punch, punch, solid, table
from .figure_3_3 import PAD
from .style import COLOURS, MARKERS, SIMULATED, decades, panels

RATES = (0.1, 1.0, 10.0, 100.0)


def numbers(bench: Bench) -> Numbers:
    """Return stresses [sigma0] by thickness [a0] and rate, of elastic layers, and of LEFM."""
    b = HALF_WIDTH * np.geomspace(1e-3, 10, 30)
    found = table(bench.each, [Work(punch(float(x), r)) for x in b for r in RATES], (30, 4))
    slow = table(bench.each, [Work(punch(float(x), 1.0, material=solid(1.0))) for x in b])
    fast = table(bench.each, [Work(glassy_punch(float(x))) for x in b])
    exact = np.asarray(PAD.elastic_stress(b))
    return {
        "thickness": b,
        "rate": np.array(RATES),
        "stress": found["force"],
        "error": found["force_error"],
        "ligament": found["ligament"],
        "slow": slow["force"],
        "slow_ligament": slow["ligament"],
        "fast": fast["force"],
        "exact_slow": exact,
        "exact_fast": exact / np.sqrt(0.1),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw simulations as markers, exact elastic theory as lines, elastic simulations dotted."""
    (ax,) = panels(figure, 1, 1)
    b = numbers["thickness"]
    for name, style in (("slow", "--"), ("fast", "-")):
        exact = np.minimum(numbers[f"exact_{name}"], 1)
        ax.plot(b, exact, "k" + style, lw=1, label=f"elastic theory, {name}")
        ax.plot(b, numbers[name], "k:", lw=1)
    for i, rate in enumerate(numbers["rate"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(b, numbers["stress"][:, i], **style, label=rf"rate {rate:g} $h_0/\tau$")
    ax.plot([], [], "k:", lw=1, label="elastic, simulated")
    decades(ax)
    ax.set_yticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
    ax.minorticks_off()
    ax.set_xlabel("layer thickness $b/a_0$")
    ax.set_ylabel(r"pull-off stress / $\sigma_0$")
    ax.legend()
