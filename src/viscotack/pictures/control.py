"""Figure of a force table and of a controlled release."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.control import ForceTable, Released

from .plot import axis_unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = Path(__file__).with_name("viscotack.mplstyle")
# Most speeds whose curves are drawn.
_CURVES = 7


def draw_control(table: ForceTable, released: Released | None = None) -> "Figure":
    """Draw forces by depth at some speeds of a table, and a release by time.

    Parameters
    ----------
    table : ForceTable
        The table.
    released : Released, optional
        A release on a simulated rig.

    Returns
    -------
    matplotlib.figure.Figure
        Left the forces, compression positive, and the path of the release; right force and speed
        of the drive by time.
    """
    import matplotlib as mpl
    import matplotlib.style
    from matplotlib.figure import Figure

    with matplotlib.style.context(_STYLE):
        count = 1 if released is None else 2
        figure = Figure(figsize=(5.4 * count, 4.4), layout="constrained")
        axes = figure.subplots(1, count, squeeze=False)[0]
        N, newton = axis_unit(float(table.pull_off_force.max()), "N")
        m, metre = axis_unit(float(table.travel.max()), "m")
        some = np.unique(np.linspace(0, len(table.speed) - 1, _CURVES).round().astype(int))
        colours = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(some)))
        for i, colour in zip(some, colours, strict=True):
            travel = np.interp(table.share, [0, 1, 2, 3], [0.0, *table.travel[i]])
            speed, unit = axis_unit(float(table.speed[i]), "m/s")
            label = f"{table.speed[i] / speed:.3g} {unit}"
            axes[0].plot(travel / m, table.force[i] / N, color=colour, lw=1, label=label)
        axes[0].axhline(0, color="0.6", lw=0.6)
        axes[0].set_xlabel(f"travel of the indenter [{metre}]")
        axes[0].set_ylabel(f"force [{newton}]")
        if released is not None:
            gone = table.start_depth - released.depth
            axes[0].plot(gone / m, released.force / N, color="#d94801", lw=2, label="release")
            _draw_ticks(axes[1], released, N, newton)
        axes[0].legend(fontsize="x-small", handlelength=1.2, title="speed", title_fontsize="small")
    return figure


def _draw_ticks(axes, released: Released, N: float, newton: str) -> None:  # noqa: ANN001
    """Draw force and speed of the drive by time."""
    s, second = axis_unit(float(released.time.max()), "s")
    pull = -released.drive_speed
    v, speed = axis_unit(float(np.abs(pull).max()), "m/s")
    axes.plot(released.time / s, released.force / N, color="#d94801", label="force")
    axes.axhline(-released.wanted / N, color="0.4", ls=":", lw=1, label="wanted")
    axes.set_xlabel(f"time [{second}]")
    axes.set_ylabel(f"force [{newton}]")
    axes.legend(loc="best", fontsize="small")
    other = axes.twinx()
    other.grid(False)
    other.step(released.time / s, pull / v, where="post", color="#08519c", lw=1)
    other.set_ylabel(f"speed of the drive, away [{speed}]", color="#08519c")
