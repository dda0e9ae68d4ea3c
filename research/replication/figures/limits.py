"""Slow and fast ends, claims that are derived twice, and the printed algorithm."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from research.twins import hat_matrix, lennard_jones
from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import K, Work, elastic_ratio, lens, punch, solid, sphere, table
from .layers import PAD
from .lens import SHORT
from .style import COLOURS, SIMULATED, panels

TABORS = (0.05, 0.2, 0.8, 2.05, 3.24, 10.0)
DEPTHS = (73.0, 150.0, 300.0, 600.0)
SIZES = (64.0, 256.0, 1024.0)
SPEEDS = (1e-6, 1e-5, 1e-4, 1e-3)
_FAST = 1e12
_FINE = 5e-4


def numbers_limits(bench: Bench) -> Numbers:
    """Return slow and fast forces, elastic stress at b1, and forces of the lens, by two routes."""
    slow = table(
        bench.each, [Work(sphere(1.0, 3.0, tabor=mu, k=1), accuracy=_FINE) for mu in TABORS]
    )
    crept = table(bench.each, [Work(sphere(1e-4, 5.0, exponent=1.6), accuracy=_FINE)])
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
        bench.each, [Work(punch(50.0, r, geometry=vt.FlatPunch(5.0))) for r in (1e-2, 1e4)]
    )
    lens_rows = np.array(list(bench.each(both, SPEEDS)))
    return {
        "tabor": np.array(TABORS),
        "slow": slow["force"],
        "slow_error": slow["force_error"],
        "slow_viscoelastic": float(crept["force"][0]),
        "depth": np.array(DEPTHS),
        "fast": K * fast["force"],
        "fast_error": fast["force_error"],
        "fast_theory": float(elastic_ratio(3.24 * K ** (1 / 3))),
        "at_b1": stress,
        "at_b1_limit": float(limit),
        "at_b1_exact": float(PAD.elastic_stress(b1 * PAD.half_width)) * np.sqrt(PAD.half_width),
        "broad_force": float(broad["force"][0]),
        "broad_error": float(broad["force_error"][0]),
        "narrow_punch": narrow["force"],
        "lens": dict(zip(("simulated", "error", "crack", "band"), lens_rows.T, strict=True)),
    }


def both(speed: float) -> tuple[float, float, float, float]:
    """Return the force of the lens [mN] with 30.8 nm by simulation and by theory, and errors."""
    problem = lens(speed, SHORT)
    result = vt.solve(problem, until="pull-off", accuracy=2e-3, estimate_error=speed > 5e-6)
    unit = 1e3 * problem.scales().force
    answer = vt.crack_contact(problem)
    assert answer.pull_off_force is not None
    error = (result.error_estimate or {}).get("force", np.nan)
    return unit * vt.pull_off_force(result), error, unit * answer.pull_off_force, answer.band


def draw_limits(numbers: Numbers, figure: Figure) -> None:
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


UNIFORM_TABORS = (1.0, 3.24, 10.0, 30.0, 103.0)
NODES = (500, 1000)
# In (R^2 dg0/E0*)^(1/3): radius of the start, last node.
_START, _LAST = 2.3, 4.0
_STEPS, _ITERATIONS, _SMALL = 150, 80, 1e-7
_UNIT = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}


def retracted(case: tuple[float, int]) -> dict[str, float]:
    """Return the largest tension over JKR's, and how far the drive went until contact was lost."""
    tabor, nodes = case
    r = np.linspace(0, _LAST, nodes)
    G = tabor * hat_matrix(nodes, r[1])
    start = float(jkr.depth(_START, **_UNIT)) * tabor
    end = 1.6 * float(jkr.instability(**_UNIT).depth) * tabor
    gap = np.asarray(jkr.gap(r, contact_radius=_START, **_UNIT)) * tabor + 1.02
    best, taken = 0.0, 0
    for depth in np.linspace(start, end, _STEPS):
        found = _equilibrium(gap, depth, r, G, tabor)
        if found is None:
            # beyond a jump the gap before it is no guess
            break
        gap, taken = found, taken + 1
        # the tail beyond the last node, per node as if rigid
        force = 2 * np.trapezoid(lennard_jones(gap, tabor)[0] * r, r) - 8 / 3 / gap[-1] ** 2
        best = min(best, float(force))
    return {"force": -best / 1.5, "way": taken / _STEPS}


def _equilibrium(gap: Any, depth: float, r: Any, G: Any, tabor: float) -> Any:
    """Return the gap at a depth by Newton's method from a guess; None where it is not found."""
    rigid = 1 - depth + tabor * r**2 / 2

    def miss(gap: Any) -> Any:
        return gap - rigid - G @ lennard_jones(gap, tabor)[0]

    at = miss(gap)
    for _ in range(_ITERATIONS):
        size = np.max(np.abs(at))
        if size < _SMALL:
            return gap
        step = np.linalg.solve(np.eye(len(r)) - G * lennard_jones(gap, tabor)[1], -at)
        part = min(1.0, 0.7 / max(1e-30, float(np.max(-step / gap))))
        while part > 1e-4:
            tried = gap + part * step
            new = miss(tried)
            if np.max(np.abs(new)) < (1 - 0.1 * part) * size:
                break
            part /= 2
        else:
            return None
        gap, at = tried, new
    return None


def numbers_printed_algorithm(bench: Bench) -> Numbers:
    """Return forces and the way until contact was lost, by number of nodes and Tabor number."""
    cases = [(mu, n) for n in NODES for mu in UNIFORM_TABORS]
    rows = list(bench.each(retracted, cases))
    shape = (len(NODES), len(UNIFORM_TABORS))
    return {
        "tabor": np.array(UNIFORM_TABORS),
        "nodes": list(NODES),
        "force": np.array([row["force"] for row in rows]).reshape(shape),
        "way": np.array([row["way"] for row in rows]).reshape(shape),
        "expected": np.asarray(elastic_ratio(np.array(UNIFORM_TABORS))),
    }


def draw_printed_algorithm(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["tabor"], numbers["expected"], "k-", lw=1, label=r"elastic, $f(\mu)$")
    for i, nodes in enumerate(numbers["nodes"]):
        style = {"ls": ":", "marker": "os"[i], "mfc": "none", "color": COLOURS[i]}
        ax.plot(numbers["tabor"], numbers["force"][i], **style, label=f"{nodes:g} equal nodes")
    ax.set(xscale="log", yscale="log", xlabel=r"Tabor number $\mu$")
    ax.set_ylabel("largest tension over JKR")
    ax.legend()
