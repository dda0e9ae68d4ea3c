"""What the thesis's linear curve of Figure 4.10 is: Tabor numbers, units of the rate, tips.

Claims: linear theory with h0 = 30.8 nm, the range of the thesis's rate series, gives its linear
curve, 4.26 to 10.9 mN.

Seen: The six explanations that are nearest to the linear curve of Fig. 4.10. A range of 200 nm,
which the thesis does not have, is nearest; 30.8 nm as the unit of the rate alone, at the Tabor
number of the quasi-static test, comes next.

Needs: the curve is a quotient of two printed fits, Eq. 4.28 over 1 + (v/v1)^(1/2), at the crack
speed of Eq. 4.24; its own error is not known.

Costs: 45 simulations, three minutes of processor time.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import ALPHA, ALPHA_LJ, LENS, PDMS, PDMS_WORK, PRELOAD, RANGES, TABOR, lens
from .figure_4_10 import SHORT, SPEEDS, TIP, linear_theory, of_the_thesis
from .style import COLOURS, decades

# The Tabor number that the quasi-static test gave.
MEASURED_TABOR = 2.05
# Tabor number and unit of the rate [m] of each run; None where the range is also the unit.
RUNS: dict[str, tuple[float, float]] = {
    "Tabor 2.05, unit 30.8 nm": (MEASURED_TABOR, SHORT),
    "Tabor 2.05, unit 200 nm": (MEASURED_TABOR, RANGES["200 nm"]),
    "Tabor 3.24, unit 30.8 nm": (TABOR, SHORT),
    "Tabor 3.24, unit 200 nm": (TABOR, RANGES["200 nm"]),
    "Tabor 15.8, unit 30.8 nm": (lens(1e-6, RANGES["200 nm"]).tabor, SHORT),
}
# Critical over peak stress that theory is tried with: the thesis's two, and half and twice its own.
TIPS = {
    "alpha = pi/9": ALPHA,
    "alpha = 9 sqrt(3)/16": ALPHA_LJ,
    "alpha = pi/18": ALPHA / 2,
    "alpha = 2 pi/9": 2 * ALPHA,
}


def simulated(case: tuple[float, float, float]) -> float:
    """Return the force [mN] at a speed [m/s], a Tabor number and a unit of the rate [m]."""
    speed, tabor, unit = case
    force = float(jkr.pull_off_force(radius=LENS, work_of_adhesion=PDMS_WORK))
    groups = vt.Groups(
        tabor=tabor,
        material=PDMS.reduced(),
        start=vt.AtForce(PRELOAD / force),
        rate=speed * PDMS.tau0 / unit,
    )
    return 1e3 * force * vt.pull_off_force(vt.solve(groups, until="pull-off", accuracy=5e-3))


def numbers(bench: Bench) -> Numbers:
    """Return forces [mN] by speed [m/s] of each explanation, and how far they are off."""
    thesis = of_the_thesis()
    cases = [(float(v), *run) for run in RUNS.values() for v in SPEEDS]
    forces = np.array(list(bench.each(simulated, cases))).reshape(len(RUNS), len(SPEEDS))
    lens_at = bench.of("4.10")
    found = {f"range {name}": lens_at["force"][i] for i, name in enumerate(lens_at["range"])}
    found |= dict(zip(RUNS, forces, strict=True))
    for name, alpha in TIPS.items():
        energy = linear_theory(SPEEDS, TIP * (ALPHA / alpha) ** 2)["energy"]
        found[f"Eq. 4.21 and 4.24, {name}"] = thesis["jkr"] * energy
    off = np.array([force / thesis["linear"] - 1 for force in found.values()])
    return {
        "speed": SPEEDS,
        "linear": thesis["linear"],
        "explanation": list(found),
        "force": np.array(list(found.values())),
        "least": off.min(axis=1),
        "most": off.max(axis=1),
        "rms": np.sqrt(np.mean(off**2, axis=1)),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw each explanation over the thesis's curve."""
    ax = figure.subplots()
    v = 1e6 * numbers["speed"]
    best = np.argsort(numbers["rms"])[:6]
    for rank, i in enumerate(best):
        label = f"{numbers['explanation'][i]} ({100 * numbers['rms'][i]:.1f} % rms)"
        ax.plot(v, numbers["force"][i] / numbers["linear"], color=COLOURS[rank], label=label)
    ax.axhline(1.0, color="k", lw=0.8)
    decades(ax, y=False)
    ax.set_xlabel("retraction speed [um/s]")
    ax.set_ylabel("force over the thesis's linear curve")
    ax.legend(fontsize=8)
