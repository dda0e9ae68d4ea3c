"""The glass lens on silicone rubber: quasi-static, by speed, and what the curves are."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

import viscotack as vt
from viscotack.theory import jkr, maugis, persson_brener, rate, transition
from viscotack.theory.crack.law import gent_schultz

from ..bench import Bench, Numbers
from .cases import ALPHA, ALPHA_LJ, LENS, PDMS, PDMS_WORK, PRELOAD, RANGES, TABOR, curve, lens
from .elastic import strength
from .style import COLOURS, MARKERS, SIMULATED, decades, panels

SPEED = 0.98e-6
_ELASTIC = {"radius": LENS, "contact_modulus": PDMS.contact_modulus, "work_of_adhesion": PDMS_WORK}


def numbers_4_9(bench: Bench) -> Numbers:
    """Return force [mN] by radius [mm] of each range, of JKR, and of Maugis at mu = 2.05."""
    a = np.geomspace(0.02e-3, 0.45e-3, 120)
    m = 1 + np.exp(np.linspace(-12, 4, 200))
    of = maugis.curve(m, strength=strength(2.05, _ELASTIC), **_ELASTIC)
    return {
        "jkr": {"radius": 1e3 * a, "force": 1e3 * np.asarray(jkr.force(a, **_ELASTIC))},
        "maugis": {
            "radius": 1e3 * np.asarray(of.contact_radius),
            "force": 1e3 * np.asarray(of.force),
        },
        "simulated": dict(zip(RANGES, bench.each(retracted, RANGES.values()), strict=True)),
    }


def retracted(gap: float) -> dict[str, Any]:
    """Return the retraction of the lens at 0.98 um/s, and Carpick's fit of it."""
    problem = lens(SPEED, gap)
    result = vt.solve(problem, until="pull-off", accuracy=5e-3, estimate_error=False)
    scales = problem.scales()
    of = curve(result, 60)
    # beyond the least force no dead load holds the contact, and Carpick's law has nothing to say
    held = slice(int(np.argmin(of["force"])) + 1)
    radius, force = scales.radius * of["contact_radius"][held], scales.force * of["force"][held]
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
    }


