"""Complex modulus of silicone rubber by frequency: the power law and a series of arms.

Claims: four constants (Eq. 4.27) represent PDMS as fairly as a generalised Maxwell model of 18
arms, 37 constants.

Seen: The printed fit over eighteen decades, and eighteen arms fitted to it: 2 % in storage and 8 %
in loss. The measured modulus is not published.

Needs: the measured modulus is not published; the printed fit of Eq. 4.27 stands for it. The arms
here are fitted to that, so that panel (c) says how well 18 arms do, and nothing of the rubber.

Costs: a second.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import nnls

from ..bench import Bench, Numbers
from .cases import PDMS
from .style import COLOURS, decades, panels

SIZE = (10.5, 3.8)
NOTE = "The measured modulus is not published: drawn from the printed fit, Eq. 4.27."
_ARMS = 18


def numbers(bench: Bench) -> Numbers:
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
        "arms_used": int(np.sum(weights > 0)),
    }


def draw(numbers: Numbers, figure: Figure) -> None:
    """Draw both moduli, and how far the arms are from the power law."""
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
