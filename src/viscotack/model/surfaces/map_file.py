"""Maps of heights in files: text, NumPy arrays (.npy), and those of SurfaceTopography.

**Maps in formats of microscopes and profilers, read by SurfaceTopography (extra ``surfaces``).**
SurfaceTopography is a part of ContactEngineering, by Lars Pastewka and others, under the MIT
licence: https://contactengineering.github.io/SurfaceTopography. It reads files of Gwyddion, Bruker,
Zygo, Keyence, JPK, Nanosurf, X3P and others, which state the size of a map and its unit.
"""

from __future__ import annotations

import math
import os
import re
from contextlib import suppress
from dataclasses import replace
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError, install_command, placed
from viscotack.files.archive import check_unpacked
from viscotack.model.surfaces.heights import MOST, HeightMap
from viscotack.units import parse, readable

# First bytes, by which a text is told, and its largest size [bytes].
_LOOKED, _LARGEST_TEXT = 4096, 20_000_000
# Relative differences of the sides of a pixel: square, and noted where larger; refused.
_EXACT, _SQUARE = 1e-6, 0.01


def read_topography(
    path: Path, *, pixel: float | None, unit: float | None, periodic: bool
) -> HeightMap:
    """Read a map by SurfaceTopography; the parameters are those of :func:`read_map`."""
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
            shape = tuple(channel.nb_grid_pts or ())
            if channel.dim != 2 or max(shape, default=0) > MOST:
                raise InputError(
                    f"it must be a map of two dimensions with up to {MOST} pixels in each "
                    f"direction, got {' x '.join(map(str, shape)) or 'a profile'}"
                )
            sizes, length = channel.physical_sizes, channel.unit
            size = sizes and f"{sizes[0]:.6g} x {sizes[1]:.6g} {length}"
            _refuse_both("pixel", size, pixel)
            _refuse_both("height_unit", length, unit)
            given: dict[str, Any] = {}
            if pixel is not None:
                # in the unit of the file, or in m
                units: Any = import_module("SurfaceTopography.Support.UnitConversion")
                metre = 1.0 if length is None else units.get_unit_conversion_factor(length, "m")
                given["physical_sizes"] = tuple(pixel / float(metre) * side for side in shape)
            if unit is not None:
                given |= {"unit": "m", "height_scale_factor": unit}
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


def _refuse_both(name: str, stated: str | None, given: float | None) -> None:
    """Raise an InputError if a length is stated by both the file and the caller, or by neither."""
    if stated is None and given is None:
        raise InputError(f"{name} is missing, and the file does not state it")
    if stated is not None and given is not None:
        raise InputError(f"leave {name} out: the file states {stated}")


# Endings of text; other files than these and .npy are read by SurfaceTopography.
_TEXT = ("", ".csv", ".txt", ".tsv", ".dat", ".asc")
_SEPARATORS = (";", "\t", ",", None)
# lines of the header of Gwyddion in any language: width and height, then the unit of the heights
_LENGTH = re.compile(r"#[^:]*:\s*([0-9.,eE+-]+)\s*([^\s0-9]+)\s*")
_UNIT = re.compile(r"#[^:]*:\s*([^\s0-9]+)\s*")
_DECIMAL_COMMAS = re.compile(r"[-+]?[0-9]+(,[0-9]+)?([eE][-+]?[0-9]+)?")
# Beyond these [m] a unit is probably wrong: sides of a map, and rms heights, below an atom's size.
_LARGEST_SIDE, _SMALLEST_RMS = 0.3, 1e-11
# Header of an array [bytes].
_HEADER = 10_000