def carpick(radius: Any, force: Any) -> dict[str, float]:
    """Return Tabor number and work of adhesion that Carpick's fit reads.

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
    parameter = float(transition.maugis_parameter(float(0.975 / (1 + np.exp(-x[2])))))
    unit = float(transition.pull_off_force(parameter, radius=LENS, work_of_adhesion=1.0))
    return {
        "tabor": parameter / float(maugis.parameter_from_tabor(1.0)),
        "work_of_adhesion": pull * (1 + float(np.exp(x[1]))) / unit,
    }


def draw_4_9(numbers: Numbers, figure: Figure) -> None:
    (ax,) = panels(figure, 1, 1)
    ax.plot(numbers["jkr"]["radius"], numbers["jkr"]["force"], "k--", lw=1, label="JKR")
    maugis_ = numbers["maugis"]
    ax.plot(maugis_["radius"], maugis_["force"], "k-", lw=1, label=r"Maugis, $\mu$ = 2.05")
    for i, (name, of) in enumerate(numbers["simulated"].items()):
        read = f"read as {of['carpick']['tabor']:.2g}"
        label = rf"$h_0$ = {name.replace('um', 'µm')}, $\mu$ = {of['tabor']:.3g}; {read}"
        ax.plot(of["radius"], of["force"], color=COLOURS[i], label=label)
    ax.set(xlim=(0, 0.32), ylim=(-7.5, 4))
    ax.set(xlabel="contact radius [mm]", ylabel="force [mN], 0.98 µm/s")
    ax.legend(loc="upper left")


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
    return np.asarray(gent_schultz(crack_speed, reference_speed=V0, exponent=XI))


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


def numbers_4_10(bench: Bench) -> Numbers:
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


def draw_4_10(numbers: Numbers, figure: Figure) -> None:
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
    left.set(xlabel="retraction speed [µm/s]", ylabel="pull-off force [mN]")
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
    quotient.set(xlabel="crack speed by Eq. 4.24 [µm/s]", ylabel="measured over linear")
    quotient.legend()


# The Tabor number that the quasi-static test gave.
MEASURED_TABOR = 2.05
# Tabor number and unit of the rate [m] of each run; None where the range is also the unit.
RUNS: dict[str, tuple[float, float]] = {
    "Tabor 2.05, unit 30.8 nm": (MEASURED_TABOR, SHORT),
    "Tabor 2.05, unit 200 nm": (MEASURED_TABOR, RANGES["200 nm"]),
    "Tabor 3.24, unit 30.8 nm": (TABOR, SHORT),
    "Tabor 3.24, unit 200 nm": (TABOR, RANGES["200 nm"]),
    "Tabor 15.8, unit 30.8 nm": (lens(1e-6, RANGES["200 nm"]).tabor, SHORT),
}
# Critical over peak stress that theory is tried with: the thesis's two, and half and twice its own.
TIPS = {
    "alpha = pi/9": ALPHA,
    "alpha = 9 sqrt(3)/16": ALPHA_LJ,
    "alpha = pi/18": ALPHA / 2,
    "alpha = 2 pi/9": 2 * ALPHA,
}


def explained(case: tuple[float, float, float]) -> float:
    """Return the force [mN] at a speed [m/s], a Tabor number and a unit of the rate [m]."""
    speed, tabor, unit = case
    force = float(jkr.pull_off_force(radius=LENS, work_of_adhesion=PDMS_WORK))
    groups = vt.Groups(
        tabor=tabor,
        material=PDMS.reduced(),
        start=vt.AtForce(PRELOAD / force),
        rate=speed * PDMS.tau0 / unit,
    )
    return 1e3 * force * vt.pull_off_force(vt.solve(groups, until="pull-off", accuracy=5e-3))


def numbers_linear_curve(bench: Bench) -> Numbers:
    """Return forces [mN] by speed [m/s] of each explanation, and how far they are off."""
    thesis = of_the_thesis()
    cases = [(float(v), *run) for run in RUNS.values() for v in SPEEDS]
    forces = np.array(list(bench.each(explained, cases))).reshape(len(RUNS), len(SPEEDS))
    lens_at = bench.of("4.10")
    found = {f"range {name}": lens_at["force"][i] for i, name in enumerate(lens_at["range"])}
    found |= dict(zip(RUNS, forces, strict=True))
    for name, alpha in TIPS.items():
        energy = linear_theory(SPEEDS, TIP * (ALPHA / alpha) ** 2)["energy"]
        found[f"Eq. 4.21 and 4.24, {name}"] = thesis["jkr"] * energy
    off = np.array([force / thesis["linear"] - 1 for force in found.values()])
    return {
        "speed": SPEEDS,
        "linear": thesis["linear"],
        "explanation": list(found),
        "force": np.array(list(found.values())),
        "least": off.min(axis=1),
        "most": off.max(axis=1),
        "rms": np.sqrt(np.mean(off**2, axis=1)),
    }


def draw_linear_curve(numbers: Numbers, figure: Figure) -> None:
    ax = figure.subplots()
    v = 1e6 * numbers["speed"]
    best = np.argsort(numbers["rms"])[:6]
    for rank, i in enumerate(best):
        label = f"{numbers['explanation'][i]} ({100 * numbers['rms'][i]:.1f} % rms)"
        ax.plot(v, numbers["force"][i] / numbers["linear"], color=COLOURS[rank], label=label)
    ax.axhline(1.0, color="k", lw=0.8)
    decades(ax, y=False)
    ax.set(xlabel="retraction speed [um/s]", ylabel="force over the thesis's linear curve")
    ax.legend(fontsize=8)


_LENGTH = (np.pi * LENS**2 * PDMS_WORK / PDMS.contact_modulus) ** (1 / 3)
_HEIGHT = _LENGTH**2 / LENS
WIDE_SPEEDS = np.geomspace(1e-7, 1e-1, 49)
PRELOADS = {"1.5 mN": PRELOAD, "150 mN": 100 * PRELOAD}


def pull_off(speed: float, preload: float) -> float:
    r"""Return the pull-off force over that of JKR.

    Lengths in :math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`, heights in their square over R:

    .. math:: G = \frac{(a^2 - \delta)^2}{2a}, \quad
              \frac{da}{d\delta} = \frac{v_0}{r} (G - 1)^{1/\xi}, \quad
              P = \frac43 \left(a \delta - \frac{a^3}{3}\right)
    """
    at = float(jkr.contact_radius_at_force(preload, **_ELASTIC)) / _LENGTH
    start = at**2 - np.sqrt(2 * at)
    # the edge moves by one length in the time in which the drive moves by one height
    ratio = V0 / speed * _HEIGHT / _LENGTH

    def slope(travel: float, a: Any) -> Any:
        energy = (a**2 - start + travel) ** 2 / (2 * a)
        return -ratio * np.maximum(energy - 1, 0.0) ** (1 / XI)

    def gone(travel: float, a: Any) -> float:
        return float(a[0] - 0.02 * at)

    gone.terminal = True  # type: ignore[attr-defined]
    options = {"method": "LSODA", "rtol": 1e-8, "atol": 1e-10, "max_step": at / 40}
    path = solve_ivp(slope, (0.0, 500.0 * at), [at], events=gone, **options)
    a, depth = path.y[0], start - path.t
    return float(np.max(-4 / 3 * (a * depth - a**3 / 3)))


def numbers_gent_schultz(bench: Bench) -> Numbers:
    """Return force over JKR and its local exponent by speed [m/s] and preload."""
    found: Numbers = {"speed": WIDE_SPEEDS}
    for name, preload in PRELOADS.items():
        force = np.array([pull_off(float(v), preload) for v in WIDE_SPEEDS])
        found[name] = {"force": force, "exponent": np.gradient(np.log(force), np.log(WIDE_SPEEDS))}
    return found


def draw_gent_schultz(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    v = 1e6 * numbers["speed"]
    for i, name in enumerate(PRELOADS):
        style = {"color": COLOURS[i], "label": f"from {name}"}
        left.plot(v, numbers[name]["force"], **style)
        right.plot(v, numbers[name]["exponent"], **style)
    decades(left)
    decades(right, y=False)
    right.axhline(0.27, color="k", ls="--", lw=1, label="thesis, 0.27")
    right.axhline(3 * XI / (3 + XI), color="0.5", ls=":", lw=1, label=r"$3\xi/(3+\xi)$")
    right.axvspan(1, 1000, color="0.94", zorder=0)
    for ax in (left, right):
        ax.set_xlabel("retraction speed [µm/s]")
    left.set_ylabel("pull-off force over JKR")
    right.set_ylabel("local exponent")
    right.legend()
