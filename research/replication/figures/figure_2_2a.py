"""Adhesion map of elastic spheres: which theory gives the contact radius at a load, and where.

Claims: under large loads Hertz is enough, towards small Tabor numbers Bradley and DMT, towards
large ones JKR; between them a cohesive zone is needed.

Seen: From loads of ten (rigid) to three hundred (JKR) Hertz is enough. Below them the Tabor number
decides: rigid below 0.02, DMT up to 0.07, JKR from 1.6, a cohesive zone between. DMT reaches larger
Tabor numbers under larger loads.

Needs: nothing. The thesis adapts the map of Johnson and Greenwood (1997,
doi:10.1006/jcis.1997.4984). Here a theory holds where its contact radius is within 5 % of that of
Maugis and Dugdale; Bradley's spheres are rigid where the approach by DMT-M is below 5 % of h0.

Costs: seconds.
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from viscotack.theory import dmt, hertz, jkr, maugis

from ..bench import Bench, Numbers
from .figure_2_2b import BODIES, UNIT, strength
from .style import COLOURS

SIZE = (6.8, 4.6)
WITHIN = 0.05
# In the order in which they are named where several hold.
THEORIES = ("Hertz", "Bradley", "JKR", "DMT", "Maugis")
_LOADS = np.logspace(-2, 4, 91)
_TABORS = np.logspace(-3, 2, 91)


def of_maugis(tabor: float, loads: np.ndarray) -> np.ndarray:
    """Return contact radii of Maugis and Dugdale at compressive loads [pi R dg0]."""
    m = 1 + np.exp(np.linspace(-22, 14, 4001))
    state = maugis.curve(m, **UNIT, strength=strength(tabor))
    force, radius = np.asarray(state.force) / np.pi, np.asarray(state.contact_radius)
    # from the largest contact to the pull-off
    stable = slice(int(np.argmin(force)), None, -1)
    known = np.arcsinh(force[stable]), np.log(radius[stable])
    return np.exp(np.interp(np.arcsinh(loads), *known, left=np.nan, right=np.nan))


def numbers(bench: Bench) -> Numbers:
    """Return the index of the simplest theory that holds, by load and Tabor number."""
    loads = np.pi * _LOADS
    radii = {
        "Hertz": hertz.contact_radius_at_force(loads, **BODIES),
        "DMT": dmt.contact_radius_at_force(loads, **UNIT),
        "JKR": jkr.contact_radius_at_force(loads, **UNIT),
    }
    approach = np.asarray(dmt.depth(radii["DMT"], radius=1.0))
    index = np.empty((len(_TABORS), len(_LOADS)), dtype=int)
    for i, tabor in enumerate(_TABORS):
        found = of_maugis(float(tabor), _LOADS)
        holds = {name: np.abs(a / found - 1) < WITHIN for name, a in radii.items()}
        # h0 = R^(1/3) (dg0/E*)^(2/3)/mu is 1/mu in these units
        holds |= {"Bradley": approach < WITHIN / tabor, "Maugis": np.isfinite(found)}
        index[i] = np.argmax([holds[name] for name in THEORIES], axis=0)
    return {"tabor": _TABORS, "load": _LOADS, "index": index}


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the regions."""
    ax = figure.subplots()
    pale = ListedColormap(["0.88", COLOURS[0], COLOURS[2], COLOURS[1], COLOURS[3]])
    ax.pcolormesh(
        numbers["tabor"],
        numbers["load"],
        numbers["index"].T,
        cmap=pale,
        vmin=-0.5,
        vmax=len(THEORIES) - 0.5,
        alpha=0.5,
        linewidth=0,
        rasterized=True,
    )
    at = {
        "Hertz": (0.3, 1e3),
        "Bradley": (3e-3, 0.1),
        "DMT": (0.05, 0.6),
        "Maugis": (0.6, 0.3),
        "JKR": (20, 0.3),
    }
    for name, place in at.items():
        ax.text(place[0], place[1], name, ha="center", va="center")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel(r"Tabor number $\mu$")
    ax.set_ylabel(r"load / $\pi R\,\Delta\gamma_0$")
