"""The work to pull-off: models, simulation, and bounds."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from viscotack import datasets
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, TABOR, K, Work, sphere, table
from .elastic import UNIT
from .forces import TABORS
from .learned import WORK_ML, WORK_PAML, predicted
from .style import COLOURS, MODEL, RATE, SIMULATED, WORK, colour, decades, panels, words

EXPONENTS = (0.4, 0.6, 1.6)
_DEPTH = 73.0
RATES = np.geomspace(0.1, 1e9, 41)
POINTS = np.geomspace(0.1, 1e6, 15)


def numbers_5_9(bench: Bench) -> Numbers:
    """Return works by exponent and rate."""
    found: Numbers = {"rate": RATES, "simulated_rate": POINTS}
    for n in EXPONENTS:
        case = {"tabor": TABOR, "modulus_ratio": K, "exponent": n, "preload": _DEPTH}
        simulated = table(bench.each, [Work(sphere(float(r), _DEPTH, exponent=n)) for r in POINTS])
        found[f"{n:g}"] = {
            "ml": predicted(WORK_ML, rate=RATES, **case),
            "paml": predicted(WORK_PAML, rate=RATES, **case),
            "simulated": simulated["work"],
            "error": simulated["work_error"],
        }
    return found


def draw_5_9(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 1, 2, sharey=True)
    for ax, name, title in zip(axes, ("ml", "paml"), ("forest", "forest, descriptor"), strict=True):
        for n in EXPONENTS:
            of, hue = numbers[f"{n:g}"], colour(n)
            ax.plot(numbers["rate"], of[name], **MODEL, color=hue, label=words(n))
            ax.plot(numbers["simulated_rate"], of["simulated"], **SIMULATED, marker="^", color=hue)
        decades(ax)
        ax.set(title=title, xlabel=RATE)
    axes[0].set_ylabel(WORK)
    axes[0].plot([], [], **SIMULATED, marker="^", color="0.3", label="simulated")
    axes[0].legend()


FAR_EXPONENTS = (1.6, 0.6)
FEWER_POINTS = np.geomspace(0.1, 1e6, 11)


def numbers_5_10(bench: Bench) -> Numbers:
    """Return works by exponent, Tabor number and rate."""
    found: Numbers = {"rate": RATES, "simulated_rate": FEWER_POINTS, "tabor": np.array(TABORS)}
    for n in FAR_EXPONENTS:
        works = [
            Work(sphere(float(r), _DEPTH, tabor=mu, exponent=n))
            for mu in TABORS
            for r in FEWER_POINTS
        ]
        simulated = table(bench.each, works, (len(TABORS), len(FEWER_POINTS)))
        solid = {"modulus_ratio": K, "exponent": n, "preload": _DEPTH}
        found[f"{n:g}"] = {
            "paml": np.array(
                [predicted(WORK_PAML, rate=RATES, tabor=mu, **solid) for mu in TABORS]
            ),
            "simulated": simulated["work"],
            "error": simulated["work_error"],
        }
    return found


def draw_5_10(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 1, 2, sharey=True)
    for ax, n in zip(axes, FAR_EXPONENTS, strict=True):
        of = numbers[f"{n:g}"]
        for i, mu in enumerate(numbers["tabor"]):
            style = SIMULATED | {"color": COLOURS[i], "marker": "os^D"[i]}
            ax.plot(
                numbers["simulated_rate"], of["simulated"][i], **style, label=rf"$\mu$ = {mu:g}"
            )
            ax.plot(numbers["rate"], of["paml"][i], **MODEL, color=COLOURS[i])
        decades(ax)
        ax.set(title=f"$n$ = {n:g}", xlabel=RATE)
    axes[0].set_ylabel(WORK)
    axes[1].plot([], [], **MODEL, color="0.4", label="PA-ML")
    axes[1].legend(loc="lower right")


_RADII = (6.1377, 3.0689, 1.9564, 2.0139)
_RATE, _FAST = 1e5, 1e9


def jkr_work(tabor: Any) -> Any:
    """Return the work to pull-off of JKR [1.5 pi R dg0 h0], Eq. 46."""
    # in the units of Eq. 4.16 the depth is mu pi^(2/3) h0
    unit = float(jkr.work_to_pull_off(**UNIT)) / CHAPTER_4
    return unit * np.asarray(tabor) * np.pi ** (2 / 3)


def numbers_A_6(bench: Bench) -> Numbers:
    """Return the works by Tabor number: learned, simulated at two rates, and by two estimates."""
    mu = np.array(TABORS)
    works = [Work(sphere(r, _DEPTH, tabor=m, exponent=1.6)) for r in (_RATE, _FAST) for m in TABORS]
    found = table(bench.each, works, (2, len(TABORS)))
    case = {"modulus_ratio": K, "exponent": 1.6, "preload": _DEPTH, "rate": _RATE}
    return {
        "tabor": mu,
        "paml": predicted(WORK_PAML, tabor=mu, **case),
        "simulated": found["work"][0],
        "error": found["work_error"][0],
        "fast": found["work"][1],
        "estimate": 4 / 3 * np.array(_RADII) ** 2 * np.pi ** (2 / 3) * mu,
        "jkr_fast": jkr_work(mu) * K ** (-2 / 3),
    }


def draw_A_6(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    mu = numbers["tabor"]
    ax.plot(mu, numbers["estimate"], "s", color=COLOURS[1], label="Eq. 43, printed radii")
    ax.plot(mu, numbers["jkr_fast"], "k--", lw=1, label="JKR of the fast limit")
    ax.plot(mu, numbers["simulated"], **SIMULATED, marker="^", color=COLOURS[2], label="simulated")
    ax.plot(mu, numbers["fast"], **SIMULATED, marker="v", color=COLOURS[3], label="at $10^9$")
    ax.plot(mu, numbers["paml"], ".", color=COLOURS[0], ms=9, label="PA-ML")
    decades(ax)
    ax.set(xlabel=r"Tabor number $\mu$", ylabel=f"{WORK}, rate $10^5$")
    ax.legend()


LARGE_TABOR, NARROW = 3.2, 1.6
WIDE_RATES = np.geomspace(0.1, 1e8, 37)
WIDE_POINTS = np.geomspace(0.01, 1e7, 28)


def numbers_A_7(bench: Bench) -> Numbers:
    """Return the work by rate, learned and simulated, with the estimates."""
    works = [
        Work(sphere(float(r), _DEPTH, tabor=LARGE_TABOR, exponent=NARROW)) for r in WIDE_POINTS
    ]
    found = table(bench.each, works)
    case = {"tabor": LARGE_TABOR, "modulus_ratio": K, "exponent": NARROW, "preload": _DEPTH}
    return {
        "rate": WIDE_RATES,
        "paml": predicted(WORK_PAML, rate=WIDE_RATES, **case),
        "simulated_rate": WIDE_POINTS,
        "simulated": found["work"],
        "error": found["work_error"],
        "rubbery": float(jkr_work(LARGE_TABOR)),
        "glassy": float(4 / 3 * _RADII[-1] ** 2 * np.pi ** (2 / 3) * LARGE_TABOR),
    }


def draw_A_7(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["rate"], numbers["paml"], **MODEL, color=COLOURS[0], label="PA-ML")
    style = SIMULATED | {"marker": "^", "color": COLOURS[1]}
    ax.plot(numbers["simulated_rate"], numbers["simulated"], **style, label="simulated")
    ax.axhline(numbers["rubbery"], color="k", ls="--", lw=1, label="Eq. 46, rubbery")
    ax.axhline(numbers["glassy"], color="k", ls="-.", lw=1, label="Eq. 43, glassy")
    decades(ax)
    ax.set(ylim=(3, 200), xlabel=RATE, ylabel=WORK)
    ax.legend(loc="upper right")


# Contacts of shorter range than this in the glassy state are near to JKR.
LEAST_TABOR = 1.0
# Ends of ranges of the modulus ratio for which the largest share is stated.
RATIOS = (1e-3, 0.05, 0.2, 0.3, 1.0)
_SHOWN = 500


def numbers_work_bound(bench: Bench) -> Numbers:
    """Return works over the bound by glassy Tabor number, of rows that start in compression."""
    unit = float(jkr.work_to_instability(**UNIT)) / CHAPTER_4
    share, glassy, ratio, over = [], [], [], []
    for name in ("thesis", "broad"):
        rows = datasets.load(name)
        k, mu, work = (
            rows.column(column).to_numpy()
            for column in ("modulus_ratio", "tabor", "work_to_pull_off")
        )
        pressed = [force[0] > 0 for force in rows.column("trajectory_force").to_pylist()]
        known = np.array(pressed) & np.isfinite(work)
        share.append((work / (unit * mu * np.pi ** (2 / 3) * k ** (-5 / 3)))[known])
        glassy.append((mu * k ** (1 / 3))[known])
        ratio.append(k[known])
        over.append((work / jkr_work(mu))[known])
    every, tabor, k, over = (np.concatenate(x) for x in (share, glassy, ratio, over))
    short = tabor > LEAST_TABOR
    ranges = list(zip(RATIOS, RATIOS[1:], strict=False))
    some = np.random.default_rng(1).permutation(len(every))[:_SHOWN]
    return {
        "unit": unit,
        "rows": len(every),
        "short_rows": int(np.sum(short)),
        "largest_short": float(np.max(every[short])),
        "largest_by_ratio": [
            float(np.max(every[short & (k >= low) & (k < high)])) for low, high in ranges
        ],
        "largest": float(np.max(every)),
        "largest_at_tabor": float(tabor[int(np.argmax(every))]),
        "glassy_tabor": tabor[some],
        "share": every[some],
        "least_over_eq_46": float(np.min(over)),
        "rows_below_eq_46": int(np.sum(over < 1)),
    }


def draw_work_bound(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    style = {"ls": "", "marker": "o", "ms": 3, "mfc": "none", "mew": 0.6, "color": COLOURS[0]}
    ax.plot(numbers["glassy_tabor"], numbers["share"], **style, label="simulated rows")
    ax.axhline(1, color="k", lw=1, label="bound of short range")
    decades(ax)
    ax.set_xlabel(r"glassy Tabor number $\mu k^{1/3}$")
    ax.set_ylabel(r"work / $1.157\,\mu\pi^{2/3}k^{-5/3}$")
    ax.legend()
