"""The radius of the start above which the pull-off force no longer grows with it.

Claims: the force grows with the start until a threshold, where its slope is below 0.1; all
exponents collapse on P = 0.3 a^2.7 until 1.5/k.

Seen: Left, forces that grow with the start, and level off. Right, the thresholds of all exponents
on one line, which is not that of the thesis: 1.14 a^2.19 where it has 0.3 a^2.7.

Needs: nothing. The radii and rates of the thesis are not printed; here 16 radii, 1.2 to 8, and 9
rates. A threshold is where the slope of a monotone cubic through the forces has fallen to 0.1 for
the last time.

Costs: 576 simulations, three minutes of processor time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import PchipInterpolator

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import CHAPTER_4, EXPONENTS, K, Work, sphere, table
from .style import RATE, SIMULATED, colour, decades, marker, panels, words

SIZE = (10.5, 3.8)
RADII = np.geomspace(1.2, 8.0, 16)
RATES = 10 ** np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0])
_SLOPE = 0.1


def numbers(bench: Bench) -> Numbers:
    """Return forces [pi R dg0] by exponent, rate and start, and the thresholds."""
    works = [
        Work(sphere(float(r), vt.AtRadius(float(a)), exponent=n), estimate=False)
        for n in EXPONENTS
        for r in RATES
        for a in RADII
    ]
    found = table(bench.each, works, (len(EXPONENTS), len(RATES), len(RADII)))
    force = CHAPTER_4 * found["force"]
    limits = np.array([[threshold(force[i, j]) for j in range(len(RATES))] for i in range(4)])
    return {
        "exponent": np.array(EXPONENTS),
        "rate": RATES,
        "start": RADII,
        "force": force,
        "threshold": limits[:, :, 0],
        "force_at_threshold": limits[:, :, 1],
    }


def threshold(force: Any) -> tuple[float, float]:
    """Return radius and force where the slope falls to 0.1 for the last time; nan without one."""
    curve = PchipInterpolator(np.log(RADII), force)
    a = np.geomspace(RADII[0], RADII[-1], 2000)
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


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw forces by start at the lowest rate; thresholds by rate; forces by threshold."""
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
    middle.set_xlabel(RATE)
    middle.set_ylabel("threshold of the start")
    right.set_xlabel("threshold of the start")
    right.set_ylabel(r"pull-off force $\hat P_{po}$ there")
    middle.legend(handles=left.get_lines()[:4], loc="upper left")
    right.legend()
