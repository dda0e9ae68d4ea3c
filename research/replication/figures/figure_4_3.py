"""Force by contact radius while a sphere is pulled off: rate, spectrum and preload.

Claims: fast retraction, a narrow spectrum and, up to a point, a large start make a large pull-off
force.

Seen: Faster, narrower and from farther out, the curves dive deeper below JKR; from 3.61 the force
passes 15, which is 1.5/k.

Needs: nothing. k = 0.1, mu = 3.24; radii of the start are given.

Costs: nine simulations, two seconds.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, curve, sphere
from .figure_2_1 import UNIT
from .style import COLOURS, RADIUS, panels

SIZE = (10.5, 3.8)
# Rate, exponent and radius of the start, by panel.
PANELS = {
    "rate": [(10.0**p, 0.8, 3.61) for p in (2, 2.5, 3, 6)],
    "exponent": [(10**2.5, n, 3.61) for n in (0.6, 0.8, 1.6)],
    "start": [(10**2.5, 1.6, a) for a in (1.71, 2.47, 3.61)],
}


def numbers(bench: Bench) -> Numbers:
    """Return force [pi R dg0] by radius of each panel, and of JKR."""
    a = np.linspace(0.05, 4, 200)
    found: Numbers = {"jkr": {"radius": a, "force": jkr.force(a, **UNIT)}}
    for name, some in PANELS.items():
        found[name] = {
            "case": [list(case) for case in some],
            "curves": list(bench.each(unloaded, some)),
        }
    return found


def unloaded(case: tuple[float, float, float]) -> dict[str, Any]:
    """Return force and radius along a retraction."""
    rate, exponent, radius = case
    problem = sphere(rate, vt.AtRadius(radius), exponent=exponent)
    result = vt.solve(problem, throw=False)
    of = curve(result)
    known = np.isfinite(of["contact_radius"])
    return {
        "radius": of["contact_radius"][known],
        "force": CHAPTER_4 * of["force"][known],
        "pull_off_force": CHAPTER_4 * vt.pull_off_force(result),
        "error": (result.error_estimate or {})["force"],
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a panel each for rate, exponent and start."""
    words = (r"$r\tau_0/h_0$ = {:.3g}", r"$n$ = {:g}", r"$a_0$ = {:g}")
    for i, (ax, name) in enumerate(zip(panels(figure, 1, 3, sharey=True), PANELS, strict=True)):
        of = numbers["jkr"]
        ax.plot(of["radius"], of["force"], "k--", lw=1, label="JKR")
        some = zip(numbers[name]["case"], numbers[name]["curves"], strict=True)
        for j, (case, one) in enumerate(some):
            ax.plot(one["radius"], one["force"], color=COLOURS[j], label=words[i].format(case[i]))
        ax.set(xlim=(0, 4), ylim=(-16, 20))
        ax.set_xlabel(RADIUS, fontsize=9)
        ax.legend()
    figure.axes[0].set_ylabel(r"force $\hat P$ / $\pi R\,\Delta\gamma_0$")
