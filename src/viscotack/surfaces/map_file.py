"""Maps of heights in files: text, NumPy arrays (.npy), and formats of :mod:`.topography`."""

from __future__ import annotations

import io
import itertools
import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.bounded import LONGEST_LINE, open_regular
from viscotack.files.whole import Target, write_whole

from .heights import MOST, HeightMap
from .topography import read_topography

# Endings of text; other files than these and .npy are read by SurfaceTopography.
_TEXT = ("", ".csv", ".txt", ".tsv", ".dat", ".asc")
_SEPARATORS = (",", ";", "\t", None)
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
        lines that begin with # are skipped. With the extra ``surfaces``, also what the package
        SurfaceTopography reads (`.gwy`, `.x3p`, `.sur`, `.nid` and other formats of instruments).
    pixel : float, optional
        Side of a pixel [m], where the file does not state it; text and `.npy` do not.
    unit : float, optional
        Unit of the heights [m], for example 1e-9; of text and `.npy` by default 1 m, of other files
        where they do not state it.
    periodic : bool
        Whether the map repeats in both directions.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If it contains no such map; the message names the line. If SurfaceTopography is needed and
        not installed, or the file states pixel or unit too.
    """
    path = Path(path)
    ending = path.suffix.lower()
    try:
        if ending not in (".npy", *_TEXT):
            path.stat()  # FileNotFoundError in our words
            return read_topography(path, pixel=pixel, unit=unit, periodic=periodic)
        if pixel is None:
            raise InputError("pixel is missing: this format does not state the size of a pixel")
        heights = _array(path) if ending == ".npy" else _table(path)
        return HeightMap(heights * (1.0 if unit is None else unit), pixel, periodic)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def write_map(surface: HeightMap, target: Target) -> None:
    """Write the heights [m] of a map as an array (.npy), whole or not at all."""
    held = io.BytesIO()
    np.save(held, surface.heights, allow_pickle=False)
    write_whole(target, held.getvalue())


def _array(path: Path) -> npt.NDArray:
    """Return the numbers of a .npy file, whose header is checked before memory is taken."""
    with open_regular(path) as file:
        try:
            version = np.lib.format.read_magic(file)
            read = {
                (1, 0): np.lib.format.read_array_header_1_0,
                (2, 0): np.lib.format.read_array_header_2_0,
            }[version]
            shape, _, kind = read(file, max_header_size=_HEADER)
        except (ValueError, KeyError, EOFError) as error:
            raise InputError(f"it is no array of NumPy: {error}") from None
        if kind.hasobject or kind.kind not in "iuf" or len(shape) != 2 or max(shape) > MOST:
            raise InputError(
                f"the array must have two dimensions of up to {MOST} numbers, got {shape} of {kind}"
            )
        there = os.fstat(file.fileno()).st_size - file.tell()
        if there != math.prod(shape) * kind.itemsize:
            raise InputError("the file is cut off, or longer than its header states")
        file.seek(0)
        return np.load(file, allow_pickle=False).astype(float)


def _table(path: Path) -> npt.NDArray:
    """Return the numbers of a text file."""
    rows: list[npt.NDArray] = []
    separator: str | None = None
    for number, line in enumerate(_lines(path), 1):
        if not line or line.startswith("#"):
            continue
        if not rows:
            separator = next(sep for sep in _SEPARATORS if sep is None or sep in line)
        if len(rows) == MOST:
            raise InputError(f"a map has up to {MOST} rows")
        parts = line.rstrip(separator or "").split(separator)
        try:
            row = np.array([float(part) for part in parts])
        except ValueError as error:
            raise InputError(f"line {number}: {error}; a map has only numbers") from None
        if rows and len(row) != len(rows[0]):
            raise InputError(
                f"line {number} has {len(row)} numbers, and the first row {len(rows[0])}"
            )
        rows.append(row)
    if not rows:
        raise InputError("it has no numbers")
    return np.array(rows)


def _lines(path: Path) -> Iterator[str]:
    """Yield the lines of a text without keeping them; a map has up to 4096 long ones."""
    with io.TextIOWrapper(open_regular(path), "utf-8-sig", errors="replace") as text:
        for number in itertools.count(1):
            line = text.readline(LONGEST_LINE)
            if len(line) == LONGEST_LINE:
                raise InputError(f"line {number} has more than {LONGEST_LINE:,} characters")
            if not line:
                return
            yield line.strip()
