"""Layout of Igor binary waves (.ibw, version 5), the force curves of Asylum Research microscopes.

A wave has a fixed header, columns of numbers, a text note with the spring constant and the
sampling rate, and the names of the columns: deflection and height of the sensor, in metres.
"""

import re
import struct

import numpy as np

from viscotack.arrays import Array

from .file import MOST_POINTS, Curve, LabFile, positive

START = b"\x05\x00"  # version 5, little-endian
_HEAD = struct.Struct("<hHiiii4i4iiii")
_DATA = 384  # bytes of both headers
_TYPES = {2: "<f4", 4: "<f8"}
_LABEL = 32  # bytes
_NOTED = re.compile(r"(?:^|[\r\n])(\w+):\s*([0-9.eE+-]+)")


def curves(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the force curve of a wave; None for other files.

    Raises
    ------
    ValueError
        If the wave is truncated, of another kind, or not calibrated.
    """
    if not file.content.startswith(START) or file.lines or len(file.content) <= _DATA:
        return None
    columns, note = _wave(file)
    for needed in ("Defl", "ZSnsr"):
        if needed not in columns:
            raise file.error(
                f"no column {needed}; the columns are {', '.join(columns) or 'not named'}"
            )
    # the first entry counts
    noted = dict(reversed(_NOTED.findall(note)))
    for needed in ("SpringConstant", "NumPtsPerSec"):
        if needed not in noted:
            raise file.error(
                f"the note lacks {needed}; calibrate the cantilever and save the curve again"
            )
    stiffness, rate = (positive(file, noted, key) for key in ("SpringConstant", "NumPtsPerSec"))
    deflection, height = columns["Defl"], columns["ZSnsr"]
    keep = np.isfinite(deflection) & np.isfinite(height)
    time = np.arange(1, height.size + 1) / rate
    # the sensor value increases when the tip is lowered
    return [Curve(time[keep], stiffness * deflection[keep], height[keep], 1, stiffness)]


def _wave(file: LabFile) -> tuple[dict[str, Array], str]:
    """Return the named columns of a wave, and its note."""
    content = file.content
    head = _HEAD.unpack_from(content)
    size, formula, note, units, dimension_units = head[2], head[3], head[4], head[5], head[6:10]
    labels = head[10:14]
    points, kind = struct.unpack_from("<ih", content, 64 + 12)
    rows, wide, deep, _ = struct.unpack_from("<4i", content, 64 + 68)
    if kind not in _TYPES:
        raise file.error(f"the wave contains numbers of type {kind}, which is not supported")
    sizes = (size, formula, note, units, *dimension_units, *labels)
    if min(sizes) < 0 or not 0 < points <= MOST_POINTS or deep or rows * wide != points:
        raise file.error("the header of the wave is inconsistent, or it is not a force curve")
    end = _DATA + points * np.dtype(_TYPES[kind]).itemsize
    behind = end + formula + note + units + sum(dimension_units)
    if len(content) < behind + labels[0] + labels[1]:
        raise file.error("the wave is shorter than its header states; the file is truncated")
    table = np.frombuffer(content[_DATA:end], dtype=_TYPES[kind]).astype(float)
    table = table.reshape((rows, wide), order="F")
    names = content[behind + labels[0] : behind + labels[0] + labels[1]]
    found = [
        names[i : i + _LABEL].split(b"\0")[0].decode("latin-1")
        for i in range(_LABEL, len(names), _LABEL)
    ]
    columns = {word: table[:, i] for i, word in enumerate(found[:wide]) if word}
    return columns, content[end + formula : end + formula + note].decode("latin-1")
