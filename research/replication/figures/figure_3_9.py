"""Effective surface energy of four layers by crack speed, beside Greenwood limited by size.

Claims: it rises to 1/k, or to (pi/4) b/a0 where that is less (Eq. 3.31); Greenwood's theory with
that limit (Eq. 3.35) is in fairly good agreement.

Seen: Energies follow Greenwood's curves up to where the size ends them; the layer of 13 a0, close
to b0/k, stays a fifth below. On the right the bound is met if the whole contact is counted (dots),
and passed with the ligament of Eq. 3.30.

Needs: the simulations of Fig. 3.8.

Costs: 48 simulations for the inset, half a minute of processor time.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import punch as theory

from ..bench import Bench, Numbers
from .cases import FOUR, K, Work, punch, solid, table
from .figure_3_3 import PAD
from .figure_3_8 import SPEED
from .style import COLOURS, ENERGY, MARKERS, SIMULATED, decades, panels

SIZE = (9.5, 4.0)
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
        theory.rate.amplification(
            speed / A0_OVER_H0, law, largest=theory.rate.largest_amplification(b, PAD)
        )
        for b in FOUR
    ]
    return {"speed": speed, "energy": np.array(energies)}


def numbers(bench: Bench) -> Numbers:
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


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the energies by speed, and the largest of them by thickness."""
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
    right.set_xlabel("layer thickness $b/a_0$")
    right.set_ylabel(f"largest {ENERGY}, rate 100 $h_0/\\tau$")
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
    ax.set_ylim(0, 11)
    ax.set_xlabel(SPEED)
    ax.set_ylabel(ENERGY)
    ax.legend()
