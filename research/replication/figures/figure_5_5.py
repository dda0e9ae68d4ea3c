"""Pull-off force by rate beyond the rows that were learned from: ML, PA-ML, theory, simulation.

Claims: where there are no rows (n = 0.2, start at 73 h0, mu = 3.24) the model with the descriptor
follows the analytic law, the one without leaves it.

Seen: For n = 0.2, where there are hardly rows, the model on the left steps and strays; with the
descriptor it goes along the dashed law, which is as near to the simulations as it.

Needs: the shipped set; it has rows of n = 0.2 at that Tabor number no more than the thesis's.

Costs: 24 simulations and two models, a quarter of a minute.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import TABOR, K, Work, sphere, table
from .learned import FORCE_ML, FORCE_PAML, analytic, predicted, rows
from .style import FORCE, MODEL, RATE, SIMULATED, colour, decades, panels, words

SIZE = (10.0, 4.2)
EXPONENTS = (0.2, 0.6, 1.6)
_DEPTH = 73.0
# Modulus ratios over which Sec. 5.4.1 compares model and descriptor.
TREND = (0.5, 0.2, 0.1, 0.05, 0.02)
RATES = np.geomspace(0.1, 1e9, 33)
POINTS = np.geomspace(0.1, 1e9, 8)


def curves(
    each: Any, *, tabor: float, depth: float, exponents: tuple[float, ...] = EXPONENTS
) -> Numbers:
    """Return force by rate, by both models, the descriptor and simulation, of some exponents."""
    found: Numbers = {"rate": RATES, "simulated_rate": POINTS}
    for n in exponents:
        case = {"tabor": tabor, "modulus_ratio": K, "exponent": n, "preload": depth}
        works = [Work(sphere(float(r), depth, tabor=tabor, exponent=n)) for r in POINTS]
        simulated = table(each, works)
        found[f"{n:g}"] = {
            "ml": predicted(FORCE_ML, rate=RATES, **case),
            "paml": predicted(FORCE_PAML, rate=RATES, **case),
            "paml_at_points": predicted(FORCE_PAML, rate=POINTS, **case),
            "ml_at_points": predicted(FORCE_ML, rate=POINTS, **case),
            "theory": analytic(rate=RATES, **case),
            "theory_at_points": analytic(rate=POINTS, **case),
            "simulated": simulated["force"],
            "error": simulated["force_error"],
        }
    return found


def distance(numbers: Numbers, name: str, what: str) -> float:
    """Return the root mean square of the logarithm of a prediction over simulation, relative."""
    of = numbers[name]
    return float(np.exp(np.sqrt(np.mean(np.log(of[what] / of["simulated"]) ** 2))) - 1)


def numbers(bench: Bench) -> Numbers:
    """Return the curves at a start of 73 h0, and how many rows are like each."""
    r = rows()
    near = (np.abs(np.log(r.tabor / TABOR)) < 0.02) & (r.preload > 50) & (r.modulus_ratio == K)
    like = [int(np.sum(near & (r.exponent == n))) for n in EXPONENTS]
    found = curves(bench.each, tabor=TABOR, depth=_DEPTH) | {"rows_like_it": like}
    return found | {"trend": trend()}


def trend() -> list[Numbers]:
    """Return force by rate of the model with the descriptor and of the descriptor, by ratio."""
    case = {"rate": RATES, "tabor": TABOR, "exponent": 0.6, "preload": _DEPTH}
    return [
        {
            "paml": predicted(FORCE_PAML, modulus_ratio=k, **case),
            "theory": analytic(modulus_ratio=k, **case),
        }
        for k in TREND
    ]


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the model without the descriptor on the left, with it on the right."""
    axes = panels(figure, 1, 2, sharey=True)
    for ax, name, title in zip(
        axes, ("ml", "paml"), ("XGBoost", "forest, descriptor"), strict=True
    ):
        drawn(ax, numbers, name)
        ax.set_title(title)
        ax.set_xlabel(RATE)
    axes[0].set_ylabel(FORCE)
    legend(axes[1])


def drawn(ax: Any, numbers: Numbers, name: str) -> None:
    """Draw a model as dots, the descriptor dashed, simulations as open markers."""
    for n in EXPONENTS:
        of, hue = numbers[f"{n:g}"], colour(n)
        ax.plot(numbers["rate"], of["theory"], "--", color=hue, lw=1)
        ax.plot(numbers["rate"], of[name], **MODEL, color=hue, label=words(n))
        ax.plot(numbers["simulated_rate"], of["simulated"], **SIMULATED, marker="^", color=hue)
    decades(ax)
    ax.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    ax.minorticks_off()
    ax.set_ylim(0.9, 15)


def legend(ax: Any) -> None:
    """Add what stands for what."""
    ax.plot([], [], "--", color="0.3", lw=1, label="descriptor (XPB)")
    ax.plot([], [], **MODEL, color="0.3", label="model")
    ax.plot([], [], **SIMULATED, marker="^", color="0.3", label="simulated")
    ax.legend(loc="lower right")
