"""Figure of a force table and of a controlled release."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.design.control import ForceTable, Released

from .style import BLUE, ORANGE, axis_unit, drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
    from matplotlib import colormaps

    N, newton = axis_unit(table.pull_off_force, "N")
    m, metre = axis_unit(table.travel, "m")
    count = 1 if released is None else 2
    with drawing(5.4 * count, 4.4) as figure:
        axes = figure.subplots(1, count, squeeze=False)[0]
        some = np.unique(np.linspace(0, len(table.speed) - 1, _CURVES).round().astype(int))
        colours = colormaps["viridis"](np.linspace(0, 0.9, len(some)))
        for i, colour in zip(some, colours, strict=True):
            travel = np.interp(table.share, [0, 1, 2, 3], [0.0, *table.travel[i]])
            speed, unit = axis_unit(table.speed[i], "m/s")
            label = f"{table.speed[i] / speed:.3g} {unit}"
            axes[0].plot(travel / m, table.force[i] / N, color=colour, lw=1, label=label)
        axes[0].axhline(0, color="0.6", lw=0.6)
        axes[0].set(xlabel=f"travel of the indenter [{metre}]", ylabel=f"force [{newton}]")
        if released is not None:
            gone = table.start_depth - released.depth
            axes[0].plot(gone / m, released.force / N, color=ORANGE, lw=2, label="release")
            _draw_ticks(axes[1], released, N, newton)
        axes[0].legend(fontsize="x-small", handlelength=1.2, title="speed", title_fontsize="small")
    return figure


def _draw_ticks(axes: "Axes", released: Released, N: float, newton: str) -> None:
    """Draw force and speed of the drive by time."""
    s, second = axis_unit(released.time, "s")
    v, speed = axis_unit(released.drive_speed, "m/s")
    axes.plot(released.time / s, released.force / N, color=ORANGE, label="force")
    axes.axhline(-released.wanted / N, color="0.4", ls=":", lw=1, label="wanted")
    axes.set(xlabel=f"time [{second}]", ylabel=f"force [{newton}]")
    axes.legend(loc="best", fontsize="small")
    other = axes.twinx()
    other.grid(False)
    other.step(released.time / s, -released.drive_speed / v, where="post", color=BLUE, lw=1)
    other.set_ylabel(f"speed of the drive, away [{speed}]", color=BLUE)
