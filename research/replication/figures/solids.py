"""Creep, moduli and the gain of Persson and Brener of power-law solids."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import nnls

import viscotack as vt
from viscotack.theory import persson_brener

from ..bench import Bench, Numbers
from .cases import PDMS, K, solid
from .style import COLOURS, TIP_SPEED, colour, decades, panels, words

_EXPONENTS = (0.2, 0.4, 1.6)


def numbers_4_2(bench: Bench) -> Numbers:
    """Return E/E0 and C E0 by time [tau0]; the relaxation of both materials with the same n."""
    t = np.geomspace(1e-6, 1e3, 145)
    standard = solid()
    found: Numbers = {
        "time": t,
        "relaxation": {"0": standard.relaxation(t)},
        "creep": {"0": standard.creep(t)},
        "relaxation_of_the_creep": {},
    }
    for n in _EXPONENTS:
        by_retardation = solid(K, n)
        by_relaxation = vt.RelaxationPowerLaw(
            rubbery_modulus=1.0, glassy_modulus=1 / K, exponent=n, tau0=1.0, poisson_ratio=0.0
        )
        found["creep"][f"{n:g}"] = by_retardation.creep(t)
        found["relaxation"][f"{n:g}"] = by_relaxation.relaxation(t)
        found["relaxation_of_the_creep"][f"{n:g}"] = by_retardation.relaxation(t)
    return found


def draw_4_2(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    for ax, name in ((left, "relaxation"), (right, "creep")):
        for n, of in numbers[name].items():
            style = "-" if float(n) else "--"
            ax.plot(numbers["time"], of, style, color=colour(float(n)), label=words(float(n)))
        ax.set(xscale="log", xlabel=r"time / $\tau_0$")
    for n, of in numbers["relaxation_of_the_creep"].items():
        left.plot(numbers["time"], of, ":", color=colour(float(n)))
    left.plot([], [], "k:", label="relaxation of the solids in (b)")
    right.set_ylabel("creep $C E_0$")
    left.set_ylabel("relaxation $R/E_0$")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)


_ARMS = 18


def numbers_4_8(bench: Bench) -> Numbers:
    """Return storage and loss modulus [Pa] by frequency [Hz], of the fit and of its 18 arms."""
    f = np.geomspace(1e-2, 1e16, 181)
    w = 2 * np.pi * f
    modulus: Any = PDMS.complex_modulus(w)
    times = np.geomspace(1e-16, 10.0, _ARMS)
    i_w_t = 1j * w[:, None] * times
    arms = i_w_t / (1 + i_w_t)
    size = np.abs(modulus)
    # parts of the modulus, both of them beside its size, as rheologists look at it
    system = np.concatenate([arms.real, arms.imag]) / np.concatenate([size, size])[:, None]
    aim = modulus - PDMS.rubbery_modulus
    weights, _ = nnls(system, np.concatenate([aim.real, aim.imag]) / np.concatenate([size, size]))
    of_arms = PDMS.rubbery_modulus + arms @ weights
    return {
        "frequency": f,
        "storage": modulus.real,
        "loss": modulus.imag,
        "arms_storage": of_arms.real,
        "arms_loss": of_arms.imag,
    }


def draw_4_8(numbers: Numbers, figure: Figure) -> None:
    axes = panels(figure, 1, 3)
    f = numbers["frequency"]
    for i, (name, word) in enumerate((("storage", "E'"), ("loss", "E''"))):
        ax, of_arms = axes[i], numbers[f"arms_{name}"]
        ax.plot(f, numbers[name], color=COLOURS[0], label="power law, Eq. 4.27")
        ax.plot(f, of_arms, "--", color=COLOURS[1], label="18 arms fitted to it")
        decades(ax)
        ax.set_ylabel(f"${word}$ [Pa]")
        off = 100 * (of_arms / numbers[name] - 1)
        axes[2].plot(f, off, ("-", ":")[i], color=COLOURS[i], label=f"${word}$")
    axes[2].set(xscale="log", ylim=(-60, 60), ylabel="18 arms over the power law - 1 [%]")
    axes[0].legend()
    axes[2].legend()
    for ax in axes:
        ax.set_xlabel("frequency [Hz], 20 °C")


EXPONENTS = (0.2, 0.4, 0.6, 0.8, 1.2, 1.6)
# Between the two: the gain is a power of the speed over a decade or more only if k is small.
_SMALL = 1e-4


def numbers_A_3(bench: Bench) -> Numbers:
    """Return the gain by speed, exact and fitted coefficients, and the steepest slopes beyond 1."""
    v = np.geomspace(1e-5, 1e6, 111)
    gain = {
        n: np.asarray(persson_brener.amplification(v, material=solid(K, n))) - 1 for n in EXPONENTS
    }
    n = np.array(EXPONENTS)
    slopes = []
    for each in EXPONENTS:
        far = np.geomspace(1, 1e3, 61)
        y = np.log(np.asarray(persson_brener.amplification(far, material=solid(_SMALL, each))) - 1)
        slopes.append(np.polyfit(np.log(far), y, 1)[0])
    return {
        "speed": v,
        "exponent": n,
        "gain": np.array([gain[e] for e in EXPONENTS]),
        "q1_printed": -0.0125 + 3.136 * n,
        "q1_exact": np.pi * n * (1 - K),
        "q1_exact_small_k": np.pi * n,
        "m2_fitted_small_k": np.array(slopes),
        "m2_limit": np.asarray(persson_brener.intermediate_exponent(n)),
    }


def draw_A_3(numbers: Numbers, figure: Figure) -> None:
    left, right = panels(figure, 1, 2)
    v = numbers["speed"]
    for i, n in enumerate(numbers["exponent"]):
        left.plot(v, numbers["gain"][i], color=COLOURS[i], label=f"$n$ = {n:g}")
        slow = v < 1
        left.plot(v[slow], numbers["q1_exact"][i] * v[slow], ":", color=COLOURS[i])
    left.plot([], [], "k:", label=r"$\pi n(1-k)\,\hat v$")
    decades(left)
    left.set(ylim=(1e-6, 20), xlabel=TIP_SPEED, ylabel=r"$\Gamma - 1$, $k$ = 0.1")
    left.legend()
    n = numbers["exponent"]
    right.plot(n, numbers["q1_printed"], "s", mfc="none", color=COLOURS[0], label="$q_1$ printed")
    right.plot(n, numbers["q1_exact_small_k"], "-", color=COLOURS[0], label=r"$\pi n$")
    right.plot(n, numbers["q1_exact"], "--", color=COLOURS[0], label=r"$\pi n(1-k)$, $k$ = 0.1")
    right.plot(
        n,
        10 * numbers["m2_fitted_small_k"],
        "o",
        mfc="none",
        color=COLOURS[1],
        label="10 $m_2$, $k$ = $10^{-4}$, $v$ = 1 to $10^3$",
    )
    right.plot(n, 10 * numbers["m2_limit"], "-", color=COLOURS[1], label=r"10 $n/(1+n)$ or 5")
    right.set(xlabel="exponent $n$", ylabel="$q_1$, 10 $m_2$")
    right.legend()
