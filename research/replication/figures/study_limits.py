"""Slow and fast ends by simulation and by theory, and claims that are derived twice.

Claims: slowly the force is that of JKR and fast 1/k times it; the half-plane begins at b1; linear
theory with h0 = 30.8 nm gives the forces of Fig. 4.10.

Seen: Slow forces lie on the elastic curve, fast ones approach f(mu k^(1/3)) instead of 1, and the
lens with 30.8 nm is the same by two independent routes.

Needs: nothing.

Costs: 30 simulations, two minutes of processor time, most of it for the lens.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt

from ..bench import Bench, Numbers
from .cases import K, Work, elastic_ratio, lens, punch, solid, sphere, table
from .figure_3_3 import PAD
from .figure_4_10 import SHORT
from .style import COLOURS, SIMULATED, panels

SIZE = (10.5, 3.8)
TABORS = (0.05, 0.2, 0.8, 2.05, 3.24, 10.0)
DEPTHS = (73.0, 150.0, 300.0, 600.0)
SIZES = (64.0, 256.0, 1024.0)
SPEEDS = (1e-6, 1e-5, 1e-4, 1e-3)
_FAST = 1e12
_FINE = 5e-4


def numbers(bench: Bench) -> Numbers:
    """Return slow and fast forces, elastic stress at b1, and forces of the lens, by two routes."""
    slow = table(
        bench.each, [Work(sphere(1.0, 3.0, tabor=mu, k=1), accuracy=_FINE) for mu in TABORS]
    )
    crept = table(
        bench.each,
        [Work(sphere(1e-4, 5.0, exponent=1.6), accuracy=_FINE)],
    )
    fast = table(bench.each, [Work(sphere(_FAST, d, exponent=1.6), accuracy=_FINE) for d in DEPTHS])
    b1 = 4 / np.pi
    layers = [
        Work(punch(b1 * s, 1.0, geometry=vt.FlatPunch(s), material=solid(1.0)), accuracy=_FINE)
        for s in SIZES
    ]
    stress = table(bench.each, layers)["force"] * np.sqrt(np.array(SIZES))
    # the crack of a finite zone recedes by a part that falls as the root of a0/a
    limit = np.polynomial.polynomial.polyfit(1 / np.sqrt(np.array(SIZES)), stress, 2)[0]
    broad = table(bench.each, [Work(sphere(100.0, 73.0, exponent=0.2))])
    narrow = table(
        bench.each,
        [Work(punch(50.0, r, geometry=vt.FlatPunch(5.0))) for r in (1e-2, 1e4)],
    )
    return {
        "tabor": np.array(TABORS),
        "slow": slow["force"],
        "slow_error": slow["force_error"],
        "slow_theory": np.asarray(elastic_ratio(np.array(TABORS))),
        "slow_viscoelastic": float(crept["force"][0]),
        "depth": np.array(DEPTHS),
        "fast": K * fast["force"],
        "fast_error": fast["force_error"],
        "fast_theory": float(elastic_ratio(3.24 * K ** (1 / 3))),
        "size": np.array(SIZES),
        "at_b1": stress,
        "at_b1_limit": float(limit),
        "at_b1_exact": float(PAD.elastic_stress(b1 * PAD.half_width)) * np.sqrt(PAD.half_width),
        "broad_force": float(broad["force"][0]),
        "broad_error": float(broad["force_error"][0]),
        "narrow_punch": narrow["force"],
        "lens": dict(zip(("simulated", "error", "crack", "band"), _lens(bench.each), strict=True)),
    }


def _lens(each: Any) -> Any:
    rows = np.array(list(each(both, SPEEDS)))
    return rows.T


def both(speed: float) -> tuple[float, float, float, float]:
    """Return the force of the lens [mN] with 30.8 nm by simulation and by theory, and errors."""
    problem = lens(speed, SHORT)
    result = vt.solve(problem, until="pull-off", accuracy=2e-3, estimate_error=speed > 5e-6)
    unit = 1e3 * problem.scales().force
    answer = vt.crack_contact(problem)
    assert answer.pull_off_force is not None
    error = (result.error_estimate or {}).get("force", np.nan)
    return unit * vt.pull_off_force(result), error, unit * answer.pull_off_force, answer.band


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw slow forces by Tabor number, fast ones by depth, and the lens by speed."""
    left, middle, right = panels(figure, 1, 3)
    style = SIMULATED | {"color": COLOURS[0], "marker": "o", "label": "simulated"}
    mu = np.geomspace(0.03, 10, 60)
    left.plot(mu, elastic_ratio(mu), "k-", lw=1, label=r"$f(\mu)$")
    left.plot(numbers["tabor"], numbers["slow"], **style)
    left.set(xscale="log", xlabel=r"Tabor number $\mu$", ylabel="slow force over JKR")
    middle.axhline(numbers["fast_theory"], color="k", lw=1, label=r"$f(\mu k^{1/3})$")
    middle.axhline(1, color="0.5", ls="--", lw=1, label="thesis, 1")
    middle.plot(numbers["depth"], numbers["fast"], **style)
    middle.set(xlabel=r"depth of the start / $h_0$", ylabel="$k$ times the fast force over JKR")
    v = 1e6 * np.array(SPEEDS)
    right.plot(v, numbers["lens"]["crack"], "k-", lw=1, label="steady crack at the edge")
    right.plot(v, numbers["lens"]["simulated"], **style)
    right.set(xscale="log", xlabel="speed [µm/s]", ylabel="lens, $h_0$ = 30.8 nm: force [mN]")
    for ax in (left, middle, right):
        ax.legend()
