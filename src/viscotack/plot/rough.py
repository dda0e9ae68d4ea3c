"""Figure and film of a pull on a rough surface: force curve, contact and gap."""

import io
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole
from viscotack.pads.rough_surface import Superposition
from viscotack.rough.problem import RoughProblem
from viscotack.rough.result import FieldMap, RoughResult

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
        Result of :func:`viscotack.rough.pull`.

    Returns
    -------
    matplotlib.figure.Figure
        Left the force, compression positive, with the share of the map in contact; right the
        pressure at pull-off, tension in blue, compression in red.
    """
    figure, _ = _figure(found, found.strongest)
    return figure


def film_of_pull(found: RoughResult, target: Target) -> None:
    """Write the detachment as a film (GIF): the pressure over the map beside the force curve.

    Raises
    ------
    ValueError
        If the result has fewer than two maps; ask :func:`viscotack.rough.pull` for some.
    """
    from PIL import Image

    frames = [
        Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("P") for canvas in _frames(found)
    ]
    held, each = io.BytesIO(), 1000 // _PER_SECOND
    frames[0].save(held, "gif", save_all=True, append_images=frames[1:], duration=each, loop=0)
    write_whole(target, held.getvalue())


def check_ffmpeg() -> None:
    """Raise InputError with a remedy if ffmpeg is missing."""
    if shutil.which("ffmpeg") is None:
        raise InputError(
            "an .mp4 film needs the program ffmpeg; install it (Debian: apt install ffmpeg, macOS: "
            "brew install ffmpeg, conda install ffmpeg), or write a .gif by --film"
        )


def movie_of_pull(found: RoughResult, target: Target) -> None:
    """Write the film of :func:`film_of_pull` as MP4 (H.264), by the program ffmpeg.

    Raises
    ------
    ValueError
        If the result has fewer than two maps, or ffmpeg is missing or fails.
    """
    check_ffmpeg()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        frames = (np.asarray(canvas.buffer_rgba()) for canvas in _frames(found))
        first = next(frames)
        size = f"{first.shape[1]}x{first.shape[0]}"
        raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", size, "-r", str(_PER_SECOND), "-i", "-"]
        # what players read: H.264 with halved colours
        coded = ["-c:v", "libx264", "-pix_fmt", "yuv420p", str(path)]
        with subprocess.Popen(
            ["ffmpeg", "-loglevel", "error", *raw, *coded],
            stdin=subprocess.PIPE,
            stderr=subprocess.PIPE,
        ) as process:
            assert process.stdin is not None and process.stderr is not None
            try:
                for frame in chain([first], frames):
                    process.stdin.write(frame.tobytes())
                process.stdin.close()
            except BrokenPipeError:  # ffmpeg has ended and said why
                pass
            words = process.stderr.read().decode(errors="replace").strip()
        if process.returncode or not path.exists():
            raise InputError(f"ffmpeg did not write the film: {words or process.returncode}")
        content = path.read_bytes()
    write_whole(target, content)


def _frames(found: RoughResult) -> Iterator[Any]:
    """Draw each map of a result in turn; the same canvas."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    if len(found.maps) < 2:
        raise InputError("a film needs maps of several instants; ask for at least 2")
    with style():
        figure, parts = _figure(found, found.maps[0])
        figure.set_dpi(_DPI)
        canvas = FigureCanvasAgg(figure)
        for each in found.maps:
            parts["image"].set_data(each.pressure / parts["stress"])
            parts["mark"].set_data([each.depth / parts["length"]], [-each.force / parts["force"]])
            canvas.draw()
            yield canvas


def draw_superposition(problem: RoughProblem, found: Superposition) -> "Figure":
    """Draw the force by position of the plate, and the asperities on the map.

    Parameters
    ----------
    problem : RoughProblem
        The surface.
    found : Superposition
        Result of :func:`viscotack.pads.superposed`.

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


def _figure(found: RoughResult, shown: FieldMap) -> tuple["Figure", dict[str, Any]]:
    """Return the figure and the parts that a film changes."""
    length, length_unit = axis_unit(found.depth, "m")
    force, force_unit = axis_unit(found.force, "N")
    stress, stress_unit = axis_unit(found.strongest.pressure, "Pa")
    rows, columns = shown.pressure.shape
    side, side_unit = axis_unit(found.pixel * max(rows, columns), "m")
    with drawing(10.0, 4.4) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1))
        left.axhline(0, color="0.6", lw=0.8)
        left.plot(found.depth / length, found.force / force, color=BLUE)
        at = shown.depth / length, shown.force / force
        (mark,) = left.plot(*at, "o", color=ORANGE, zorder=3)
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
        image = right.imshow(shown.pressure / stress, extent=extent, **colours)
        right.grid(False)
        right.set(xlabel=f"x [{side_unit}]", ylabel=f"y [{side_unit}]")
        right.set_title("pressure at the point")
        figure.colorbar(image, ax=right, label=f"pressure [{stress_unit}]")
    parts = {"image": image, "mark": mark, "stress": stress, "force": force, "length": length}
    return figure, parts
