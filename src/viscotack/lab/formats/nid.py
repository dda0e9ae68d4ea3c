"""Layout of Nanosurf's .nid: a text header, then curves of integers, group after group.

The header states the number of points and the range of numbers of each curve. Points are
equidistant in time; the modulation time covers all planned points of the forward or the backward
curve.
"""

import re

import numpy as np

from viscotack.arrays import Array
from viscotack.units import parse

from .file import Curve, LabFile, in_sequence

MARK = b"[DataSet]"
_END = b"#!"
_CURVE = re.compile(r"DataSet-(\d+):(\d+)")
_UNITS = {"Deflection": "N", "Z-Axis Sensor": "m", "Z-Axis": "m"}
_FRAMES = ("Spec forward", "Spec fwd pause", "Spec backward", "Spec bwd pause")
_Sections = dict[str, dict[str, str]]


def curves(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the forward, pause and backward curves as one curve; None for other files.

    Raises
    ------
    ValueError
        If the header is incomplete, a curve is truncated, or there is no force.
    """
    if not file.content.startswith(MARK):
        return None
    head, end, content = file.content.partition(_END)
    if not end:
        raise file.error("the header has no end; the file is truncated or not a .nid file")
    sections: _Sections = {}
    current: dict[str, str] = {}
    for text in head.decode("latin-1").splitlines():
        if text.startswith("[") and text.rstrip().endswith("]"):
            current = sections.setdefault(text.strip()[1:-1], {})
        elif "=" in text:
            key, value = text.split("=", 1)
            current[key.strip()] = value.strip()
    channels = _channels(file, sections, content)
    planned = next(
        (x for key, x in sections.items() if key.endswith("Spec") and "Modulation time" in x), None
    )
    if planned is None:
        raise file.error("the header lacks the modulation time and the number of points")
    step = parse(planned["Modulation time"], "s") / int(planned["Data points"])
    parts: list[tuple[Array, ...]] = []
    for frame in _FRAMES:
        one = {channel: values for (where, channel), values in channels.items() if where == frame}
        if not one:
            continue
        deflection, height = one.get("Deflection"), one.get("Z-Axis Sensor", one.get("Z-Axis"))
        if deflection is None or height is None:
            raise file.error(f'the part "{frame}" lacks a deflection in newtons or a height')
        if frame == "Spec backward":
            # stored in the direction of the forward part, like the lines of an image
            deflection, height = deflection[::-1], height[::-1]
        parts.append((step * np.arange(1.0, height.size + 1), deflection, height))
    if not parts:
        raise file.error("the file has no part Spec forward or Spec backward; it may be an image")
    note = (
        f"{planned['Data points']} equidistant points were planned in {planned['Modulation time']}"
    )
    # direction unknown: when the head is lowered, the numbers rise on some heads and fall on others
    return [Curve(*in_sequence(parts), notes=(note,))]


def _channels(file: LabFile, sections: _Sections, content: bytes) -> dict[tuple[str, str], Array]:
    """Return the spectroscopy curves by part and channel, in SI."""
    found: dict[tuple[str, str], Array] = {}
    at = 0
    for title in filter(_CURVE.fullmatch, sections["DataSet"].values()):
        head = sections[title]
        points, lines, bits = (int(head[key]) for key in ("Points", "Lines", "SaveBits"))
        encoding = head.get("SaveOrder", "Intel"), head.get("SaveSign", "Signed")
        if encoding != ("Intel", "Signed"):
            raise file.error(f"[{title}] has an unsupported encoding ({' '.join(encoding)})")
        count = points * lines
        counts = np.frombuffer(content, f"<i{bits // 8}", count, at) if count else np.empty(0)
        at += counts.nbytes
        frame, channel = head.get("Frame", ""), head.get("Dim2Name", "")
        wanted = channel in _UNITS and head.get("Dim2Unit") == _UNITS[channel]
        if not (frame.startswith("Spec") and count and wanted):
            continue
        if lines > 1:
            raise file.error(f"[{title}] contains {lines} curves; export one curve per file")
        low, span = float(head["Dim2Min"]), float(head["Dim2Range"])
        found[frame, channel] = low + span * (counts.astype(float) / 2.0**bits + 0.5)
    return found
