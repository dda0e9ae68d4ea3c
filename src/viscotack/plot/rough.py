"""Figure and film of a pull on a rough surface: force curve, contact and gap."""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole
from viscotack.simulate.rough.result import FieldMap, RoughResult

from .style import BLUE, ORANGE, drawing, label_in_si, said, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colorbar import Colorbar
    from matplotlib.figure import Figure

# Frames of a film in a second, and dots per inch.
_PER_SECOND, _DPI = 12, 80


def draw_rough(found: RoughResult) -> "Figure":
    """Draw force and contact by depth, and the pressure over the map at the largest tension.

    Parameters
    ----------
    found : RoughResult
        Result of :func:`viscotack.simulate.rough.pull`.

    Returns
    -------
    matplotlib.figure.Figure
        Left the force, compression positive, with the share of the map in contact; right the
        pressure at pull-off, tension in blue, compression in red.
    """
    figure, show = _figure(found)
    show(found.strongest)
    return figure


def film_of_pull(found: RoughResult, target: Target) -> None:
    """Write the detachment as a GIF film: the pressure over the map beside the force curve.

    Parameters
    ----------
    found : RoughResult
        With two maps or more; :func:`viscotack.simulate.rough.pull` makes them if asked.
    target : path or binary file
        Where to write.

    Raises
    ------
    ValueError
        If the result has fewer than two maps.
    """
    from matplotlib.animation import PillowWriter

    if len(found.maps) < 2:
        raise InputError("a film needs maps of several instants; ask for at least 2")
    writer = PillowWriter(fps=_PER_SECOND)
    with style(), tempfile.TemporaryDirectory() as folder:
        path, (figure, show) = Path(folder) / "film.gif", _figure(found)
        with writer.saving(figure, str(path), _DPI):
            for each in found.maps:
                show(each)
                writer.grab_frame()
        write_whole(target, path.read_bytes())


def _label_map(axes: "Axes", bar: "Colorbar", words: str, unit: str) -> None:
    """Label the sides of a map and its colours."""
    label_in_si(axes.xaxis, "x", "m")
    label_in_si(axes.yaxis, "y", "m")
    label_in_si(bar.ax.yaxis, words, unit)


def _figure(found: RoughResult) -> tuple["Figure", Callable[[FieldMap], None]]:
    """Return the figure, and a function that shows a map in it."""
    rows, columns = found.strongest.pressure.shape
    with drawing(10.0, 4.4) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1))
        left.axhline(0, color="0.6", lw=0.8)
        left.plot(found.depth, found.force, color=BLUE)
        (mark,) = left.plot([], [], "o", color=ORANGE, zorder=3)
        share = left.twinx()
        part = 100 * found.area / found.nominal_area
        share.plot(found.depth, part, color="0.55", lw=1.0, ls="--")
        share.set_ylabel("map in contact [%], dashed")
        share.set_ylim(0, None)
        share.grid(False)
        label_in_si(left.xaxis, "depth", "m")
        label_in_si(left.yaxis, "force", "N")
        left.set_title(f"pull-off force {said(found.pull_off_force, 'N')}")
        most = float(np.quantile(np.abs(found.strongest.pressure), 0.999))
        extent = (0, columns * found.pixel, 0, rows * found.pixel)
        colours = {"cmap": "RdBu_r", "vmin": -most, "vmax": most, "interpolation": "nearest"}
        image = right.imshow(found.strongest.pressure, extent=extent, **colours)
        right.grid(False)
        right.set_title("pressure at the point")
        _label_map(right, figure.colorbar(image, ax=right), "pressure", "Pa")

    def show(shown: FieldMap) -> None:
        image.set_data(shown.pressure)
        mark.set_data([shown.depth], [shown.force])

    return figure, show
