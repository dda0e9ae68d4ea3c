"""The energy of the edge by its speed, beside theories."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import minimize_scalar

import viscotack as vt
from viscotack.theory import SteadyCrack, persson_brener, rate

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

_RATES = 10 ** np.linspace(-1, 6, 15)
# Radius of the start: 1.6 times (9/8k)^(1/3), the largest contact that comes off.
_MARGIN = 1.6
# l0 over lambda = E0* h0^2/dg0, the unit of the steady crack.
TIP_OVER_LAMBDA = ALPHA_LJ**2 / (np.pi * ALPHA**2)


def simulated(each: Any, k: float, exponent: float, rates: Any, tabor: float = TABOR) -> Numbers:
    """Return force [1.5 pi R dg0] and crack speed [l0/tau0] by rate, from a large start."""
    start = vt.AtRadius(_MARGIN * (9 / (8 * k)) ** (1 / 3))
    works = [Work(sphere(float(r), start, tabor=tabor, k=k, exponent=exponent)) for r in rates]
    found = table(each, works)
    return {
        "energy": found["force"],
        "error": found["force_error"],
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


def numbers_4_6(bench: Bench) -> Numbers:
    """Return simulations and theories by exponent, and the power laws of the inset."""
    speed = np.geomspace(1e-3, 1e8, 111)
    found: Numbers = {"speed": speed, "theory": {}, "simulated": {}, "tangent": {}}
    for n in (0.2, *EXPONENTS, STANDARD):
        found["theory"][f"{n:g}"] = by_theory(K, n, speed)
        if n != STANDARD:
            law = persson_brener.steepest(material=solid(K, n))
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


def draw_4_6(numbers: Numbers, figure: Figure) -> None:
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
    left.set(ylabel=ENERGY, ylim=(0.9, 30))
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


RATIOS = (0.01, 0.05, 0.1)
_FEWER_RATES = 10 ** np.linspace(-0.5, 6.5, 11)
_SOLIDS = [(k, n) for k in RATIOS for n in EXPONENTS] + [(K, STANDARD)]


def numbers_4_7(bench: Bench) -> Numbers:
    """Return crack speed and energy by solid and rate, simulated and by Eq. 4.24 and 4.21."""
    found = [simulated(bench.each, k, n, _FEWER_RATES) for k, n in _SOLIDS]
    reduced = np.asarray(rate.rate_as_published(_FEWER_RATES))
    speed = np.asarray(rate.crack_speed(reduced, tabor=TABOR))
    theory = [persson_brener.amplification(speed, material=solid(k, n)) for k, n in _SOLIDS]
    return {
        "modulus_ratio": np.array([k for k, _ in _SOLIDS]),
        "exponent": np.array([n for _, n in _SOLIDS]),
        "reduced_rate": reduced,
        "fitted_speed": speed,
        "speed": np.array([of["speed"] for of in found]),
        "energy": np.array([of["energy"] for of in found]),
        "error": np.array([of["error"] for of in found]),
        "predicted": np.array(theory),
    }


def of_ratio(numbers: Numbers, k: float) -> Any:
    """Return predicted over simulated energy, less one, of the power laws of a modulus ratio."""
    some = (numbers["modulus_ratio"] == k) & (numbers["exponent"] != STANDARD)
    return numbers["predicted"][some] / numbers["energy"][some] - 1


def draw_4_7(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    sizes = {0.01: 3.0, 0.05: 5.0, 0.1: 7.0}
    for i, (k, n) in enumerate(zip(numbers["modulus_ratio"], numbers["exponent"], strict=True)):
        style = SIMULATED | {"color": colour(n), "marker": marker(n), "ms": sizes[float(k)]}
        label = words(n) if k == K else None
        left.plot(numbers["reduced_rate"], numbers["speed"][i], **style, label=label)
        right.plot(numbers["predicted"][i], numbers["energy"][i], **style)
    left.plot(numbers["reduced_rate"], numbers["fitted_speed"], "k-", label="Eq. 4.24")
    for k, size in sizes.items():
        left.plot([], [], "o", color="0.4", mfc="none", ms=size, label=f"$k$ = {k:g}")
    line = np.array([1, 110])
    right.plot(line, line, "k-", lw=1)
    for part in (0.85, 1.15):
        right.plot(line, part * line, "k--", lw=0.8)
    decades(left)
    decades(right)
    left.set(xlabel=r"rate $r_u/(3.24\,\pi^{2/3})$", ylabel=TIP_SPEED)
    right.set_xlabel(f"{ENERGY} by Eq. 4.21 and 4.24; dashed: $\\pm$15 %")
    right.set_ylabel("simulated pull-off force over JKR")
    left.legend()


RATIOS_OF_ALPHA = (1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3)
_EXPONENT = 0.8
_RATES_OF_ALPHA = 10 ** np.linspace(-0.5, 5, 9)


def fitted(speed: Any, energy: Any, material: Any) -> tuple[float, float]:
    """Return alpha and the root mean square of what is left, of speeds with alpha = pi/9."""

    def miss(log_alpha: float) -> float:
        v = speed * (np.exp(log_alpha) / ALPHA) ** 2
        theory = np.asarray(persson_brener.amplification(v, material=material))
        return float(np.mean(np.log(energy / theory) ** 2))

    found = minimize_scalar(miss, bounds=(np.log(0.1), np.log(1.0)), method="bounded")
    return float(np.exp(found.x)), float(np.sqrt(found.fun))


def numbers_alpha(bench: Bench) -> Numbers:
    """Return alpha and what it leaves, by modulus ratio and by what is fitted."""
    found: Numbers = {"modulus_ratio": np.array(RATIOS_OF_ALPHA)}
    rows: dict[str, list[tuple[float, float]]] = {"as it is": [], "over f": [], "steady": []}
    v = np.geomspace(1e-2, 1e5, 36)
    for k in RATIOS_OF_ALPHA:
        material = solid(k, _EXPONENT)
        of = simulated(bench.each, k, _EXPONENT, _RATES_OF_ALPHA)
        good = np.isfinite(of["energy"]) & np.isfinite(of["speed"]) & (of["speed"] > 0)
        speed, energy = of["speed"][good], of["energy"][good]
        rows["as it is"].append(fitted(speed, energy, material))
        rows["over f"].append(fitted(speed, energy / float(elastic_ratio(TABOR)), material))
        crack = SteadyCrack(material, vt.LennardJones(1.0, 1.0))
        zone = v * ALPHA_LJ**2 / (np.pi * ALPHA**2)
        rows["steady"].append(fitted(v, np.asarray(crack.amplification(zone)), material))
    for name, some in rows.items():
        found[name] = {"alpha": np.array(some)[:, 0], "left": np.array(some)[:, 1]}
    return found


def draw_alpha(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    words = {"as it is": "simulated force", "over f": r"over $f(\mu)$", "steady": "steady crack"}
    for i, (name, word) in enumerate(words.items()):
        style = {"color": COLOURS[i], "marker": "os^"[i], "mfc": "none", "lw": 0.8, "capsize": 3}
        of = numbers[name]
        ax.errorbar(
            numbers["modulus_ratio"], of["alpha"], of["alpha"] * of["left"], **style, label=word
        )
    ax.axhline(ALPHA, color="k", ls="--", lw=1, label=r"thesis, $\pi/9$")
    ax.set(xscale="log", xlabel="modulus ratio $k$")
    ax.set_ylabel(r"$\alpha = \sigma_c/\sigma_0$; bars: what the fit leaves")
    ax.legend()
