"""Whole retractions, simulated and from a network."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from ..learning.learners import network
from ..learning.trajectories import SHARES, learned_points, points_of, predictor
from ..learning.validation import folds, random_split
from .cases import CHAPTER_4, TABOR, K, curve, sphere
from .elastic import UNIT
from .learned import SEED, asked, rows
from .style import COLOURS, DEPTH, PULL, panels

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


def numbers_5_2(bench: Bench) -> Numbers:
    """Return depth, force, pull-off force and work of each panel."""
    return {
        name: {"case": [list(case) for case in some], "curves": list(bench.each(unloaded, some))}
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


def draw_5_2(numbers: Numbers, figure: Figure) -> None:
    for ax, (name, of) in zip(panels(figure, 2, 2), numbers.items(), strict=True):
        which, words = _WORDS[name]
        for i, (case, one) in enumerate(zip(of["case"], of["curves"], strict=True)):
            ax.plot(one["depth"], one["force"], color=COLOURS[i], label=words.format(case[which]))
        ax.axhline(0, color="0.5", lw=0.8)
        ax.set_ylim(*((-3, 5) if name == "saturation" else (-11, 15)))
        ax.set(xlabel=DEPTH, ylabel=PULL)
        ax.legend()


LAYERS = ((50,), (100,), (50, 50), (100, 100), (50, 50, 50), (100, 100, 100))
ACTIVATIONS = ("relu", "tanh", "logistic")
_ROWS, _FOLDS = 2000, 3


def numbers_5_12(bench: Bench) -> Numbers:
    """Return mean and spread of the error over three folds, of standardised targets."""
    cells = [(layers, activation) for layers in LAYERS for activation in ACTIVATIONS]
    errors = np.array(list(bench.each(error, cells)))
    shape = (len(LAYERS), len(ACTIVATIONS))
    return {
        "layers": ["-".join(map(str, layers)) for layers in LAYERS],
        "activation": list(ACTIVATIONS),
        "mse": errors.mean(axis=1).reshape(shape),
        "spread": errors.std(axis=1).reshape(shape),
    }


def error(cell: tuple[tuple[int, ...], str]) -> list[float]:
    """Return the error on each of three folds."""
    some = rows().chosen(np.random.default_rng(SEED).permutation(len(rows()))[:_ROWS])
    X, Y = learned_points(some)
    Y = (Y - Y.mean(axis=0)) / Y.std(axis=0)
    found: list[float] = []
    for train, held in folds(random_split(len(X), SEED, _FOLDS)):
        model = network(X[train], Y[train], *cell, SEED, rounds=100, patience=10)
        found.append(float(np.mean((model.predict(X[held]) - Y[held]) ** 2)))
    return found


def draw_5_12(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    x = np.arange(len(numbers["layers"]))
    for i, activation in enumerate(numbers["activation"]):
        mse, spread = numbers["mse"][:, i], numbers["spread"][:, i]
        style = {"color": COLOURS[i], "marker": "os^"[i], "capsize": 3, "lw": 1}
        ax.errorbar(x + 0.08 * (i - 1), mse, spread, **style, label=activation)
    ax.set_xticks(x, numbers["layers"])
    ax.set(yscale="log", xlabel="neurons by layer", ylabel="mean square error, standardised")
    ax.legend(title="activation")


_HEIGHT = TABOR * np.pi ** (2 / 3)
# Rate, exponent and depth of the start over mu pi^(2/3) h0.
LEFT = [(1e5, 1.6, d) for d in (2.5, 4.0, 6.0, 8.0, 10.5, 13.0)]
RIGHT = [(1e2, n, 10.5) for n in (0.6, 0.8, 1.6)]


def numbers_5_13(bench: Bench) -> Numbers:
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
        "curves": list(bench.each(with_points, cases)),
        "points": points_of(network, inputs),
    }


def with_points(case: tuple[float, float, float]) -> dict[str, Any]:
    """Return a retraction up to just past the pull-off, and its own six points."""
    rate, exponent, height = case
    start = height * _HEIGHT
    result = vt.solve(
        sphere(rate, start, exponent=exponent), until="pull-off", whole=True, estimate_error=False
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


def draw_5_13(numbers: Numbers, figure: Figure) -> None:
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
        axes[side].set(title=title, xlabel=DEPTH, ylim=(-11.5, 60))
        axes[2 + side].set_ylim(-11.5, 40)
        axes[side].legend(title="dots: network", ncols=2)
        for row in (1, 2):
            axes[2 * row + side].set_xlabel(r"time / $\tau_0$")
            axes[2 * row + side].ticklabel_format(axis="x", scilimits=(-2, 3))
    for row, words in enumerate((PULL, PULL, DEPTH)):
        axes[2 * row].set_ylabel(words)
