"""The published algorithm, elastic, on its uniform mesh: how far the Tabor number may go.

Claims: 500 equally spaced nodes serve for every case, the lens of Fig. 4.10 at a Tabor number of
103 among them.

Seen: Up to a Tabor number of 3 equal nodes give the elastic force to 0.1 %. At 10 Newton's method
gives up where the edge goes from node to node; from 30 on the edge stays at its node, and the
tension grows for as long as the drive is moved.

Needs: nothing. Appendix V as corrected, for a relaxed (elastic) half-space: overlapping triangles,
dense Newton, retraction in 150 steps from a contact of 2.3 (R^2 dg0/E0*)^(1/3), that of the lens
under 1.5 mN, to 1.6 times the depth at which JKR lets go. Elastic forces are known: f(mu) times
that of JKR.

Costs: two minutes of processor time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.special import ellipkm1

from viscotack.theory import jkr

from ..bench import Bench, Numbers
from .cases import elastic_ratio
from .style import COLOURS, panels

SIZE = (6.6, 4.4)
TABORS = (1.0, 3.24, 10.0, 30.0, 103.0)
NODES = (500, 1000)
# In (R^2 dg0/E0*)^(1/3): radius of the start, last node.
_START, _LAST = 2.3, 4.0
_STEPS, _ITERATIONS, _SMALL = 150, 80, 1e-7
_UNIT = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}


def influence(r: Any) -> Any:
    """Return the displacement at each node by a triangle of pressure at each, Eq. 29 and 30."""
    x, w = np.polynomial.legendre.leggauss(8)
    fine, weight = np.polynomial.legendre.leggauss(20)
    step = r[1] - r[0]
    found = np.zeros((len(r), len(r)))
    for j in range(len(r) - 1):
        regular = np.ones(len(r), dtype=bool)
        regular[[j, j + 1]] = False
        t = (x + 1) / 2
        values = _kernel(r[regular, None], r[j] + step * t, None) * (r[j] + step * t) * w / 2 * step
        found[regular, j] += values @ (1 - t)
        found[regular, j + 1] += values @ t
        for i, sign in ((j, 1), (j + 1, -1)):
            # the logarithm at the node is taken by points that crowd there
            u = ((fine + 1) / 2) ** 5
            jacobian = 5 * ((fine + 1) / 2) ** 4 * weight / 2 * step
            s = r[i] + sign * step * u
            values = _kernel(r[i], s, step * u) * s * jacobian
            here, there = (j, j + 1) if sign > 0 else (j + 1, j)
            found[i, here] += np.sum(values * (1 - u))
            found[i, there] += np.sum(values * u)
    return found


def _kernel(r: Any, s: Any, apart: Any) -> Any:
    high, low = np.maximum(r, s), np.minimum(r, s)
    distance = high - low if apart is None else apart
    return 4 / (np.pi * high) * ellipkm1(distance * (high + low) / high**2)


def retracted(case: tuple[float, int]) -> dict[str, float]:
    """Return the largest tension over JKR's, and how far the drive went until contact was lost."""
    tabor, nodes = case
    r = np.linspace(0, _LAST, nodes)
    G = tabor * influence(r)
    start = float(jkr.depth(_START, **_UNIT)) * tabor
    end = 1.6 * float(jkr.instability(**_UNIT).depth) * tabor
    gap = np.asarray(jkr.gap(r, contact_radius=_START, **_UNIT)) * tabor + 0.02
    best, taken = 0.0, 0
    for depth in np.linspace(start, end, _STEPS):
        found = _equilibrium(gap, depth, r, G, tabor)
        if found is None:
            # beyond a jump the gap before it is no guess
            break
        gap, taken = found, taken + 1
        pressure = -_tension(gap, tabor)[0]
        # the tail beyond the last node, per node as if rigid
        force = 2 * np.trapezoid(pressure * r, r) - 8 / 3 / (gap[-1] + 1) ** 2
        best = min(best, float(force))
    return {"force": -best / 1.5, "way": taken / _STEPS}


def _tension(gap: Any, tabor: float) -> tuple[Any, Any]:
    h = 1 + gap
    return 8 / 3 * tabor * (h**-3 - h**-9), 8 / 3 * tabor * (9 * h**-10 - 3 * h**-4)


def _equilibrium(gap: Any, depth: float, r: Any, G: Any, tabor: float) -> Any:
    """Return the gap - 1 at a depth by Newton's method from a guess; None where it is not found."""
    H = gap.copy()
    rigid = -depth + tabor * r**2 / 2

    def miss(H: Any) -> Any:
        return H - rigid + G @ _tension(H, tabor)[0]

    at = miss(H)
    for _ in range(_ITERATIONS):
        size = np.max(np.abs(at))
        if size < _SMALL:
            return H
        step = np.linalg.solve(np.eye(len(r)) + G * _tension(H, tabor)[1], -at)
        part = min(1.0, 0.7 / max(1e-30, float(np.max(-step / (1 + H)))))
        while part > 1e-4:
            tried = H + part * step
            new = miss(tried)
            if np.max(np.abs(new)) < (1 - 0.1 * part) * size:
                break
            part /= 2
        else:
            return None
        H, at = tried, new
    return None


def numbers(bench: Bench) -> Numbers:
    """Return forces and the way until contact was lost, by number of nodes and Tabor number."""
    cases = [(mu, n) for n in NODES for mu in TABORS]
    rows = list(bench.each(retracted, cases))
    shape = (len(NODES), len(TABORS))
    zone = 0.75 / np.array(TABORS) ** 2
    return {
        "tabor": np.array(TABORS),
        "nodes": list(NODES),
        "force": np.array([row["force"] for row in rows]).reshape(shape),
        "way": np.array([row["way"] for row in rows]).reshape(shape),
        "expected": np.asarray(elastic_ratio(np.array(TABORS))),
        "nodes_in_a_zone": np.outer(np.array(NODES) / _LAST, zone),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the forces by Tabor number beside the elastic ones."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["tabor"], numbers["expected"], "k-", lw=1, label=r"elastic, $f(\mu)$")
    for i, nodes in enumerate(numbers["nodes"]):
        style = {"ls": ":", "marker": "os"[i], "mfc": "none", "color": COLOURS[i]}
        ax.plot(numbers["tabor"], numbers["force"][i], **style, label=f"{nodes:g} equal nodes")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel(r"Tabor number $\mu$")
    ax.set_ylabel("largest tension over JKR")
    ax.legend()
