"""Figure and film of a pull on a rough surface: force curve, contact and gap."""

import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole
from viscotack.simulate.rough.problem import RoughProblem
from viscotack.simulate.rough.result import FieldMap, RoughResult
from viscotack.simulate.rough.superposition import Superposition

from .style import BLUE, ORANGE, axis_unit, drawing, style

if TYPE_CHECKING:
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


def check_ffmpeg() -> None:
    """Raise InputError with a remedy if ffmpeg is missing."""
    from matplotlib.animation import FFMpegWriter

    if not FFMpegWriter.isAvailable():
        raise InputError(
            "an .mp4 film needs the program ffmpeg; install it (Debian: apt install ffmpeg, macOS: "
            "brew install ffmpeg, conda install ffmpeg), or write a .gif by --film"
        )


def film_of_pull(found: RoughResult, target: Target, ending: str = ".gif") -> None:
    """Write the detachment as a film: the pressure over the map beside the force curve.

    Parameters
    ----------
    found : RoughResult
        With two maps or more; :func:`viscotack.simulate.rough.pull` makes them if asked.
    target : path or binary file
        Where to write.
    ending : str
        ".gif", or ".mp4" for H.264 by the program ffmpeg.

    Raises
    ------
    ValueError
        If the result has fewer than two maps, or ffmpeg is missing or fails.
    """
    from matplotlib.animation import FFMpegWriter, PillowWriter

    if len(found.maps) < 2:
        raise InputError("a film needs maps of several instants; ask for at least 2")
    if ending == ".mp4":
        check_ffmpeg()
    writer = (FFMpegWriter if ending == ".mp4" else PillowWriter)(fps=_PER_SECOND)
    with style(), tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"film{ending}"
        figure, show = _figure(found)
        try:
            with writer.saving(figure, str(path), _DPI):
                for each in found.maps:
                    show(each)
                    writer.grab_frame()
        except subprocess.CalledProcessError as error:
            raise InputError(f"ffmpeg did not write the film: {error.stderr}") from None
        write_whole(target, path.read_bytes())


def draw_superposition(problem: RoughProblem, found: Superposition) -> "Figure":
    """Draw the force by position of the plate, and the asperities on the map.

    Parameters
    ----------
    problem : RoughProblem
        The surface.
    found : Superposition
        Result of :func:`viscotack.simulate.rough.superposed`.

    Returns
    -------
    matplotlib.figure.Figure
        Left the force, compression positive, right the heights with the summits.
    """
    surface, curve = problem.surface, found.curve
    length, length_unit = axis_unit(curve.position, "m")
    force, force_unit = axis_unit(curve.force, "N")
    height, height_unit = axis_unit(float(np.ptp(surface.heights)) or 1e-9, "m")
    side, side_unit = axis_unit(surface.size, "m")
    with drawing(10.0, 4.4) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1))
        left.axhline(0, color="0.6", lw=0.8)
        left.plot(curve.position / length, curve.force / force, color=BLUE)
        left.set(xlabel=f"position of the plate [{length_unit}]", ylabel=f"force [{force_unit}]")
        left.set_title(f"pull-off force {found.pull_off_force / force:.3g} {force_unit}")
        rows, columns = (each / side for each in surface.size)
        image = right.imshow(surface.heights / height, cmap="cividis", extent=(0, columns, rows, 0))
        x, y = found.asperities.positions.T / side
        right.plot(y, x, ".", color=ORANGE, ms=3)
        right.grid(False)
        right.set(xlabel=f"x [{side_unit}]", ylabel=f"y [{side_unit}]")
        right.set_title(f"{len(x)} asperities, {found.touching} in contact")
        figure.colorbar(image, ax=right, label=f"height [{height_unit}]")
    return figure


def _figure(found: RoughResult) -> tuple["Figure", Callable[[FieldMap], None]]:
    """Return the figure, and a function that shows a map in it."""
    length, length_unit = axis_unit(found.depth, "m")
    force, force_unit = axis_unit(found.force, "N")
    stress, stress_unit = axis_unit(found.strongest.pressure, "Pa")
    rows, columns = found.strongest.pressure.shape
    side, side_unit = axis_unit(found.pixel * max(rows, columns), "m")
    with drawing(10.0, 4.4) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1))
        left.axhline(0, color="0.6", lw=0.8)
        left.plot(found.depth / length, found.force / force, color=BLUE)
        (mark,) = left.plot([], [], "o", color=ORANGE, zorder=3)
        left.set(xlabel=f"depth [{length_unit}]", ylabel=f"force [{force_unit}]")
        share = left.twinx()
        part = 100 * found.area / found.nominal_area
        share.plot(found.depth / length, part, color="0.55", lw=1.0, ls="--")
        share.set_ylabel("map in contact [%], dashed")
        share.set_ylim(0, None)
        share.grid(False)
        left.set_title(f"pull-off force {found.pull_off_force / force:.3g} {force_unit}")
        most = float(np.quantile(np.abs(found.strongest.pressure), 0.999)) / stress
        extent = (0, columns * found.pixel / side, 0, rows * found.pixel / side)
        colours = {"cmap": "RdBu_r", "vmin": -most, "vmax": most, "interpolation": "nearest"}
        image = right.imshow(found.strongest.pressure / stress, extent=extent, **colours)
        right.grid(False)
        right.set(xlabel=f"x [{side_unit}]", ylabel=f"y [{side_unit}]")
        right.set_title("pressure at the point")
        figure.colorbar(image, ax=right, label=f"pressure [{stress_unit}]")

    def show(shown: FieldMap) -> None:
        image.set_data(shown.pressure / stress)
        mark.set_data([shown.depth / length], [shown.force / force])

    return figure, show
