"""Hertz and JKR pressed to the same depth: surface and pressure.

Claims: adhesion makes the contact larger at the same depth and lets its edge pull.

Seen: At a depth of 2 the adhesive contact is 1.4 times as wide as that of Hertz and carries 30 %
less. Its surface leaves the sphere upright, and its pressure turns into a tension without bound at
the edge: the crack that the rest of the thesis moves.

Needs: nothing.

Costs: milliseconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import hertz, jkr

from ..bench import Bench, Numbers
from .style import COLOURS, panels

SIZE = (9.0, 3.8)
# With these the units of Eq. 4.16 are 1: lengths along the surface, depths, forces in pi R dg0.
UNIT = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1 / np.pi}
BODIES = {"radius": 1.0, "contact_modulus": 1.0}
_DEPTH = 2.0
# The pressure is drawn to this distance from the edge of JKR, where it is infinite.
_NEAR_EDGE = 2e-3


def numbers(bench: Bench) -> Numbers:
    """Return surfaces, pressures, radii and forces at one depth."""
    radius = {
        "hertz": float(hertz.contact_radius_at_depth(_DEPTH, radius=1.0)),
        "jkr": float(jkr.contact_radius_at_depth(_DEPTH, **UNIT)),
    }
    x = np.linspace(0, 2.6, 261)
    inside = {name: np.linspace(0, 1 - _NEAR_EDGE, 200) * a for name, a in radius.items()}
    a, b = radius["hertz"], radius["jkr"]
    return {
        "depth": _DEPTH,
        "radius": radius,
        "force": {
            "hertz": float(hertz.force(a, **BODIES)),
            "jkr": float(jkr.force(b, **UNIT)),
        },
        "position": x,
        "surface": {
            "hertz": hertz.surface_displacement(x, contact_radius=a, radius=1.0),
            "jkr": jkr.surface_displacement(x, contact_radius=b, **UNIT),
        },
        "sphere": _DEPTH - x**2 / 2,
        "inside": inside,
        "pressure": {
            "hertz": hertz.pressure(inside["hertz"], contact_radius=a, **BODIES),
            "jkr": jkr.pressure(inside["jkr"], contact_radius=b, **UNIT),
        },
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both surfaces below the sphere, and both pressures."""
    left, right = panels(figure, 1, 2)
    left.plot(numbers["position"], -numbers["sphere"], color="0.6", label="sphere")
    for i, (name, word) in enumerate((("hertz", "Hertz"), ("jkr", "JKR"))):
        label = f"{word}, $a$ = {numbers['radius'][name]:.2f}"
        left.plot(numbers["position"], -numbers["surface"][name], color=COLOURS[i], label=label)
        label = rf"{word}, $P$ = {numbers['force'][name]:.2f} $\pi R\,\Delta\gamma_0$"
        right.plot(
            numbers["inside"][name], numbers["pressure"][name], color=COLOURS[i], label=label
        )
    left.set_ylim(-2.1, 1.0)
    left.set_ylabel(r"height / $(\pi^2 R\,\Delta\gamma_0^2/E^{*2})^{1/3}$")
    right.set_ylim(-2.0, 1.2)
    right.set_ylabel(r"pressure $p\,/\,(E^{*2}\pi\Delta\gamma_0/R)^{1/3}$")
    for ax in (left, right):
        ax.set_xlabel(r"position / $(\pi R^2\Delta\gamma_0/E^*)^{1/3}$")
        ax.axhline(0, color="0.5", lw=0.8)
    left.legend(loc="lower right")
    right.legend(loc="lower left")
