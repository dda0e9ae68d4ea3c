"""Maps in formats of microscopes and profilers, read by SurfaceTopography (extra ``surfaces``).

SurfaceTopography is a part of ContactEngineering, by Lars Pastewka and others, under the MIT
licence: https://contactengineering.github.io/SurfaceTopography. It reads files of Gwyddion,
Bruker, Zygo, Keyence, JPK, Nanosurf, X3P and others, which state the size of a map and its unit.
"""

from __future__ import annotations

import math
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError, install_command
from viscotack.files.archive import check_unpacked

from .heights import MOST, HeightMap

# First bytes, by which a text is told, and its largest size [bytes].
_LOOKED, _LARGEST_TEXT = 4096, 20_000_000
# Relative differences of the sides of a pixel: square, and noted where larger; refused.
_EXACT, _SQUARE = 1e-6, 0.01


def read_topography(
    path: Path, *, pixel: float | None, unit: float | None, periodic: bool
) -> HeightMap:
    """Read a map by SurfaceTopography; the parameters are those of :func:`.read_map`."""
    try:
        library: Any = import_module("SurfaceTopography")
    except ImportError:
        raise InputError(
            f"files that end with {path.suffix!r} are read by SurfaceTopography; install it with: "
            f"{install_command('surfaces')}; or export the heights as text or .npy"
        ) from None
    with open(path, "rb") as file:
        is_text = b"\0" not in file.read(_LOOKED)
        if is_text and path.stat().st_size > _LARGEST_TEXT:
            raise InputError(
                f"it is a text of more than {_LARGEST_TEXT / 1e6:g} MB, of which SurfaceTopography "
                "takes many times the size; save the rows of the map as .txt or .npy"
            )
        check_unpacked(file)
    try:
        with library.open_topography(str(path)) as reader:
            channel = reader.default_channel
            _check(channel)
            given = _given(channel, pixel, unit)
            found = reader.topography(**given).to_unit("m")
            heights = np.ma.filled(np.ma.asarray(found.heights(), dtype=float), np.nan)
            sides = [float(side) for side in found.pixel_size]
    except InputError:
        raise
    except Exception as error:  # its readers raise what a damaged file leads to
        words = str(error).strip() or type(error).__name__
        raise InputError(f"SurfaceTopography cannot read it: {words:.300}") from None
    if abs(sides[0] / sides[1] - 1) > _SQUARE:
        raise InputError(
            f"its pixels are {sides[0]:.4g} m by {sides[1]:.4g} m, and they must be square; "
            "resample the map"
        )
    note = f"pixels of {sides[0]:.6g} m by {sides[1]:.6g} m are taken as square"
    notes = (note,) if abs(sides[0] / sides[1] - 1) > _EXACT else ()
    return HeightMap(heights, math.sqrt(sides[0] * sides[1]), periodic, notes=notes)


def _check(channel: Any) -> None:
    """Refuse profiles, and maps whose heights would take too much memory."""
    shape = tuple(channel.nb_grid_pts or ())
    if channel.dim != 2 or max(shape, default=0) > MOST:
        raise InputError(
            f"it must be a map of two dimensions with up to {MOST} pixels in each direction, got "
            f"{' x '.join(map(str, shape)) or 'a profile'}"
        )


def _given(channel: Any, pixel: float | None, unit: float | None) -> dict[str, Any]:
    """Return the lengths that the file does not state; InputError where both or neither do."""
    sizes, length = channel.physical_sizes, channel.unit
    if (sizes is None) != (pixel is not None):
        raise InputError(
            "pixel is missing, and the file does not state the size of the map"
            if sizes is None
            else f"leave pixel out: the file states {sizes[0]:.6g} x {sizes[1]:.6g} {length}"
        )
    if (length is None) != (unit is not None):
        raise InputError(
            "height_unit is missing, and the file does not state it"
            if length is None
            else f"leave height_unit out: the file states {length}"
        )
    found: dict[str, Any] = {}
    if pixel is not None:
        # in the unit of the file, or in m
        metre = 1.0 if length is None else _metre(length)
        found["physical_sizes"] = tuple(pixel / metre * side for side in channel.nb_grid_pts)
    if unit is not None:
        found |= {"unit": "m", "height_scale_factor": unit}
    return found


def _metre(unit: str) -> float:
    """Return a unit of SurfaceTopography in m."""
    factor: Any = import_module("SurfaceTopography.Support.UnitConversion")
    return float(factor.get_unit_conversion_factor(unit, "m"))
