"""Pull-off force of the lens from silicone rubber by speed, for three ranges of the forces.

Claims: linear theory with h0 = 30.8 nm follows the measured forces up to 100 um/s and is below
them beyond; a Gent-Schultz law with v0 = 213.5 um/s and xi = 0.4154 follows all of them.

Seen: The thesis's linear curve (solid) is that of a range of 200 nm, star by star. With 30.8 nm the
forces are half as large again. What was measured leaves linear theory at some 75 um/s.

Needs: the measured forces are not published; the printed fits stand for them: Gent-Schultz for
what was measured, and that over 1 + (v/v1)^(1/2) for (P_po)_lin, at the crack speed of Eq. 4.24
with l0 = 30.0 nm.

Costs: 27 simulations, four minutes of processor time; the short range takes most of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import viscotack as vt
from viscotack.theory import empirical, jkr, persson_brener, rate

from ..bench import Bench, Numbers
from .cases import (
    ALPHA,
    ALPHA_LJ,
    LENS,
    PDMS,
    PDMS_WORK,
    RANGES,
    TABOR,
    lens,
)
from .style import COLOURS, MARKERS, SIMULATED, decades, panels

SIZE = (13.5, 4.3)
NOTE = "The measured forces are not published: drawn from the printed Gent-Schultz fit."
SPEEDS = np.geomspace(1e-6, 1e-3, 9)
V0, XI, V1 = 213.5e-6, 0.4154, 1e-2
SHORT = RANGES["30.8 nm"]
# The length of the tip for 30.8 nm, the thesis's 30.0 nm.
TIP = float(
    persson_brener.crack_tip_length(
        contact_modulus=PDMS.contact_modulus,
        work_of_adhesion=PDMS_WORK,
        strength=PDMS_WORK / (ALPHA_LJ * SHORT),
        strength_ratio=ALPHA,
    )
)


def linear_theory(speed: Any, tip: float = TIP) -> dict[str, Any]:
    """Return crack speed [m/s] by Eq. 4.24 and energy [dg0] by Eq. 4.21 at speeds [m/s]."""
    reduced = rate.rate_in_tip_lengths(speed, time_unit=PDMS.tau0, tip_length=tip)
    v = np.asarray(rate.crack_speed(reduced, tabor=TABOR))
    return {
        "crack_speed": v * tip / PDMS.tau0,
        "energy": np.asarray(persson_brener.amplification(v, material=PDMS)),
    }


def measured(crack_speed: Any) -> Any:
    """Return the energy [dg0] of the printed fit to the measurements, Eq. 4.28."""
    return np.asarray(empirical.gent_schultz(crack_speed, reference_speed=V0, exponent=XI))


def of_the_thesis() -> dict[str, Any]:
    """Return forces [mN] by the printed fits: measured, linear, and by Eq. 4.24 and 4.21."""
    linear = linear_theory(SPEEDS)
    unit = 1e3 * float(jkr.pull_off_force(radius=LENS, work_of_adhesion=PDMS_WORK))
    force = unit * measured(linear["crack_speed"])
    return {
        "jkr": unit,
        "measured": force,
        "linear": force / (1 + np.sqrt(linear["crack_speed"] / V1)),
        "linear_crack_speed": linear["crack_speed"],
        "by_the_fit": unit * linear["energy"],
    }


def simulated(case: tuple[float, float]) -> dict[str, float]:
    """Return force [mN], its relative error and crack speed [m/s] of a speed and a range."""
    problem = lens(*case)
    result = vt.solve(problem, until="pull-off", accuracy=5e-3)
    found = vt.summary(result)
    return {
        "force": 1e3 * found["pull_off_force_N"],
        "error": (result.error_estimate or {})["force"],
        "crack_speed": found["crack_speed_at_pull_off_m_per_s"],
    }


def numbers(bench: Bench) -> Numbers:
    """Return forces [mN] by speed [m/s]: simulated, by the thesis's theory and its two fits."""
    cases = [(float(v), gap) for gap in RANGES.values() for v in SPEEDS]
    rows = list(bench.each(simulated, cases))
    shape = (len(RANGES), len(SPEEDS))
    by_range = {name: np.array([row[name] for row in rows]).reshape(shape) for name in rows[0]}
    crack = np.geomspace(1e-6, 1e-1, 51)
    reduced = crack / TIP * PDMS.tau0
    return {
        "speed": SPEEDS,
        "range": list(RANGES),
        "tabor": np.array([lens(1e-6, gap).tabor for gap in RANGES.values()]),
        **by_range,
        **of_the_thesis(),
        "fitted_speed": crack,
        "fitted_energy": measured(crack),
        "linear_energy": np.asarray(persson_brener.amplification(reduced, material=PDMS)),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw forces by retraction speed, energies by crack speed, and measured over linear."""
    left, right, quotient = panels(figure, 1, 3)
    v = 1e6 * numbers["speed"]
    left.plot(v, numbers["measured"], "k-.", label="measured (printed fit)")
    left.plot(v, numbers["linear"], "k-", label="thesis, $(P_{po})_{lin}$")
    left.plot(v, numbers["by_the_fit"], "k:", label="Eq. 4.21 and 4.24")
    for i, name in enumerate(numbers["range"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        words = name.replace("um", "µm")
        label = rf"$h_0$ = {words}, $\mu$ = {numbers['tabor'][i]:.3g}"
        left.plot(v, numbers["force"][i], **style, label=label)
        energy = numbers["force"][i] / numbers["jkr"]
        right.plot(1e6 * numbers["crack_speed"][i], energy, **style)
    crack = 1e6 * numbers["fitted_speed"]
    right.plot(crack, numbers["fitted_energy"], "k-.", label="Gent-Schultz, Eq. 4.28")
    right.plot(crack, numbers["linear_energy"], "k-", label="Persson-Brener, $l_0$ = 30.0 nm")
    decades(left)
    decades(right)
    left.set_yticks([4, 6, 10, 20], ["4", "6", "10", "20"])
    right.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    for ax in (left, right):
        ax.minorticks_off()
    left.set_xlabel("retraction speed [µm/s]")
    left.set_ylabel("pull-off force [mN]")
    right.set_xlabel("crack speed at pull-off [µm/s]")
    right.set_ylabel(r"energy or force ratio / $\Delta\gamma_0$, $P_{JKR}$")
    left.legend()
    right.legend()
    axis = 1e6 * numbers["linear_crack_speed"]
    for i, name in enumerate(numbers["range"]):
        style = SIMULATED | {"color": COLOURS[i], "marker": MARKERS[i]}
        label = rf"simulated, $h_0$ = {name.replace('um', 'µm')}"
        quotient.plot(axis, numbers["measured"] / numbers["force"][i], **style, label=label)
    printed = 1 + np.sqrt(numbers["linear_crack_speed"] / V1)
    quotient.plot(axis, printed, "k-", label="printed, $1+(v/v_1)^{1/2}$")
    decades(quotient, y=False)
    quotient.axhline(1, color="0.5", lw=0.8)
    quotient.set_xlabel("crack speed by Eq. 4.24 [µm/s]")
    quotient.set_ylabel("measured over linear")
    quotient.legend()
