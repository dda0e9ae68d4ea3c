"""Layout of Igor binary waves (.ibw, version 5), the force curves of Asylum Research microscopes.

A wave has a fixed header, columns of numbers, a text note with the spring constant and the
sampling rate, and the names of the columns: deflection and height of the sensor, in metres.
"""

import re
import struct

import numpy as np

from viscotack.arrays import Array
from viscotack.lab.lab_file import LabFile

from .header import bending, recorded
from .record import TackRecord

START = b"\x05\x00"  # version 5, little-endian
_HEAD = struct.Struct("<hHiiii4i4iiii")
_DATA = 384  # bytes of both headers
_TYPES = {2: "<f4", 4: "<f8"}
_LABEL = 32  # bytes
_MOST = 5_000_000


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None for other files."""
    known = file.content.startswith(START) and not file.lines and len(file.content) > _DATA
    return "ibw" if known else None


def records(file: LabFile) -> list[TackRecord]:
    """Return the force curve of a wave.

    Raises
    ------
    ValueError
        If the wave is truncated, of another kind, or not calibrated.
    """
    columns, note = _wave(file)
    for needed in ("Defl", "ZSnsr"):
        if needed not in columns:
            raise file.error(
                f"no column {needed}; the columns are {', '.join(columns) or 'not named'}"
            )
    stiffness, rate = _noted(file, note, "SpringConstant"), _noted(file, note, "NumPtsPerSec")
    deflection, height = columns["Defl"], columns["ZSnsr"]
    keep = np.isfinite(deflection) & np.isfinite(height)
    time = np.arange(1, height.size + 1) / rate
    return recorded(
        file,
        "ibw",
        (bending(stiffness),),
        (time[keep], stiffness * deflection[keep], height[keep]),
        into=1,  # the sensor value increases when the tip is lowered
        compliance=1 / stiffness,
    )


def _wave(file: LabFile) -> tuple[dict[str, Array], str]:
    """Return the named columns of a wave, and its note."""
    content = file.content
    if len(content) <= _DATA or not content.startswith(START):
        raise file.error("expected an Igor binary wave of version 5")
    head = _HEAD.unpack_from(content)
    size, formula, note, units, dimension_units = head[2], head[3], head[4], head[5], head[6:10]
    labels = head[10:14]
    points, kind = struct.unpack_from("<ih", content, 64 + 12)
    rows, wide, deep, _ = struct.unpack_from("<4i", content, 64 + 68)
    if kind not in _TYPES:
        raise file.error(f"the wave contains numbers of type {kind}, which is not supported")
    width = np.dtype(_TYPES[kind]).itemsize
    sizes = (size, formula, note, units, *dimension_units, *labels)
    if min(sizes) < 0 or not 0 < points <= _MOST or deep or rows * wide != points:
        raise file.error("the header of the wave is inconsistent, or it is not a force curve")
    end = _DATA + points * width
    behind = end + formula + note + units + sum(dimension_units)
    if len(content) < behind + labels[0] + labels[1]:
        raise file.error("the wave is shorter than its header states; the file is truncated")
    values = np.frombuffer(content[_DATA:end], dtype=_TYPES[kind]).astype(float)
    names = content[behind + labels[0] : behind + labels[0] + labels[1]]
    found = [
        names[i : i + _LABEL].split(b"\0")[0].decode("latin-1")
        for i in range(_LABEL, len(names), _LABEL)
    ]
    table = values.reshape((rows, wide), order="F")
    columns = {word: table[:, i] for i, word in enumerate(found[:wide]) if word}
    return columns, content[end + formula : end + formula + note].decode("latin-1")


def _noted(file: LabFile, note: str, key: str) -> float:
    match = re.search(rf"(?:^|[\r\n]){key}:\s*([0-9.eE+-]+)", note)
    try:
        value = float(match[1]) if match else np.nan
    except ValueError:
        value = np.nan
    if not 0 < value < np.inf:
        raise file.error(f"the note lacks {key}; calibrate the cantilever and save the curve again")
    return value
