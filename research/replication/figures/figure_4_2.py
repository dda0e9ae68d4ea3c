"""Relaxation and creep of power-law solids beside a standard one.

Claims: n = 1.6 is near to a standard linear solid, and small n is broad.

Seen: Broad spectra creep over many decades; n = 1.6 is nearly the standard solid. The dotted
relaxation is that of the solids on the right: with the same n and tau0 the thesis's R(t) is of
another material.

Needs: the thesis draws R(t) by Eq. 4.4, a relaxation spectrum, and C(t) by Eq. 4.9, a retardation
spectrum: with the same n and tau0 these are two materials, and here both are drawn.

Costs: milliseconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import K, solid
from .style import colour, panels, words

SIZE = (9.0, 3.8)
_EXPONENTS = (0.2, 0.4, 1.6)


def numbers(bench: Bench) -> Numbers:
    """Return E/E0 and C E0 by time [tau0]; the relaxation of both materials with the same n."""
    t = np.geomspace(1e-6, 1e3, 145)
    standard = solid()
    found: Numbers = {
        "time": t,
        "relaxation": {"0": standard.relaxation(t)},
        "creep": {"0": standard.creep(t)},
        "relaxation_of_the_creep": {},
    }
    for n in _EXPONENTS:
        by_retardation = solid(K, n)
        by_relaxation = vt.RelaxationPowerLaw(
            rubbery_modulus=1.0, glassy_modulus=1 / K, exponent=n, tau0=1.0, poisson_ratio=0.0
        )
        found["creep"][f"{n:g}"] = by_retardation.creep(t)
        found["relaxation"][f"{n:g}"] = by_relaxation.relaxation(t)
        found["relaxation_of_the_creep"][f"{n:g}"] = by_retardation.relaxation(t)
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both functions, the standard solid dashed."""
    left, right = panels(figure, 1, 2)
    for ax, name in ((left, "relaxation"), (right, "creep")):
        for n, of in numbers[name].items():
            style = "-" if float(n) else "--"
            ax.plot(numbers["time"], of, style, color=colour(float(n)), label=words(float(n)))
        ax.set_xscale("log")
        ax.set_xlabel(r"time / $\tau_0$")
    for n, of in numbers["relaxation_of_the_creep"].items():
        left.plot(numbers["time"], of, ":", color=colour(float(n)))
    left.plot([], [], "k:", label="relaxation of the solids in (b)")
    right.set_ylabel("creep $C E_0$")
    left.set_ylabel("relaxation $R/E_0$")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
