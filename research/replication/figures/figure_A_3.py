"""Persson-Brener's gain by crack speed, Gamma - 1, with its two power laws.

Claims: q1 v at low speed, q1 = -0.0125 + 3.136 n; q2 v^m2 beyond, m2 = 1/2 for n = 1.6 and less for
broad spectra.

Seen: A straight start of slope 1 for every n. On the right its coefficient: the printed one is pi
n, which at k = 0.1 is a tenth too high. Exponents of the second law, drawn tenfold, come down to
the limit n/(1 + n) only for much longer ranges of speed.

Needs: nothing. The values of the inset are not printed.

Costs: milliseconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import crack_regimes, persson_brener

from ..bench import Bench, Numbers
from .cases import K, solid
from .style import COLOURS, TIP_SPEED, decades, panels

SIZE = (10.0, 4.2)
EXPONENTS = (0.2, 0.4, 0.6, 0.8, 1.2, 1.6)
# Between the two: the gain is a power of the speed over a decade or more only if k is small.
_SMALL = 1e-4


def numbers(bench: Bench) -> Numbers:
    """Return the gain by speed, exact and fitted coefficients, and the steepest slopes beyond 1."""
    v = np.geomspace(1e-5, 1e6, 111)
    gain = {
        n: np.asarray(persson_brener.amplification(v, material=solid(K, n))) - 1 for n in EXPONENTS
    }
    n = np.array(EXPONENTS)
    slopes = []
    for each in EXPONENTS:
        far = np.geomspace(1, 1e3, 61)
        y = np.log(np.asarray(persson_brener.amplification(far, material=solid(_SMALL, each))) - 1)
        slope, level = np.polyfit(np.log(far), y, 1)
        slopes.append([float(np.exp(level)), float(slope)])
    return {
        "speed": v,
        "exponent": n,
        "gain": np.array([gain[e] for e in EXPONENTS]),
        "q1_printed": -0.0125 + 3.136 * n,
        "q1_exact": np.pi * n * (1 - K),
        "q1_exact_small_k": np.pi * n,
        "q2_fitted_small_k": np.array(slopes)[:, 0],
        "m2_fitted_small_k": np.array(slopes)[:, 1],
        "m2_limit": np.asarray(crack_regimes.intermediate_exponent(n)),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the gains with their slow laws, and the exponents of the second law."""
    left, right = panels(figure, 1, 2)
    v = numbers["speed"]
    for i, n in enumerate(numbers["exponent"]):
        left.plot(v, numbers["gain"][i], color=COLOURS[i], label=f"$n$ = {n:g}")
        slow = v < 1
        left.plot(v[slow], numbers["q1_exact"][i] * v[slow], ":", color=COLOURS[i])
    left.plot([], [], "k:", label=r"$\pi n(1-k)\,\hat v$")
    decades(left)
    left.set_ylim(1e-6, 20)
    left.set_xlabel(TIP_SPEED)
    left.set_ylabel(r"$\Gamma - 1$, $k$ = 0.1")
    left.legend()
    n = numbers["exponent"]
    right.plot(n, numbers["q1_printed"], "s", mfc="none", color=COLOURS[0], label="$q_1$ printed")
    right.plot(n, numbers["q1_exact_small_k"], "-", color=COLOURS[0], label=r"$\pi n$")
    right.plot(n, numbers["q1_exact"], "--", color=COLOURS[0], label=r"$\pi n(1-k)$, $k$ = 0.1")
    right.plot(
        n,
        10 * numbers["m2_fitted_small_k"],
        "o",
        mfc="none",
        color=COLOURS[1],
        label="10 $m_2$, $k$ = $10^{-4}$, $v$ = 1 to $10^3$",
    )
    right.plot(n, 10 * numbers["m2_limit"], "-", color=COLOURS[1], label=r"10 $n/(1+n)$ or 5")
    right.set_xlabel("exponent $n$")
    right.set_ylabel("$q_1$, 10 $m_2$")
    right.legend()
