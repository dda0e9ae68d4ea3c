"""Retractions from six points that a network predicts, beside simulation.

Claims: one network meets retractions of very different duration, from rate, depth and material.

Seen: Six points of nine retractions that last from 4e-5 to 0.5 tau0. The network has the shapes and
misses some points by a tenth of the largest force.

Needs: the key points of the shipped set. The authors' logarithm sgn(y) ln|y| cannot be undone;
sgn(y) ln(1 + |y|) stands in its place. The nine cases are no rows of the set.

Costs: nine simulations and a network of 8,505 rows, a minute.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from ..learning.trajectories import SHARES, points_of, predictor
from .cases import CHAPTER_4, TABOR, K, curve, sphere
from .figure_2_1 import UNIT
from .learned import SEED, asked, rows
from .style import COLOURS, DEPTH, PULL, panels

SIZE = (9.0, 9.5)
_HEIGHT = TABOR * np.pi ** (2 / 3)
# Rate, exponent and depth of the start over mu pi^(2/3) h0.
LEFT = [(1e5, 1.6, d) for d in (2.5, 4.0, 6.0, 8.0, 10.5, 13.0)]
RIGHT = [(1e2, n, 10.5) for n in (0.6, 0.8, 1.6)]


def numbers(bench: Bench) -> Numbers:
    """Return time, depth and force of each retraction, its six points by the network, and JKR."""
    cases = LEFT + RIGHT
    rate, exponent, depth = np.array(cases).T
    inputs = asked(
        tabor=TABOR, modulus_ratio=K, exponent=exponent, preload=depth * _HEIGHT, rate=rate
    )
    network = predictor(rows(), SEED)
    a = np.linspace(0.05, 4, 120)
    return {
        "jkr": {
            "depth": _HEIGHT * np.asarray(jkr.depth(a, **UNIT)),
            "force": np.asarray(jkr.force(a, **UNIT)) / CHAPTER_4,
        },
        "case": [list(case) for case in cases],
        "curves": list(bench.each(unloaded, cases)),
        "points": points_of(network, inputs),
    }


def unloaded(case: tuple[float, float, float]) -> dict[str, Any]:
    """Return a retraction up to just past the pull-off, and its own six points."""
    rate, exponent, height = case
    start = height * _HEIGHT
    result = vt.solve(
        sphere(rate, start, exponent=exponent),
        until="pull-off",
        whole=True,
        estimate_error=False,
    )
    of = curve(result, 120)
    travel = start - vt.depth_at_pull_off(result)
    at = np.interp(start - travel * np.array(SHARES[1:-1]), result.depth[::-1], result.force[::-1])
    return {
        "time": of["time"],
        "depth": of["depth"],
        "force": of["force"],
        "points": np.concatenate([[travel], at, [-vt.pull_off_force(result)]]),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw force by depth, force by time and depth by time, of both series."""
    axes = panels(figure, 3, 2)
    for ax in axes[:2]:
        ax.plot(numbers["jkr"]["depth"], numbers["jkr"]["force"], "k-", lw=1, label="JKR")
    for i, (case, of) in enumerate(zip(numbers["case"], numbers["curves"], strict=True)):
        rate, exponent, height = case
        side, hue = int(i >= len(LEFT)), COLOURS[i % len(LEFT)]
        travel, forces = numbers["points"][i][0], numbers["points"][i][1:]
        depth = height * _HEIGHT - travel * np.array(SHARES[1:])
        time = travel * np.array(SHARES[1:]) / rate
        label = f"$n$ = {exponent:g}" if side else rf"{height:g} $\mu\pi^{{2/3}}$"
        for ax, x, y, dots in (
            (axes[side], of["depth"], of["force"], (depth, forces)),
            (axes[2 + side], of["time"], of["force"], (time, forces)),
            (axes[4 + side], of["time"], of["depth"], (time, depth)),
        ):
            ax.plot(x, y, color=hue, label=label)
            ax.plot(*dots, "o", color=hue, ms=4)
    for side, title in enumerate(
        (r"rate $10^5$, $n$ = 1.6", r"rate $10^2$, start at 10.5 $\mu\pi^{2/3}$")
    ):
        axes[side].set_title(title)
        axes[side].set_xlabel(DEPTH)
        axes[side].set_ylim(-11.5, 60)
        axes[2 + side].set_ylim(-11.5, 40)
        axes[side].legend(title="dots: network", ncols=2)
        for row in (1, 2):
            axes[2 * row + side].set_xlabel(r"time / $\tau_0$")
            axes[2 * row + side].ticklabel_format(axis="x", scilimits=(-2, 3))
    for row, words in enumerate((PULL, PULL, DEPTH)):
        axes[2 * row].set_ylabel(words)
