"""Unloading curves of a punch on a thin layer after six ways to load it.

Claims: the curves differ at the start and reach the same pull-off stress.

Seen: Six ways to press, six beginnings; counted from the depth without stress, one curve.

Needs: the protocols of Table 3.1.

Costs: six simulations, a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import SIZE as HALF_WIDTH
from .cases import curve, punch
from .style import COLOURS, panels
from .table_3_1 import RATE, THIN, start

SIZE = (9.0, 3.8)


def numbers(bench: Bench) -> Numbers:
    """Return depth [h0] and mean tension [sigma0] of each, and the depth without stress."""
    return {
        f"{i}": of for i, of in zip(range(1, 7), bench.each(unloaded, range(1, 7)), strict=True)
    }


def unloaded(number: int) -> dict[str, Any]:
    """Return the retraction after a protocol."""
    case = punch(THIN * HALF_WIDTH, RATE, **start(number))
    result = vt.solve(case, accuracy=2e-4, estimate_error=False)
    found = curve(result, 500)
    last = result.move is not None and result.move[-1]
    some = found["time"] >= float(result.time[np.argmax(result.move == last)])
    depth, tension = found["depth"][some], -found["force"][some]
    sign = np.flatnonzero((tension[:-1] < 0) & (tension[1:] >= 0))
    i = int(sign[0]) if sign.size else 0
    at = depth[i] - tension[i] * (depth[i + 1] - depth[i]) / (tension[i + 1] - tension[i])
    return {"depth": depth, "stress": tension, "depth_without_stress": float(at)}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the curves, and again from where the stress is nil."""
    left, right = panels(figure, 1, 2, sharey=True)
    words = ("pressed fast", "relaxed", "pressed at 5 $h_0/\\tau$")
    for i, of in enumerate(numbers.values()):
        style = {"color": COLOURS[i % 3], "ls": "-" if i < 3 else "--"}
        label = f"{i + 1}: {words[i % 3]} to {1 + i // 3} $h_0$"
        left.plot(of["depth"], of["stress"], **style, label=label)
        right.plot(of["depth"] - of["depth_without_stress"], of["stress"], **style)
    left.set_xlabel(r"depth / $h_0$")
    right.set_xlabel(r"depth from the one without stress / $h_0$")
    left.set_ylabel(r"mean tension / $\sigma_0$")
    left.set(xlim=(-2.5, 2.1), ylim=(-1.5, 1.1))
    right.set_xlim(-2.5, 1.5)
    right.axhline(1, color="0.5", lw=0.8)
    left.legend(loc="lower left")
