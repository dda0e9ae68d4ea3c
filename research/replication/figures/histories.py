"""How a contact was made before it is pulled: a punch, and a sphere beside it."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from . import cases
from .cases import SIZE as HALF_WIDTH
from .cases import STANDARD, Work, curve, punch, sphere, table
from .style import COLOURS, MARKERS, SIMULATED, decades, drawn_table, panels, words

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


def numbers_table_3_1(bench: Bench) -> Numbers:
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


def draw_table_3_1(numbers: Numbers, figure: Figure) -> None:
    drawn_table(numbers["columns"], numbers["rows"], figure)


def numbers_3_4(bench: Bench) -> Numbers:
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


def draw_3_4(numbers: Numbers, figure: Figure) -> None:
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


_OVER_WIDTH = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


def numbers_3_5(bench: Bench) -> Numbers:
    """Return stress [sigma0] and its relative error by thickness [a0] and protocol."""
    b = HALF_WIDTH * np.array(_OVER_WIDTH)
    works = [Work(punch(float(x), RATE, **start(i))) for x in b for i in range(1, 7)]
    found = table(bench.each, works, (len(b), 6))
    return {
        "thickness": b,
        "stress": found["force"],
        "error": found["force_error"],
        "change": found["force"] / found["force"][:, 1:2] - 1,
    }


def draw_3_5(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    for i in range(6):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        left.plot(numbers["thickness"], numbers["stress"][:, i], **style, label=f"protocol {i + 1}")
        right.plot(numbers["thickness"], 100 * numbers["change"][:, i], **(style | {"ls": ":"}))
    decades(left)
    decades(right, y=False)
    for ax in (left, right):
        ax.set_xlabel("layer thickness $b/a_0$")
    left.set_ylabel(r"pull-off stress / $\sigma_0$")
    left.set_yticks([0.2, 0.5, 1.0], ["0.2", "0.5", "1"])
    left.minorticks_off()
    right.set_ylabel("beside the relaxed start [%]")
    right.axhspan(-2, 2, color="0.92", zorder=0)
    left.legend()


_DEPTH, _GAP = 40.0, 6.0
SPEEDS = 10.0 ** np.arange(0, 6)
RATES = (10.0, 1000.0)
EXPONENTS = (STANDARD, 0.6)


def numbers_histories(bench: Bench) -> Numbers:
    """Return the pull-off force by solid, rate and speed of approach, over that of rest."""
    works = []
    for n in EXPONENTS:
        for r in RATES:
            works.append(Work(sphere(r, _DEPTH, exponent=n)))
            for v in SPEEDS:
                moves = (vt.Approach(speed=float(v), to=vt.AtDepth(_DEPTH)),)
                works.append(Work(sphere(r, vt.Apart(_GAP), exponent=n, moves=moves)))
    found = table(bench.each, works, (len(EXPONENTS), len(RATES), 1 + len(SPEEDS)))
    force = found["force"]
    return {
        "exponent": np.array(EXPONENTS),
        "rate": np.array(RATES),
        "approach": SPEEDS,
        "change": force[:, :, 1:] / force[:, :, :1] - 1,
        "error": found["force_error"][:, :, 1:],
    }


def draw_histories(numbers: Numbers, figure: Figure) -> None:
    for i, ax in enumerate(panels(figure, 1, 2, sharey=True)):
        for j, n in enumerate(numbers["exponent"]):
            style = SIMULATED | {"color": COLOURS[j], "marker": "os"[j], "ls": ":"}
            ax.plot(numbers["approach"], 100 * numbers["change"][j, i], **style, label=words(n))
        ax.axhspan(-2, 2, color="0.92", zorder=0)
        decades(ax, y=False)
        ax.set_title(f"pulled at {numbers['rate'][i]:g} $h_0/\\tau_0$")
        ax.set_xlabel(r"speed of approach / $h_0/\tau_0$")
    figure.axes[0].set_ylabel("force beside the relaxed start [%]")
    figure.axes[0].legend()
