"""Which ratio of stresses makes Persson-Brener meet the simulations, by modulus ratio.

Claims: alpha = pi/9 at every modulus ratio from 0.01 to 0.1.

Seen: The ratio of stresses that makes Persson-Brener fit falls from 0.39 to 0.31 with the modulus
ratio; pi/9 is a mean. The steady crack has its own, lower ones: part of pi/9 is the finite range.

Needs: nothing. mu = 3.24, exponent 0.8, large starts. Fitted are forces as they are, and forces
over f(mu), the elastic ones; and the energy of the steady crack, which is the limit of short range.

Costs: 56 simulations, a minute; steady cracks some seconds.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import minimize_scalar

import viscotack as vt
from viscotack.theory import SteadyCrack, persson_brener

from ..bench import Bench, Numbers
from .cases import ALPHA, ALPHA_LJ, TABOR, elastic_ratio, solid
from .figure_4_6 import simulated
from .style import COLOURS, panels

SIZE = (6.6, 4.4)
RATIOS = (1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3)
_EXPONENT = 0.8
_RATES = 10 ** np.linspace(-0.5, 5, 9)


def fitted(speed: Any, energy: Any, material: Any) -> tuple[float, float]:
    """Return alpha and the root mean square of what is left, of speeds with alpha = pi/9."""

    def miss(log_alpha: float) -> float:
        v = speed * (np.exp(log_alpha) / ALPHA) ** 2
        theory = np.asarray(persson_brener.amplification(v, material=material))
        return float(np.mean(np.log(energy / theory) ** 2))

    found = minimize_scalar(miss, bounds=(np.log(0.1), np.log(1.0)), method="bounded")
    return float(np.exp(found.x)), float(np.sqrt(found.fun))


def numbers(bench: Bench) -> Numbers:
    """Return alpha and what it leaves, by modulus ratio and by what is fitted."""
    found: Numbers = {"modulus_ratio": np.array(RATIOS)}
    rows: dict[str, list[tuple[float, float]]] = {"as it is": [], "over f": [], "steady": []}
    v = np.geomspace(1e-2, 1e5, 36)
    for k in RATIOS:
        material = solid(k, _EXPONENT)
        of = simulated(bench.each, k, _EXPONENT, _RATES)
        good = np.isfinite(of["energy"]) & np.isfinite(of["speed"]) & (of["speed"] > 0)
        speed, energy = of["speed"][good], of["energy"][good]
        rows["as it is"].append(fitted(speed, energy, material))
        rows["over f"].append(fitted(speed, energy / float(elastic_ratio(TABOR)), material))
        crack = SteadyCrack(material, vt.LennardJones(1.0, 1.0))
        zone = v * ALPHA_LJ**2 / (np.pi * ALPHA**2)
        rows["steady"].append(fitted(v, np.asarray(crack.amplification(zone)), material))
    for name, some in rows.items():
        found[name] = {"alpha": np.array(some)[:, 0], "left": np.array(some)[:, 1]}
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw alpha by modulus ratio, with what is left as a bar."""
    (ax,) = panels(figure, 1, 1)
    words = {"as it is": "simulated force", "over f": r"over $f(\mu)$", "steady": "steady crack"}
    for i, (name, word) in enumerate(words.items()):
        style = {"color": COLOURS[i], "marker": "os^"[i], "mfc": "none", "lw": 0.8, "capsize": 3}
        of = numbers[name]
        ax.errorbar(
            numbers["modulus_ratio"], of["alpha"], of["alpha"] * of["left"], **style, label=word
        )
    ax.axhline(ALPHA, color="k", ls="--", lw=1, label=r"thesis, $\pi/9$")
    ax.set_xscale("log")
    ax.set_xlabel("modulus ratio $k$")
    ax.set_ylabel(r"$\alpha = \sigma_c/\sigma_0$; bars: what the fit leaves")
    ax.legend()
