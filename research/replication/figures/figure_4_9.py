"""Force by contact radius of the lens at 0.98 um/s: three ranges of the forces, and elastic laws.

Claims: the curve is quasi-static; Carpick's fit of it gives dg0 = 0.152 J/m2 and mu = 2.05.

Seen: With 1.55 um the curve is the elastic one, and Carpick's fit reads its Tabor number. With the
ranges that the rate series asks for the curve at the same speed lies lower and is read as JKR.

Needs: the measured curve is not published. Drawn are the printed values (Maugis-Dugdale at mu =
2.05) and simulations of the rubber of Eq. 4.27 at that speed with h0 of 30.8 nm, 200 nm and
1.55 um. A Carpick fit to each simulated curve says what Tabor number the thesis would have read.

Costs: three simulations, half a minute.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import least_squares

import viscotack as vt
from viscotack.theory import jkr, maugis, transition

from ..bench import Bench, Numbers
from .cases import LENS, PDMS, PDMS_WORK, RANGES, curve, lens
from .style import COLOURS, panels

SIZE = (6.6, 4.4)
NOTE = "The measured curve is not published: elastic lines from the printed fit."
SPEED = 0.98e-6
_ELASTIC = {"radius": LENS, "contact_modulus": PDMS.contact_modulus, "work_of_adhesion": PDMS_WORK}


def numbers(bench: Bench) -> Numbers:
    """Return force [mN] by radius [mm] of each range, of JKR, and of Maugis at mu = 2.05."""
    a = np.geomspace(0.02e-3, 0.45e-3, 120)
    found: Numbers = {
        "jkr": {"radius": 1e3 * a, "force": 1e3 * np.asarray(jkr.force(a, **_ELASTIC))},
        "maugis": _maugis(),
        "simulated": dict(zip(RANGES, bench.each(retracted, RANGES.values()), strict=True)),
    }
    return found


def _maugis() -> Numbers:
    parameter = float(maugis.parameter_from_tabor(2.05))
    strength = parameter / float(maugis.maugis_parameter(strength=1.0, **_ELASTIC))
    of = maugis.curve(1 + np.exp(np.linspace(-12, 4, 200)), strength=strength, **_ELASTIC)
    return {"radius": 1e3 * np.asarray(of.contact_radius), "force": 1e3 * np.asarray(of.force)}


def retracted(gap: float) -> dict[str, Any]:
    """Return the retraction of the lens at 0.98 um/s, and Carpick's fit of it."""
    problem = lens(SPEED, gap)
    result = vt.solve(problem, until="pull-off", accuracy=5e-3, estimate_error=False)
    scales = problem.scales()
    radius, force = _in_si(result, scales)
    relaxed = vt.solve(
        lens(SPEED, gap, material=vt.Elastic(rubbery_modulus=1.458e6, poisson_ratio=0.5)),
        until="pull-off",
        accuracy=5e-3,
        estimate_error=False,
    )
    return {
        "radius": 1e3 * radius,
        "force": 1e3 * force,
        "tabor": problem.tabor,
        "pull_off_force": 1e3 * scales.force * vt.pull_off_force(result),
        "elastic_pull_off_force": 1e3 * scales.force * vt.pull_off_force(relaxed),
        "carpick": carpick(radius, force),
        "elastic_carpick": carpick(*_in_si(relaxed, scales)),
    }


def _in_si(result: vt.Result, scales: vt.Scales) -> tuple[Any, Any]:
    of = curve(result, 60)
    # beyond the least force no dead load holds the contact, and Carpick's law has nothing to say
    held = slice(int(np.argmin(of["force"])) + 1)
    return scales.radius * of["contact_radius"][held], scales.force * of["force"][held]


def carpick(radius: Any, force: Any) -> dict[str, float]:
    """Return transition number, Tabor number and work of adhesion that Carpick's fit reads.

    Least squares of the radius by force with three free numbers: radius without load, pull-off
    force, transition number; then Maugis parameter and work by the usual fits.
    """
    known = np.isfinite(radius)
    radius, force = radius[known], force[known]
    pull = -float(np.min(force))

    def off(x: Any) -> Any:
        a0, excess, alpha = np.exp(x[0]), np.exp(x[1]), 0.975 / (1 + np.exp(-x[2]))
        fitted = transition.contact_radius(
            np.maximum(force, -pull * (1 + excess)),
            contact_radius_without_load=a0,
            pull_off_force=pull * (1 + excess),
            transition=alpha,
        )
        return np.asarray(fitted) / a0 - radius / a0

    at_rest = np.log(np.interp(0.0, force[::-1], radius[::-1]))
    # the least of several, for the sum of squares has more than one valley
    starts = [(at_rest, excess, x) for excess in (-9.0, -5.0) for x in (-1.0, 1.0, 3.0)]
    fits = [least_squares(off, start, max_nfev=2000) for start in starts]
    x = min(fits, key=lambda fit: fit.cost).x
    alpha = float(0.975 / (1 + np.exp(-x[2])))
    parameter = float(transition.maugis_parameter(alpha))
    unit = float(transition.pull_off_force(parameter, radius=LENS, work_of_adhesion=1.0))
    return {
        "transition": alpha,
        "tabor": parameter / float(maugis.parameter_from_tabor(1.0)),
        "work_of_adhesion": pull * (1 + float(np.exp(x[1]))) / unit,
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw the simulated curves and both elastic laws."""
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["jkr"]["radius"], numbers["jkr"]["force"], "k--", lw=1, label="JKR")
    maugis_ = numbers["maugis"]
    ax.plot(maugis_["radius"], maugis_["force"], "k-", lw=1, label=r"Maugis, $\mu$ = 2.05")
    for i, (name, of) in enumerate(numbers["simulated"].items()):
        read = f"read as {of['carpick']['tabor']:.2g}"
        label = rf"$h_0$ = {name.replace('um', 'µm')}, $\mu$ = {of['tabor']:.3g}; {read}"
        ax.plot(of["radius"], of["force"], color=COLOURS[i], label=label)
    ax.set(xlim=(0, 0.32), ylim=(-7.5, 4))
    ax.set_xlabel("contact radius [mm]")
    ax.set_ylabel("force [mN], 0.98 µm/s")
    ax.legend(loc="upper left")
