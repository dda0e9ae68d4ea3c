"""Layout of Igor binary waves (.ibw, version 5), the force curves of Asylum Research microscopes.

A wave has a fixed header, columns of numbers, a text note with the spring constant and the
sampling rate, and the names of the columns: deflection and height of the sensor, in metres.
"""

import re
import struct

import numpy as np

from viscotack.arrays import Array

from .file import Curve, LabFile

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
    # the first entry counts
    noted = dict(reversed(_NOTED.findall(note)))
    if missing := {"Defl", "ZSnsr"} - columns.keys() or {"SpringConstant"} - noted.keys():
        raise file.error(
            f"the wave lacks {min(missing)}; calibrate the cantilever and save the curve again"
        )
    stiffness, rate = float(noted["SpringConstant"]), float(noted["NumPtsPerSec"])
    deflection, height = columns["Defl"], columns["ZSnsr"]
    keep = np.isfinite(deflection) & np.isfinite(height)
    time = np.arange(1, height.size + 1) / rate
    # the sensor value increases when the tip is lowered
    return [Curve(time[keep], stiffness * deflection[keep], height[keep], 1, stiffness)]


def _wave(file: LabFile) -> tuple[dict[str, Array], str]:
    """Return the named columns of a wave, and its note."""
    content = file.content
    _, _, _, formula, note, units, *sizes = _HEAD.unpack_from(content)[:14]
    points, kind = struct.unpack_from("<ih", content, 64 + 12)
    rows, wide = struct.unpack_from("<2i", content, 64 + 68)
    table = np.frombuffer(content, _TYPES[kind], points, _DATA).astype(float)
    table = table.reshape((rows, wide), order="F")
    end = _DATA + points * np.dtype(_TYPES[kind]).itemsize
    at = end + formula + note + units + sum(sizes[:5])
    names = content[at : at + sizes[5]]
    if len(names) < sizes[5]:
        raise file.error("the wave is shorter than its header states; the file is truncated")
    found = [
        names[i : i + _LABEL].split(b"\0")[0].decode("latin-1")
        for i in range(_LABEL, len(names), _LABEL)
    ]
    columns = {word: table[:, i] for i, word in enumerate(found[:wide]) if word}
    return columns, content[end + formula : end + formula + note].decode("latin-1")
