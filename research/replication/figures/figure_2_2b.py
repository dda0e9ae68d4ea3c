"""Force by depth from Hertz to JKR: Maugis-Dugdale for five Tabor numbers.

Claims: the passage from DMT to JKR is continuous; a small Tabor number follows DMT-M, a large one
JKR.

Seen: At a Tabor number of 5 Maugis cannot be told from JKR, loop included; at 0.01 the force stays
at that of rigid bodies outside the contact. Between them the loop opens, and the jump goes.

Needs: nothing.

Costs: milliseconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from viscotack.theory import dmt, hertz, jkr, maugis

from ..bench import Bench, Numbers
from .style import COLOURS, panels

TABORS = (0.01, 0.1, 0.5, 1.0, 5.0)
# With these the units of Eq. 2.6 are 1, but for the pi of its force.
UNIT = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
BODIES = {"radius": 1.0, "contact_modulus": 1.0}
SIZE = (7.5, 4.2)
_LARGEST_DEPTH = 2.5


def strength(tabor: float) -> float:
    """Return the strength of the Dugdale contact with the peak of a Lennard-Jones one."""
    parameter = float(maugis.parameter_from_tabor(tabor))
    return parameter / float(maugis.maugis_parameter(strength=1.0, **UNIT))


def numbers(bench: Bench) -> Numbers:
    """Return curves of force [pi R dg0] by depth [Eq. 2.6]."""
    a = np.linspace(1e-3, 2.2, 300)
    touching = np.linspace(0, np.sqrt(_LARGEST_DEPTH), 120)
    curves = {
        "JKR": (jkr.depth(a, **UNIT), jkr.force(a, **UNIT)),
        "DMT-M": (dmt.depth(touching, radius=1.0), dmt.force(touching, **UNIT)),
        "Hertz": (hertz.depth(touching, radius=1.0), hertz.force(touching, **BODIES)),
    }
    for tabor in TABORS:
        case = UNIT | {"strength": strength(tabor)}
        touch = maugis.curve(1 + np.exp(np.linspace(-16, 12, 300)), **case)
        apart = np.linspace(0, 1, 60)[::-1] * maugis.touching_radius(**case)
        free = maugis.curve_without_contact(apart, **case)
        depth = np.concatenate([touch.depth, free.depth])
        force = np.concatenate([touch.force, free.force])
        # far away and deep inside there is nothing to see
        shown = (depth < _LARGEST_DEPTH) & (depth > -4)
        curves[f"Maugis {tabor:g}"] = (depth[shown], force[shown])
    return {
        name: {"depth": np.asarray(depth), "force": np.asarray(force) / np.pi}
        for name, (depth, force) in curves.items()
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw all of them."""
    (ax,) = panels(figure, 1, 1)
    styles = {"JKR": ("k", "-"), "DMT-M": ("k", ":"), "Hertz": ("k", "--")}
    for i, (name, of) in enumerate(numbers.items()):
        colour, style = styles.get(name, (COLOURS[(i - 3) % 6], "-"))
        label = name.replace("Maugis", r"Maugis, $\mu$ =")
        ax.plot(of["depth"], of["force"], style, color=colour, label=label)
    ax.set(xlim=(-3.2, 2.0), ylim=(-2.2, 1.2))
    ax.set_xlabel(r"depth $\delta\,(E^*R/\Delta\gamma_0)^{2/3}/R$")
    ax.set_ylabel(r"force / $\pi R\,\Delta\gamma_0$")
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