def read_map(
    path: str | os.PathLike[str],
    *,
    pixel: float | None = None,
    unit: float | None = None,
    periodic: bool = False,
) -> HeightMap:
    """Read a map of heights from a file.

    Parameters
    ----------
    path : path
        A `.npy` file with an array of two dimensions; or text, one row of the map in each line,
        separated by commas, semicolons, tabs or blanks (`.csv`, `.txt`, `.tsv`, `.dat`, `.asc`);
        lines that begin with # are skipped, but for a header of Gwyddion (width, height, unit of
        the heights). With the extra ``surfaces``, also what the package
        SurfaceTopography reads (`.gwy`, `.x3p`, `.sur`, `.nid` and other formats of instruments).
    pixel : float, optional
        Side of a pixel [m], where the file does not state it; `.npy` and text without a header do
        not.
    unit : float, optional
        Unit of the heights [m], for example 1e-9, where the file does not state it; of text and
        `.npy` by default 1 m.
    periodic : bool
        Whether the map repeats in both directions.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If it contains no such map. If SurfaceTopography is needed and
        not installed, or the file states pixel or unit too.
    """
    path = Path(path)
    ending = path.suffix.lower()
    with placed(f"{path}:"):
        with open(path, "rb") as file:  # FileNotFoundError in our words
            first = file.read(_HEADER)
        is_binary = b"\0" in first and not first.startswith((b"\xff\xfe", b"\xfe\xff"))
        if ending not in (".npy", *_TEXT) or (ending in _TEXT and is_binary):
            found = read_topography(path, pixel=pixel, unit=unit, periodic=periodic)
            return replace(found, notes=(*found.notes, *_doubts(found)))
        heights, side, own = (_array(path), None, None) if ending == ".npy" else _table(path)
        for name, given, stated in (("pixel", pixel, side), ("height_unit", unit, own)):
            if given is None or stated is None or math.isclose(given, stated, rel_tol=_SQUARE):
                continue
            raise InputError(f"leave {name} out: the file states {readable(stated, 'm')}")
        size = side or pixel
        if size is None:
            raise InputError("pixel is missing: the file does not state the size of a pixel")
        scale = own or (1.0 if unit is None else unit)
        found = HeightMap(heights * scale, size, periodic)
        return replace(found, notes=_doubts(found))


def _header(lines: list[str], shape: tuple[int, ...]) -> tuple[float | None, float | None]:
    """Return the side of a pixel and the unit of the heights [m] that a header states, if any."""
    lengths: list[float] = []
    unit = None
    for line in lines:
        length, own = _LENGTH.fullmatch(line), _UNIT.fullmatch(line)
        with suppress(InputError):
            if length:
                lengths.append(parse(f"{length[1].replace(',', '.')} {length[2]}", "m"))
            elif own:
                unit = parse(f"1 {own[1]}", "m")
    if len(lengths) < 2:
        return None, unit
    across, down = lengths[0] / shape[1], lengths[1] / shape[0]
    if abs(across - down) > _SQUARE * down:
        raise InputError(
            f"its pixels are {readable(across, 'm')} by {readable(down, 'm')}, and they must be "
            "square; resample the map"
        )
    return across, unit


def _doubts(found: HeightMap) -> tuple[str, ...]:
    """Return a note on sides or heights that suggest a wrong unit."""
    rms, side = float(np.std(found.heights)), max(found.size)
    if side <= _LARGEST_SIDE and (rms >= _SMALLEST_RMS or rms == 0) and rms <= side:
        return ()
    return (
        f"check: the map has sides of {readable(side, 'm')} and an rms height of "
        f"{readable(rms, 'm')}; check the units of pixel and heights",
    )


def _array(path: Path) -> npt.NDArray:
    """Return the numbers of a .npy file, which is mapped: no memory is taken before the check."""
    try:
        found = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError) as error:
        raise InputError(f"it is no array of NumPy, or cut off: {error}") from None
    if found.dtype.kind not in "iuf" or found.ndim != 2 or max(found.shape) > MOST:
        raise InputError(
            f"the array must have two dimensions of up to {MOST} numbers, got {found.shape} of "
            f"{found.dtype}"
        )
    return found.astype(float)


def _table(path: Path) -> tuple[npt.NDArray, float | None, float | None]:
    """Return the numbers of a text file, and side of a pixel and unit [m] in its header."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        lines = [text.strip() for text in islice(file, 2 * MOST)]
        if next(file, None) is not None:
            raise InputError(f"it has more than {2 * MOST} lines")
    numbers = [n for n, line in enumerate(lines, 1) if line and not line.startswith("#")]
    if not numbers:
        raise InputError("it has no numbers")
    rows = [lines[n - 1] for n in numbers]
    first = rows[0]
    separator = next(mark for mark in _SEPARATORS if mark is None or mark in first)
    # "0,5 0,7" has commas within numbers, "0.5, 0.7" between them
    blanks = first.split()
    if separator == "," and len(blanks) > 1 and all(map(_DECIMAL_COMMAS.fullmatch, blanks)):
        separator = None
    if separator != "," and "," in first and "." not in first:
        rows = [row.replace(",", ".") for row in rows]
    cut = [row.rstrip(separator or "") for row in rows]

    def read(*rows: str) -> npt.NDArray | None:
        with suppress(ValueError):
            return np.loadtxt(rows, delimiter=separator, comments=None, ndmin=2)

    heights = read(*cut)
    if heights is None:
        # NumPy counts some rows from 0 and others from 1, and never lines that are left out
        line = next(n for n, row in zip(numbers, cut, strict=True) if read(cut[0], row) is None)
        raise InputError(f"line {line}: a map has only numbers, equally many in each row")
    return heights, *_header([line for line in lines if line.startswith("#")], heights.shape)
