"""Hertz, JKR, DMT and Maugis: contacts of elastic spheres."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from viscotack.theory import dmt, hertz, jkr, maugis

from ..bench import Bench, Numbers
from .style import COLOURS, panels

# With these the units of Eq. 4.16 are 1: lengths along the surface, depths, forces in pi R dg0.
UNIT = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1 / np.pi}
BODIES = {"radius": 1.0, "contact_modulus": 1.0}
_DEPTH = 2.0
# The pressure is drawn to this distance from the edge of JKR, where it is infinite.
_NEAR_EDGE = 2e-3


def numbers_2_1(bench: Bench) -> Numbers:
    """Return surfaces, pressures, radii and forces at one depth."""
    radius = {
        "hertz": float(hertz.contact_radius_at_depth(_DEPTH, radius=1.0)),
        "jkr": float(jkr.contact_radius_at_depth(_DEPTH, **UNIT)),
    }
    x = np.linspace(0, 2.6, 261)
    inside = {name: np.linspace(0, 1 - _NEAR_EDGE, 200) * a for name, a in radius.items()}
    a, b = radius["hertz"], radius["jkr"]
    return {
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


def draw_2_1(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    left.plot(numbers["position"], -numbers["sphere"], color="0.6", label="sphere")
    for i, (name, word) in enumerate((("hertz", "Hertz"), ("jkr", "JKR"))):
        label = f"{word}, $a$ = {numbers['radius'][name]:.2f}"
        left.plot(numbers["position"], -numbers["surface"][name], color=COLOURS[i], label=label)
        label = rf"{word}, $P$ = {numbers['force'][name]:.2f} $\pi R\,\Delta\gamma_0$"
        right.plot(
            numbers["inside"][name], numbers["pressure"][name], color=COLOURS[i], label=label
        )
    left.set(ylim=(-2.1, 1.0), ylabel=r"height / $(\pi^2 R\,\Delta\gamma_0^2/E^{*2})^{1/3}$")
    right.set(ylim=(-2.0, 1.2), ylabel=r"pressure $p\,/\,(E^{*2}\pi\Delta\gamma_0/R)^{1/3}$")
    for ax in (left, right):
        ax.set_xlabel(r"position / $(\pi R^2\Delta\gamma_0/E^*)^{1/3}$")
        ax.axhline(0, color="0.5", lw=0.8)
    left.legend(loc="lower right")
    right.legend(loc="lower left")


TABORS = (0.01, 0.1, 0.5, 1.0, 5.0)
# With these the units of Eq. 2.6 are 1, but for the pi of its force.
ONE = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
_LARGEST_DEPTH = 2.5


def strength(tabor: float, case: dict[str, float] = ONE) -> float:
    """Return the strength of the Dugdale contact with the peak of a Lennard-Jones one."""
    parameter = float(maugis.parameter_from_tabor(tabor))
    return parameter / float(maugis.maugis_parameter(strength=1.0, **case))


def numbers_2_2b(bench: Bench) -> Numbers:
    """Return curves of force [pi R dg0] by depth [Eq. 2.6]."""
    a = np.linspace(1e-3, 2.2, 300)
    touching = np.linspace(0, np.sqrt(_LARGEST_DEPTH), 120)
    curves = {
        "JKR": (jkr.depth(a, **ONE), jkr.force(a, **ONE)),
        "DMT-M": (dmt.depth(touching, radius=1.0), dmt.force(touching, **ONE)),
        "Hertz": (hertz.depth(touching, radius=1.0), hertz.force(touching, **BODIES)),
    }
    for tabor in TABORS:
        case = ONE | {"strength": strength(tabor)}
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


def draw_2_2b(numbers: Numbers, figure: Figure) -> None:
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


WITHIN = 0.05
# In the order in which they are named where several hold.
THEORIES = ("Hertz", "Bradley", "JKR", "DMT", "Maugis")
_LOADS = np.logspace(-2, 4, 91)
_TABORS = np.logspace(-3, 2, 91)


def of_maugis(tabor: float, loads: np.ndarray) -> np.ndarray:
    """Return contact radii of Maugis and Dugdale at compressive loads [pi R dg0]."""
    m = 1 + np.exp(np.linspace(-22, 14, 4001))
    state = maugis.curve(m, **ONE, strength=strength(tabor))
    force, radius = np.asarray(state.force) / np.pi, np.asarray(state.contact_radius)
    # from the largest contact to the pull-off
    stable = slice(int(np.argmin(force)), None, -1)
    known = np.arcsinh(force[stable]), np.log(radius[stable])
    return np.exp(np.interp(np.arcsinh(loads), *known, left=np.nan, right=np.nan))


def numbers_2_2a(bench: Bench) -> Numbers:
    """Return the index of the simplest theory that holds, by load and Tabor number."""
    loads = np.pi * _LOADS
    radii = {
        "Hertz": hertz.contact_radius_at_force(loads, **BODIES),
        "DMT": dmt.contact_radius_at_force(loads, **ONE),
        "JKR": jkr.contact_radius_at_force(loads, **ONE),
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


def draw_2_2a(numbers: Numbers, figure: Figure) -> None:
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
    ax.set(xscale="log", yscale="log", xlabel=r"Tabor number $\mu$")
    ax.set_ylabel(r"load / $\pi R\,\Delta\gamma_0$")
