"""Figure of the energy at a simulated contact edge, compared with the steady-crack model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.result.edge_energy import EdgeEnergy

from .plot import plain_ticks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")


def draw_edge_energy(found: EdgeEnergy, unit: str) -> Figure:
    """Draw the energy at the edge against its speed: simulation, steady crack and fit.

    Parameters
    ----------
    found : EdgeEnergy
        Energies evaluated from a simulation.
    unit : str
        Unit of the speeds.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.style
    from matplotlib.figure import Figure

    order = np.argsort(found.speed)
    speed = found.speed[order]
    fitted = 1 + (speed / found.reference_speed) ** found.exponent
    with matplotlib.style.context(_STYLE):
        figure = Figure()
        axes = figure.subplots()
        place = {"mfc": "none", "markevery": 0.04}
        axes.loglog(speed, found.amplification[order], "o", label="simulation", **place)
        axes.loglog(speed, found.bulk[order], "-", label="bulk, steady-crack model")
        axes.loglog(speed, fitted, "--", color="0.3", label="Gent and Schultz, fitted")
        plain_ticks(axes.xaxis)
        plain_ticks(axes.yaxis)
        axes.set_xlabel(f"speed of the edge [{unit}]")
        axes.set_ylabel(r"energy at the edge / $\Delta\gamma_0$")
        axes.legend()
    return figure
