"""Pull-off forces by rate and depth: models, theory and simulation."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ..bench import Bench, Numbers
from .cases import TABOR, K, Work, sphere, table
from .learned import FORCE_ML, FORCE_PAML, analytic, predicted
from .style import COLOURS, DEPTH, FORCE, MODEL, RATE, SIMULATED, colour, decades, panels, words

EXPONENTS = (0.2, 0.6, 1.6)
_DEPTH = 73.0
# Modulus ratios over which Sec. 5.4.1 compares model and descriptor.
TREND = (0.5, 0.2, 0.1, 0.05, 0.02)
RATES = np.geomspace(0.1, 1e9, 33)
POINTS = np.geomspace(0.1, 1e9, 8)


def curves(
    each: Any, *, tabor: float, depth: float, exponents: tuple[float, ...] = EXPONENTS
) -> Numbers:
    """Return force by rate, by both models, the descriptor and simulation, of some exponents."""
    found: Numbers = {"rate": RATES, "simulated_rate": POINTS}
    for n in exponents:
        case = {"tabor": tabor, "modulus_ratio": K, "exponent": n, "preload": depth}
        works = [Work(sphere(float(r), depth, tabor=tabor, exponent=n)) for r in POINTS]
        simulated = table(each, works)
        found[f"{n:g}"] = {
            "ml": predicted(FORCE_ML, rate=RATES, **case),
            "paml": predicted(FORCE_PAML, rate=RATES, **case),
            "paml_at_points": predicted(FORCE_PAML, rate=POINTS, **case),
            "ml_at_points": predicted(FORCE_ML, rate=POINTS, **case),
            "theory": analytic(rate=RATES, **case),
            "theory_at_points": analytic(rate=POINTS, **case),
            "simulated": simulated["force"],
            "error": simulated["force_error"],
        }
    return found


def distance(numbers: Numbers, name: str, what: str) -> float:
    """Return the root mean square of the logarithm of a prediction over simulation, relative."""
    of = numbers[name]
    return float(np.exp(np.sqrt(np.mean(np.log(of[what] / of["simulated"]) ** 2))) - 1)


def numbers_5_5(bench: Bench) -> Numbers:
    """Return the curves at a start of 73 h0, and those of other modulus ratios."""
    return curves(bench.each, tabor=TABOR, depth=_DEPTH) | {"trend": trend()}


def trend() -> list[Numbers]:
    """Return force by rate of the model with the descriptor and of the descriptor, by ratio."""
    case = {"rate": RATES, "tabor": TABOR, "exponent": 0.6, "preload": _DEPTH}
    return [
        {
            "paml": predicted(FORCE_PAML, modulus_ratio=k, **case),
            "theory": analytic(modulus_ratio=k, **case),
        }
        for k in TREND
    ]


def draw_5_5(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 1, 2, sharey=True)
    for ax, name, title in zip(
        axes, ("ml", "paml"), ("XGBoost", "forest, descriptor"), strict=True
    ):
        drawn(ax, numbers, name)
        ax.set(title=title, xlabel=RATE)
    axes[0].set_ylabel(FORCE)
    legend(axes[1])


def drawn(ax: Any, numbers: Numbers, name: str) -> None:
    """Draw a model as dots, the descriptor dashed, simulations as open markers."""
    for n in EXPONENTS:
        of, hue = numbers[f"{n:g}"], colour(n)
        ax.plot(numbers["rate"], of["theory"], "--", color=hue, lw=1)
        ax.plot(numbers["rate"], of[name], **MODEL, color=hue, label=words(n))
        ax.plot(numbers["simulated_rate"], of["simulated"], **SIMULATED, marker="^", color=hue)
    decades(ax)
    ax.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    ax.minorticks_off()
    ax.set_ylim(0.9, 15)


def legend(ax: Any) -> None:
    """Add what stands for what."""
    ax.plot([], [], "--", color="0.3", lw=1, label="descriptor (XPB)")
    ax.plot([], [], **MODEL, color="0.3", label="model")
    ax.plot([], [], **SIMULATED, marker="^", color="0.3", label="simulated")
    ax.legend(loc="lower right")


# Tabor number and depth, by figure.
CASES = {
    "5.6": ((3.0, 60.0), (3.0, 30.0), (3.0, 15.0), (3.0, 7.5)),
    "5.7": ((2.56, 75.0), (0.16, 75.0), (0.16, 15.0), (0.16, 7.5)),
}


def numbers_5_6(bench: Bench, name: str) -> Numbers:
    """Return the curves of each Tabor number and depth."""
    return {f"{mu:g}, {d:g}": curves(bench.each, tabor=mu, depth=d) for mu, d in CASES[name]}


def draw_5_6(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 2, 2, sharex=True, sharey=True)
    for ax, (name, of) in zip(axes, numbers.items(), strict=True):
        drawn(ax, of, "paml")
        mu, depth = name.split(", ")
        ax.set_title(rf"$\mu$ = {mu}, start at {depth} $h_0$")
    legend(axes[0])
    for ax in axes[2:]:
        ax.set_xlabel(RATE)
    for ax in axes[::2]:
        ax.set_ylabel(FORCE)


TABORS = (0.05, 0.2, 0.8, 3.2)
RATES_BY_DEPTH = (1e8, 1e3, 1e1)
DEPTHS = np.geomspace(0.3, 150, 13)
_FINE = np.geomspace(0.3, 150, 41)
_EXPONENT = 0.6


def numbers_5_8(bench: Bench) -> Numbers:
    """Return forces by rate, Tabor number and depth, simulated and by PA-ML; the descriptor."""
    works = [
        Work(sphere(r, float(d), tabor=mu, exponent=_EXPONENT))
        for r in RATES_BY_DEPTH
        for mu in TABORS
        for d in DEPTHS
    ]
    found = table(bench.each, works, (len(RATES_BY_DEPTH), len(TABORS), len(DEPTHS)))
    solid = {"modulus_ratio": K, "exponent": _EXPONENT}
    learned = [
        [predicted(FORCE_PAML, rate=r, tabor=mu, preload=_FINE, **solid) for mu in TABORS]
        for r in RATES_BY_DEPTH
    ]
    theory = [float(analytic(rate=r, tabor=3.2, preload=1.0, **solid)[0]) for r in RATES_BY_DEPTH]
    return {
        "rate": np.array(RATES_BY_DEPTH),
        "tabor": np.array(TABORS),
        "depth": DEPTHS,
        "simulated": found["force"],
        "error": found["force_error"],
        "fine_depth": _FINE,
        "paml": np.array(learned),
        "theory": np.array(theory),
    }


def draw_5_8(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 1, 3)
    for i, ax in enumerate(axes):
        for j, mu in enumerate(numbers["tabor"]):
            style = SIMULATED | {"color": COLOURS[j], "marker": "os^D"[j]}
            ax.plot(numbers["depth"], numbers["simulated"][i, j], **style, label=rf"$\mu$ = {mu:g}")
            ax.plot(numbers["fine_depth"], numbers["paml"][i, j], **MODEL, color=COLOURS[j])
        ax.axhline(numbers["theory"][i], color="0.4", ls="--", lw=1, label="descriptor")
        if i == 0:
            for level, words in ((1 / K, "$1/k$"), (4 / (3 * K), "$4/3k$")):
                ax.axhline(level, color="k", ls="-.", lw=0.8)
                ax.text(0.3, level + 0.15, words)
        ax.set(xscale="log", ylim=(0, None))
        ax.set(title=rf"rate $10^{{{np.log10(numbers['rate'][i]):.0f}}}$", xlabel=DEPTH)
    axes[0].set_ylabel(FORCE)
    axes[1].plot([], [], **MODEL, color="0.4", label="PA-ML")
    axes[1].legend()
