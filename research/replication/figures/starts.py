"""A sphere pulled off from starts of several radii."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

import viscotack as vt
from viscotack.theory import jkr, persson_brener

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, EXPONENTS, K, Work, curve, solid, sphere, table, tip_speed
from .elastic import UNIT
from .style import (
    COLOURS,
    MARKERS,
    RADIUS,
    RATE,
    SIMULATED,
    TIP_SPEED,
    colour,
    decades,
    marker,
    panels,
    words,
)

# Rate, exponent and radius of the start, by panel.
PANELS = {
    "rate": [(10.0**p, 0.8, 3.61) for p in (2, 2.5, 3, 6)],
    "exponent": [(10**2.5, n, 3.61) for n in (0.6, 0.8, 1.6)],
    "start": [(10**2.5, 1.6, a) for a in (1.71, 2.47, 3.61)],
}


def numbers_4_3(bench: Bench) -> Numbers:
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


def draw_4_3(numbers: Numbers, figure: Figure) -> None:
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


RADII = (1.94, 2.50, 3.61, 5.28)
RATES = np.geomspace(0.1, 1e6, 15)


def numbers_4_4(bench: Bench) -> Numbers:
    """Return force [pi R dg0] and crack speed [l0/tau0] by start and rate, and theory."""
    works = [Work(sphere(float(r), vt.AtRadius(a), exponent=0.8)) for a in RADII for r in RATES]
    found = table(bench.each, works, (len(RADII), len(RATES)))
    speed = np.geomspace(1e-2, 1e7, 91)
    return {
        "start": np.array(RADII),
        "force": CHAPTER_4 * found["force"],
        "error": found["force_error"],
        "speed": tip_speed(found["speed"]),
        "theory_speed": speed,
        "theory": 1.5
        * np.asarray(persson_brener.amplification(speed, material=solid(exponent=0.8))),
    }


def draw_4_4(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["theory_speed"], numbers["theory"], "k-", label="Persson-Brener, 1.5 times")
    for i, a in enumerate(numbers["start"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(numbers["speed"][i], numbers["force"][i], **style, label=f"start at {a:g}")
    ax.axhline(15, color="0.5", lw=0.8)
    decades(ax)
    ax.set_ylim(1.2, 20)
    ax.set_yticks([1.5, 5, 10, 15], ["1.5", "5", "10", "15"])
    ax.minorticks_off()
    ax.set(xlabel=TIP_SPEED, ylabel=r"pull-off force $\hat P_{po}$ / $\pi R\,\Delta\gamma_0$")
    ax.legend()


STARTS = np.geomspace(1.2, 8.0, 16)
RATES_OF_STARTS = 10 ** np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0])
_SLOPE = 0.1


def numbers_4_5(bench: Bench) -> Numbers:
    """Return forces [pi R dg0] by exponent, rate and start, and the thresholds."""
    works = [
        Work(sphere(float(r), vt.AtRadius(float(a)), exponent=n), estimate=False)
        for n in EXPONENTS
        for r in RATES_OF_STARTS
        for a in STARTS
    ]
    found = table(bench.each, works, (len(EXPONENTS), len(RATES_OF_STARTS), len(STARTS)))
    force = CHAPTER_4 * found["force"]
    limits = np.array(
        [[threshold(force[i, j]) for j in range(len(RATES_OF_STARTS))] for i in range(4)]
    )
    return {
        "exponent": np.array(EXPONENTS),
        "rate": RATES_OF_STARTS,
        "start": STARTS,
        "force": force,
        "threshold": limits[:, :, 0],
        "force_at_threshold": limits[:, :, 1],
    }


def threshold(force: Any) -> tuple[float, float]:
    """Return radius and force where the slope falls to 0.1 for the last time; nan without one."""
    curve = PchipInterpolator(np.log(STARTS), force)
    a = np.geomspace(STARTS[0], STARTS[-1], 2000)
    slope = curve(np.log(a), 1) / a
    steep = np.flatnonzero(slope > _SLOPE)
    if not steep.size or steep[-1] == len(a) - 1:
        return np.nan, np.nan
    at = float(a[steep[-1] + 1])
    return at, float(curve(np.log(at)))


def power_law(numbers: Numbers) -> tuple[float, float, float]:
    """Return factor, exponent and scatter of the force at the threshold as a power of it.

    Of thresholds whose force is between 1.3 times the elastic one and 0.8 times 1.5/k: there the
    force depends on the start and is not at its end.
    """
    a, force = np.ravel(numbers["threshold"]), np.ravel(numbers["force_at_threshold"])
    rising = np.isfinite(a) & (force > 1.3 * CHAPTER_4) & (force < 0.8 * CHAPTER_4 / K)
    x, y = np.log(a[rising]), np.log(force[rising])
    slope, level = np.polyfit(x, y, 1)
    return float(np.exp(level)), float(slope), float(np.std(y - level - slope * x))


def draw_4_5(numbers: Numbers, figure: Figure) -> None:
    left, middle, right = panels(figure, 1, 3)
    for i, n in enumerate(numbers["exponent"]):
        style = SIMULATED | {"color": colour(n), "marker": marker(n)}
        left.plot(numbers["start"], numbers["force"][i, 0], **(style | {"ls": ":"}), label=words(n))
        middle.plot(numbers["rate"], numbers["threshold"][i], **(style | {"ls": ":"}))
        right.plot(numbers["threshold"][i], numbers["force_at_threshold"][i], **style)
    a = np.geomspace(1.2, 6, 20)
    right.plot(a, 0.3 * a**2.7, "k--", label=r"thesis, $0.3\,a^{2.7}$")
    factor, slope, _ = power_law(numbers)
    right.plot(a, factor * a**slope, "k-", lw=1, label=rf"here, ${factor:.2f}\,a^{{{slope:.2f}}}$")
    right.axhline(CHAPTER_4 / K, color="0.5", lw=0.8)
    decades(middle, y=False)
    decades(right)
    right.set_xticks([2, 3, 4, 6], ["2", "3", "4", "6"])
    right.set_yticks([2, 5, 10, 15], ["2", "5", "10", "15"])
    right.minorticks_off()
    right.set_ylim(1.2, 25)
    left.set_xlabel(r"start $a_0/(\pi R^2\Delta\gamma_0/E_0^*)^{1/3}$")
    left.set_ylabel(r"pull-off force $\hat P_{po}$, rate $10^{0.5}$")
    middle.set(xlabel=RATE, ylabel="threshold of the start")
    right.set(xlabel="threshold of the start", ylabel=r"pull-off force $\hat P_{po}$ there")
    middle.legend(handles=left.get_lines()[:4], loc="upper left")
    right.legend()
