"""Layout of Nanosurf's .nid: a text header, then curves of integers, group after group.

The header states the number of points and the range of numbers of each curve. Points are
equidistant in time; the modulation time covers all planned points of the forward or the backward
curve.
"""

import re

import numpy as np

from viscotack.arrays import Array

from .file import MOST_POINTS, Curve, LabFile, Words, real, whole

MARK = b"[DataSet]"
_END = b"#!"
_CURVE = re.compile(r"DataSet-(\d+):(\d+)")
_UNITS = {"Deflection": "N", "Z-Axis Sensor": "m", "Z-Axis": "m"}
_FRAMES = ("Spec forward", "Spec fwd pause", "Spec backward", "Spec bwd pause")
_TIME = re.compile(r"\s*([0-9.]+)\s*(s|ms|us)\s*")
_PARTS = {"s": 1.0, "ms": 1e-3, "us": 1e-6}


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
    sections: dict[str, dict[str, str]] = {}
    current: dict[str, str] = {}
    for text in head.decode("latin-1").splitlines():
        if text.startswith("[") and text.rstrip().endswith("]"):
            current = sections.setdefault(text.strip()[1:-1], {})
        elif "=" in text:
            key, value = text.split("=", 1)
            current[key.strip()] = value.strip()
    channels = _channels(file, sections, content)
    step, note = _step(file, sections)
    columns: list[tuple[Array, ...]] = []
    clock = 0.0
    for frame in _FRAMES:
        one = {channel: values for (where, channel), values in channels.items() if where == frame}
        if not one:
            continue
        deflection, height = one.get("Deflection"), one.get("Z-Axis Sensor", one.get("Z-Axis"))
        if deflection is None or height is None or height.size != deflection.size:
            raise file.error(
                f'the part "{frame}" lacks a deflection in newtons or a height of the same length'
            )
        if frame == "Spec backward":
            # stored in the direction of the forward part, like the lines of an image
            deflection, height = deflection[::-1], height[::-1]
        columns.append((clock + step * np.arange(1.0, height.size + 1), deflection, height))
        clock += step * height.size
    if not columns:
        raise file.error("the file has no part Spec forward or Spec backward; it may be an image")
    # direction unknown: when the head is lowered, the numbers rise on some heads and fall on others
    time, force, position = map(np.concatenate, zip(*columns, strict=True))
    return [Curve(time, force, position, notes=(note,))]


def _channels(
    file: LabFile, sections: dict[str, dict[str, str]], content: bytes
) -> dict[tuple[str, str], Array]:
    """Return the spectroscopy curves by part and channel, in SI."""
    found: dict[tuple[str, str], Array] = {}
    at = 0
    for title in filter(_CURVE.fullmatch, sections.get("DataSet", {}).values()):
        head: Words | None = sections.get(title)
        if head is None:
            raise file.error(f"the header has no section [{title}]")
        label = f"[{title}]: "
        points, lines, bits = (
            whole(file, head, key, label) for key in ("Points", "Lines", "SaveBits")
        )
        encoding = head.get("SaveOrder", "Intel"), head.get("SaveSign", "Signed")
        if bits not in (8, 16, 32) or encoding != ("Intel", "Signed"):
            raise file.error(f"[{title}] has an unsupported encoding ({bits} bits)")
        size = points * lines * bits // 8
        piece = content[at : at + size]
        if len(piece) < size or points * lines > MOST_POINTS:
            raise file.error(
                f"[{title}] ends after {len(piece)} of {size} bytes; the file is truncated"
            )
        at += size
        frame, channel = head.get("Frame", ""), head.get("Dim2Name", "")
        wanted = channel in _UNITS and head.get("Dim2Unit") == _UNITS[channel]
        if not (frame.startswith("Spec") and size and wanted):
            continue
        if lines > 1:
            raise file.error(f"[{title}] contains {lines} curves; export one curve per file")
        low, span = (real(file, head, key, label) for key in ("Dim2Min", "Dim2Range"))
        counts = np.frombuffer(piece, dtype=f"<i{bits // 8}").astype(float)
        found[frame, channel] = low + span * (counts / 2.0**bits + 0.5)
    return found


def _step(file: LabFile, sections: dict[str, dict[str, str]]) -> tuple[float, str]:
    """Return the time between points [s], and a note."""
    for key, section in sections.items():
        if key.endswith("Spec") and "Modulation time" in section:
            match = _TIME.fullmatch(section["Modulation time"])
            planned = whole(file, section, "Data points", f"[{key}]: ")
            if match is None or planned < 2 or not float(match[1]):
                break
            return (
                float(match[1]) * _PARTS[match[2]] / planned,
                f"{planned} equidistant points were planned in {section['Modulation time']}",
            )
    raise file.error("the header lacks the modulation time and the number of points")
