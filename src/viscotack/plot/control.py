"""Figure of a force table and of a controlled release."""

from typing import TYPE_CHECKING

import numpy as np

from viscotack.design.control import ForceTable, Released

from .style import BLUE, ORANGE, drawing, label_in_si, said

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

    count = 1 if released is None else 2
    with drawing(5.4 * count, 4.4) as figure:
        axes = figure.subplots(1, count, squeeze=False)[0]
        some = np.unique(np.linspace(0, len(table.speed) - 1, _CURVES).round().astype(int))
        colours = colormaps["viridis"](np.linspace(0, 0.9, len(some)))
        for i, colour in zip(some, colours, strict=True):
            travel = np.interp(table.share, [0, 1, 2, 3], [0.0, *table.travel[i]])
            label = said(float(table.speed[i]), "m/s")
            axes[0].plot(travel, table.force[i], color=colour, lw=1, label=label)
        axes[0].axhline(0, color="0.6", lw=0.6)
        if released is not None:
            gone = table.start_depth - released.depth
            axes[0].plot(gone, released.force, color=ORANGE, lw=2, label="release")
            _draw_ticks(axes[1], released)
        label_in_si(axes[0].xaxis, "travel of the indenter", "m")
        label_in_si(axes[0].yaxis, "force", "N")
        axes[0].legend(fontsize="x-small", handlelength=1.2, title="speed", title_fontsize="small")
    return figure


def _draw_ticks(axes: "Axes", released: Released) -> None:
    """Draw force and speed of the drive by time."""
    axes.plot(released.time, released.force, color=ORANGE, label="force")
    axes.axhline(-released.wanted, color="0.4", ls=":", lw=1, label="wanted")
    axes.legend(loc="best", fontsize="small")
    other = axes.twinx()
    other.grid(False)
    other.step(released.time, -released.drive_speed, where="post", color=BLUE, lw=1)
    other.yaxis.label.set_color(BLUE)
    label_in_si(axes.xaxis, "time", "s")
    label_in_si(axes.yaxis, "force", "N")
    label_in_si(other.yaxis, "speed of the drive, away", "m/s")
