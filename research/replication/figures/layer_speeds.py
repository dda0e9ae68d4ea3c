"""A punch on four layers: stress, energy and work by the speed of the crack."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import punch as theory

from ..bench import Bench, Numbers
from .cases import FOUR, K, Work, punch, solid, table
from .cases import SIZE as HALF_WIDTH
from .layers import PAD
from .style import COLOURS, ENERGY, MARKERS, SIMULATED, decades, panels

SPEED = r"crack speed at pull-off $V_c\,\tau/h_0$"
RATES = np.geomspace(1e-3, 1e4, 22)


def numbers_3_8(bench: Bench) -> Numbers:
    """Return what comes off how, by thickness [a0] and rate [h0/tau], in units of the package."""
    works = [Work(punch(b, float(r)), until="detached") for b in FOUR for r in RATES]
    found = table(bench.each, works, (len(FOUR), len(RATES)))
    return {"thickness": np.array(FOUR), "rate": RATES} | found


def draw_3_8(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    for i, b in enumerate(numbers["thickness"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(numbers["speed"][i], numbers["force"][i], **style, label=f"$b$ = {b:g} $a_0$")
    decades(ax, y=False)
    ax.set(ylim=(0, 1.05), xlabel=SPEED, ylabel=r"pull-off stress / $\sigma_0$")
    ax.legend()


SIZES = (32.42, 64.84, 129.69)
THICKNESSES = (1.5, 2.0, 3.0, 5.0, 8.0, 12.7, 20.0, 32.42)
_RATE = 100.0
# Length of the fracture over the range, Eq. 3.5.
A0_OVER_H0 = punch(1.0, 1.0).fracture_length


def surface_energy(stress: Any, ligament: Any, thickness: Any) -> Any:
    r"""Return Eq. 3.30, :math:`(\pi/4) \hat\sigma^2 (b/a_0) (a/a_c)^2`.

    The ligament is counted as the whole punch where it is more, and where it is not known.
    """
    known = np.where(np.isfinite(ligament), np.minimum(ligament, 1), 1)
    return np.pi / 4 * np.asarray(stress) ** 2 * thickness / known**2


def by_theory(name: str) -> dict[str, Any]:
    """Return the energy by crack speed [h0/tau] of a theory, limited by the size of each layer."""
    speed = np.geomspace(1, 1e6, 61)
    law = PAD.crack_law(name, material=solid())
    energies = [
        theory.unloading.amplification(
            speed / A0_OVER_H0, law, largest=theory.unloading.largest_amplification(b, PAD)
        )
        for b in FOUR
    ]
    return {"speed": speed, "energy": np.array(energies)}


def numbers_3_9(bench: Bench) -> Numbers:
    """Return the energies simulated and by theory, and the largest ones by thickness and size."""
    found = bench.of("3.8")
    b = np.array(THICKNESSES)
    works = [Work(punch(float(x), _RATE, geometry=vt.FlatPunch(a))) for a in SIZES for x in b]
    inset = table(bench.each, works, (len(SIZES), len(b)))
    return {
        "thickness": found["thickness"],
        "speed": found["speed"],
        "energy": surface_energy(found["force"], found["ligament"], np.array(FOUR)[:, None]),
        "greenwood": by_theory("greenwood"),
        "inset_size": np.array(SIZES),
        "inset_thickness": b,
        "inset_energy": surface_energy(inset["force"], inset["ligament"], b),
        "inset_whole": surface_energy(inset["force"], 1.0, b),
        "inset_allowed": np.minimum(np.pi / 4 * b, 1 / K),
    }


def draw_3_9(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    curves(left, numbers, numbers["greenwood"], "Greenwood, Eq. 3.35")
    b = numbers["inset_thickness"]
    right.plot(b, numbers["inset_allowed"], "k-", label=r"$\min(\pi b/4a_0,\,1/k)$")
    for i, size in enumerate(numbers["inset_size"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        right.plot(b, numbers["inset_energy"][i], **style, label=f"$a$ = {size:g} $a_0$, ligament")
        filled = style | {"mfc": COLOURS[i], "ms": 3}
        right.plot(b, numbers["inset_whole"][i], **filled, label="with the whole contact")
    decades(right)
    right.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    right.set_xticks([2, 5, 10, 20, 30], ["2", "5", "10", "20", "30"])
    right.minorticks_off()
    right.set(xlabel="layer thickness $b/a_0$", ylabel=f"largest {ENERGY}, rate 100 $h_0/\\tau$")
    right.legend(fontsize=7.5, loc="lower right")


def curves(ax: Any, numbers: Numbers, theory: Numbers, words: str) -> None:
    """Draw simulated energies as markers and a theory dashed, a colour for each layer."""
    for i, b in enumerate(numbers["thickness"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        ax.plot(numbers["speed"][i], numbers["energy"][i], **style, label=f"$b$ = {b:g} $a_0$")
        ax.plot(theory["speed"], theory["energy"][i], "--", color=COLOURS[i])
    ax.plot([], [], "k--", label=words)
    ax.axhline(1 / K, color="0.5", lw=0.8)
    decades(ax, y=False)
    ax.set(ylim=(0, 11), xlabel=SPEED, ylabel=ENERGY)
    ax.legend()


def numbers_3_10(bench: Bench) -> Numbers:
    """Return the work [dg0] by thickness and rate, and that of the elastic layer."""
    found = bench.of("3.8")
    elastic = theory.crossover.work_of_separation(
        found["thickness"], half_width=HALF_WIDTH, work_of_adhesion=1.0, base=theory.Frictionless()
    )
    parts = ("thickness", "rate", "speed", "separation")
    return {name: found[name] for name in parts} | {"elastic": np.asarray(elastic)}


def draw_3_10(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2, sharey=True)
    for i, b in enumerate(numbers["thickness"]):
        style = {"color": COLOURS[i], "marker": MARKERS[i], "mfc": "none", "lw": 0.8}
        left.plot(
            numbers["speed"][i], numbers["separation"][i], **style, label=f"$b$ = {b:g} $a_0$"
        )
        right.plot(numbers["rate"], numbers["separation"][i], **style)
    for ax, words in ((left, SPEED), (right, r"retraction rate $r\,\tau/h_0$")):
        decades(ax, y=False)
        ax.set_xlabel(words)
        ax.axhline(1, color="0.5", lw=0.8)
    left.set(ylim=(0, None), ylabel=r"work of separation / $\Delta\gamma_0$")
    left.legend()


def numbers_A_1(bench: Bench) -> Numbers:
    """Return the energies simulated and by theory."""
    found = bench.of("3.9")
    some = {name: found[name] for name in ("thickness", "speed", "energy")}
    return some | {"persson_brener": by_theory("persson-brener")}


def draw_A_1(numbers: Numbers, figure: Figure) -> None:
    curves(figure.subplots(), numbers, numbers["persson_brener"], "Persson-Brener, Eq. (4)")
