"""Tension and gap along the interface of three layers, before, at and after the pull-off.

Claims: a very thin layer comes off all at once, at the strength; thicker ones by a crack that has
run before the pull-off, the farther the thicker the layer.

Seen: A layer of 0.001 a comes off as a whole. At 0.25 a a crack has come in by a tenth of the half
width before the largest stress, at 10 a by a fifth, with the tension piled up at its tip.

Needs: nothing.

Costs: three simulations, a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import punch
from .style import COLOURS, panels

SIZE = (9.0, 7.5)
RATE = 100.0
OVER_WIDTH = (0.001, 0.25, 10.0)
_STRENGTH = 16 / (9 * np.sqrt(3))
_POINTS = 120


def numbers(bench: Bench) -> Numbers:
    """Return place [a], tension [sigma0] and gap - 1 [h0] at three moments of three layers."""
    return {f"{b:g}": of for b, of in zip(OVER_WIDTH, bench.each(moments, OVER_WIDTH), strict=True)}


def moments(over_width: float) -> dict[str, Any]:
    """Return the fields half way to the pull-off, at it, and when half of the stress is gone."""
    result = vt.solve(
        punch(over_width * HALF_WIDTH, RATE), fields=True, estimate_error=False, throw=False
    )
    fields, force = result.fields, -result.force
    assert fields is not None
    top = int(np.argmax(force))
    before = int(np.argmax(force > 0.5 * force[top]))
    later = np.flatnonzero(force[top:] < 0.5 * force[top])
    after = top + int(later[0]) if later.size else len(force) - 1
    found: dict[str, Any] = {"ligament": vt.ligament_at_pull_off(result)}
    for name, step in (("before", before), ("at", top), ("after", after)):
        at = int(np.argmin(np.abs(fields["time"] - result.time[step])))
        # meshes of fewer nodes are filled up
        here = np.flatnonzero(np.isfinite(fields["radius"][at]))
        x = fields["radius"][at][here] / np.max(fields["radius"][at][here])
        some = np.unique(np.linspace(0, x.size - 1, _POINTS).astype(int))
        found[name] = {
            "place": x[some],
            "tension": -fields["pressure"][at][here][some] / _STRENGTH,
            "opening": fields["gap"][at][here][some] - 1,
            "mean": float(force[step]),
        }
    return found


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw a row for each layer: tension on the left, gap on the right."""
    axes = panels(figure, 3, 2, sharex=True)
    for row, (over_width, of) in enumerate(numbers.items()):
        left, right = axes[2 * row : 2 * row + 2]
        for i, (name, word) in enumerate(
            (("before", "half way"), ("at", "pull-off"), ("after", "after it"))
        ):
            some = of[name]
            style = {"color": COLOURS[(0, 1, 2)[i]], "lw": 2.2 if name == "at" else 1.2}
            left.plot(some["place"], some["tension"], **style, label=word)
            right.plot(some["place"], some["opening"], **style)
        left.set_ylabel(r"tension / $\sigma_0$")
        right.set_ylabel("gap / $h_0 - 1$")
        right.set_yscale("symlog", linthresh=0.1)
        left.set_title(f"$b$ = {float(over_width):g} $a$, ligament {of['ligament']:.2f} $a$")
    for ax in axes[-2:]:
        ax.set_xlabel("place $x/a$")
    axes[0].legend()
