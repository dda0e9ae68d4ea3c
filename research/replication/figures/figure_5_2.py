"""Force by depth while a sphere is pulled off: rate, spectrum and depth of the start.

Claims: force and work grow with the rate and, at this rate, with the exponent; beyond a depth the
pull-off force no longer grows.

Seen: Force by depth. The area above the curves is the work; the three starts of (d) end in one
curve.

Needs: nothing. mu = 3.24, k = 0.1.

Costs: 13 simulations, two seconds.
"""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import curve, sphere
from .style import COLOURS, DEPTH, PULL, panels

SIZE = (9.0, 7.0)
# Rate, exponent and depth of the start, by panel.
PANELS = {
    "rate": [(10.0**p, 0.8, 73.0) for p in (2, 2.5, 3, 6)],
    "exponent": [(10**2.5, n, 73.0) for n in (0.6, 0.8, 1.6)],
    "start": [(10**2.5, 0.8, d) for d in (10.0, 40.0, 73.0)],
    "saturation": [(10**0.5, 0.8, d) for d in (16.7, 27.6, 40.7)],
}
_WORDS = {
    "rate": (0, r"$r\tau_0/h_0$ = {:.3g}"),
    "exponent": (1, r"$n$ = {:g}"),
    "start": (2, "start at {:g} $h_0$"),
    "saturation": (2, "start at {:g} $h_0$, rate $10^{{0.5}}$"),
}


def numbers(bench: Bench) -> Numbers:
    """Return depth, force, pull-off force and work of each panel."""
    return {
        name: {
            "case": [list(case) for case in some],
            "curves": list(bench.each(unloaded, some)),
        }
        for name, some in PANELS.items()
    }


def unloaded(case: tuple[float, float, float]) -> dict[str, Any]:
    """Return a retraction until the surfaces are apart."""
    rate, exponent, depth = case
    result = vt.solve(sphere(rate, depth, exponent=exponent), throw=False)
    of, error = curve(result), result.error_estimate or {}
    return {
        "depth": of["depth"],
        "force": of["force"],
        "pull_off_force": vt.pull_off_force(result),
        "force_error": error["force"],
        "work": vt.work_to_pull_off(result),
        "work_error": error["work"],
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the four panels."""
    for ax, (name, of) in zip(panels(figure, 2, 2), numbers.items(), strict=True):
        which, words = _WORDS[name]
        for i, (case, one) in enumerate(zip(of["case"], of["curves"], strict=True)):
            ax.plot(one["depth"], one["force"], color=COLOURS[i], label=words.format(case[which]))
        ax.axhline(0, color="0.5", lw=0.8)
        ax.set_ylim(*((-3, 5) if name == "saturation" else (-11, 15)))
        ax.set_xlabel(DEPTH)
        ax.set_ylabel(PULL)
        ax.legend()
