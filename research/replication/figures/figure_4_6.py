"""Effective surface energy by crack speed: simulation, Persson-Brener, and the steady crack.

Claims: with alpha = pi/9 the theory of Persson and Brener agrees excellently with simulations from
a large start, for every n and for k from 0.01 to 0.1; the standard solid is close to n = 1.6.

Seen: Markers on lines over nine decades. The right panel magnifies: simulations are within 5 % of
Persson-Brener with its fitted length (solid), and within 1.3 % of the steady crack, which has no
fitted number, times the factor of the finite range (dotted), until Gamma comes close to 1/k.

Needs: nothing. mu = 3.24; starts are 1.6 times the largest contact at pull-off. The steady crack,
which the thesis does not have, has no fitted constant; simulated forces are shown over f(mu), the
elastic force at the range of the forces, as well.

Costs: 90 simulations, a minute of processor time; steady cracks some seconds.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import SteadyCrack, crack_regimes, persson_brener

from ..bench import Bench, Numbers
from .cases import (
    ALPHA,
    ALPHA_LJ,
    EXPONENTS,
    STANDARD,
    TABOR,
    K,
    Work,
    elastic_ratio,
    solid,
    sphere,
    table,
    tip_speed,
)
from .style import (
    COLOURS,
    ENERGY,
    MARKERS,
    SIMULATED,
    TIP_SPEED,
    colour,
    decades,
    marker,
    panels,
    words,
)

SIZE = (10.0, 4.3)
_RATES = 10 ** np.linspace(-1, 6, 15)
# Radius of the start: 1.6 times (9/8k)^(1/3), the largest contact that comes off.
_MARGIN = 1.6
# l0 over lambda = E0* h0^2/dg0, the unit of the steady crack.
TIP_OVER_LAMBDA = ALPHA_LJ**2 / (np.pi * ALPHA**2)


def full_start(k: float) -> vt.AtRadius:
    """Return a start that no rate finds too small."""
    return vt.AtRadius(_MARGIN * (9 / (8 * k)) ** (1 / 3))


def simulated(each: Any, k: float, exponent: float, rates: Any, tabor: float = TABOR) -> Numbers:
    """Return force [1.5 pi R dg0] and crack speed [l0/tau0] by rate, from a large start."""
    works = [
        Work(sphere(float(r), full_start(k), tabor=tabor, k=k, exponent=exponent)) for r in rates
    ]
    found = table(each, works)
    return {
        "rate": np.asarray(rates),
        "energy": found["force"],
        "error": found["force_error"],
        "edge_speed": found["speed"],
        "speed": tip_speed(found["speed"], tabor),
    }


def by_theory(k: float, exponent: float, speed: Any) -> dict[str, Any]:
    """Return the energies of Persson-Brener and of the steady crack at speeds [l0/tau0]."""
    material = solid(k, exponent)
    crack = SteadyCrack(material, vt.LennardJones(1.0, 1.0))
    return {
        "persson_brener": persson_brener.amplification(speed, material=material),
        "steady": crack.amplification(np.asarray(speed) * TIP_OVER_LAMBDA),
    }


def numbers(bench: Bench) -> Numbers:
    """Return simulations and theories by exponent, and the power laws of the inset."""
    speed = np.geomspace(1e-3, 1e8, 111)
    found: Numbers = {"speed": speed, "theory": {}, "simulated": {}, "tangent": {}}
    for n in (0.2, *EXPONENTS, STANDARD):
        found["theory"][f"{n:g}"] = by_theory(K, n, speed)
        if n != STANDARD:
            law = crack_regimes.steepest(material=solid(K, n))
            found["tangent"][f"{n:g}"] = [float(law.coefficient), float(law.exponent)]
    for n in (*EXPONENTS, STANDARD):
        found["simulated"][f"{n:g}"] = simulated(bench.each, K, n, _RATES)
    return found


def off(numbers: Numbers, name: str, theory: str = "persson_brener") -> Any:
    """Return simulated over theoretical energy, less one, of a material, by rate."""
    of = numbers["simulated"][name]
    curve = numbers["theory"][name][theory]
    there = np.exp(np.interp(np.log(of["speed"]), np.log(numbers["speed"]), np.log(curve)))
    return of["energy"] / there - 1


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw energies by speed, and how far simulations are from both theories."""
    left, right = panels(figure, 1, 2)
    for name, of in numbers["theory"].items():
        n = float(name)
        left.plot(numbers["speed"], of["persson_brener"], "-", color=colour(n), lw=1)
        if name not in numbers["simulated"]:
            left.plot([], [], "-", color=colour(n), label=words(n))
            continue
        style = SIMULATED | {"color": colour(n), "marker": marker(n)}
        some = numbers["simulated"][name]
        left.plot(some["speed"], some["energy"], **style, label=words(n))
        right.plot(some["speed"], 100 * off(numbers, name), **(style | {"ls": "-", "lw": 0.7}))
        ratio = elastic_ratio(TABOR * some["energy"] ** (-1 / 3))
        steady = 100 * ((1 + off(numbers, name, "steady")) / ratio - 1)
        right.plot(some["speed"], steady, ":", color=colour(n))
    left.plot([], [], "k-", lw=1, label=r"Persson-Brener, $\alpha=\pi/9$")
    right.plot([], [], "k-", lw=0.7, label="over Persson-Brener")
    right.plot([], [], "k:", label=r"over the steady crack times $f(\mu\Gamma^{-1/3})$")
    decades(left)
    decades(right, y=False)
    left.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    left.minorticks_off()
    right.axhline(0, color="0.5", lw=0.8)
    right.set_ylim(-12, 15)
    for ax in (left, right):
        ax.set_xlabel(TIP_SPEED)
    left.set_ylabel(ENERGY)
    left.set_ylim(0.9, 30)
    right.set_ylabel("simulated, beside theory [%]")
    left.legend(loc="upper left", fontsize="small")
    right.legend()
    # the power laws beta v^m that touch Persson-Brener where it climbs most steeply
    inset = left.inset_axes((0.7, 0.14, 0.28, 0.33))
    exponents = [float(name) for name in numbers["tangent"]]
    for i, word in enumerate((r"$\beta$", "$m$")):
        law = [of[i] for of in numbers["tangent"].values()]
        inset.plot(exponents, law, MARKERS[i] + "-", color=COLOURS[-1 - i], ms=4, label=word)
    inset.set_xlabel("$n$", labelpad=0)
    inset.tick_params(labelsize="small")
    inset.legend(fontsize="small", handlelength=1.2)
