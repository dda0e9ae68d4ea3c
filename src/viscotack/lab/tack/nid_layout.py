"""Layout of Nanosurf's .nid: a text header, then curves of integers, group after group.

The header states the number of points and the range of numbers of each curve. Points are
equidistant in time; the modulation time covers all planned points of the forward or the backward
curve.
"""

import re

import numpy as np

from viscotack.arrays import Array
from viscotack.lab.lab_file import LabFile

from .header import Words, real, recorded, whole
from .record import TackRecord

_END = b"#!"
_MARK = b"[DataSet]"
_CURVE = re.compile(r"DataSet-(\d+):(\d+)")
_MOST = 5_000_000  # largest number of points of a file
_TIME = re.compile(r"\s*([0-9.]+)\s*(s|ms|us)\s*")
_PARTS = {"s": 1.0, "ms": 1e-3, "us": 1e-6}


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None for other files."""
    return "nid" if file.content.startswith(_MARK) else None


def records(file: LabFile) -> list[TackRecord]:
    """Return the forward, pause and backward curves as one record.

    Raises
    ------
    ValueError
        If the header is incomplete, a curve is truncated, or there is no force.
    """
    end = file.content.find(_END)
    if not file.content.startswith(_MARK) or end < 0:
        raise file.error("the header has no end; the file is truncated or not a .nid file")
    sections = _sections(file.content[:end].decode("latin-1"))
    curves = _curves(file, sections, file.content[end + len(_END) :])
    force, position, time = [], [], []
    clock = 0.0
    step, notes = _step(file, sections)
    for frame in ("Spec forward", "Spec fwd pause", "Spec backward", "Spec bwd pause"):
        one = {channel: values for (where, channel), values in curves.items() if where == frame}
        if not one:
            continue
        if "Deflection" not in one:
            raise file.error(f'the part "{frame}" has no deflection in newtons')
        height = one.get("Z-Axis Sensor", one.get("Z-Axis"))
        if height is None:
            raise file.error(f'the part "{frame}" has no height')
        deflection = one["Deflection"]
        if height.size != deflection.size:
            raise file.error(f'in "{frame}" height and deflection differ in length')
        if frame == "Spec backward":
            # stored in the direction of the forward part, like the lines of an image
            deflection, height = deflection[::-1], height[::-1]
        force.append(deflection)
        position.append(height)
        time.append(clock + step * np.arange(1, height.size + 1))
        clock = float(time[-1][-1]) if height.size else clock
    if not force:
        raise file.error("the file has no part Spec forward or Spec backward; it may be an image")
    # direction unknown: when the head is lowered, the numbers rise on some heads and fall on others
    return recorded(file, "nid", notes, map(np.concatenate, (time, force, position)))


def _sections(text: str) -> dict[str, Words]:
    found: dict[str, Words] = {}
    current: Words = {}
    for line in text.splitlines():
        if line.startswith("[") and line.rstrip().endswith("]"):
            current = found.setdefault(line.strip()[1:-1], {})
        elif "=" in line:
            key, _, value = line.partition("=")
            current[key.strip()] = value.strip()
    return found


def _curves(
    file: LabFile, sections: dict[str, Words], content: bytes
) -> dict[tuple[str, str], Array]:
    """Return the spectroscopy curves by part and channel, in SI."""
    order = [
        match[0]
        for value in sections.get("DataSet", {}).values()
        if (match := _CURVE.fullmatch(value))
    ]
    found: dict[tuple[str, str], Array] = {}
    at = 0
    for title in order:
        head = sections.get(title)
        if head is None:
            raise file.error(f"the header has no section [{title}]")
        label = f"[{title}]: "
        points, lines = whole(file, head, "Points", label), whole(file, head, "Lines", label)
        bits = whole(file, head, "SaveBits", label)
        if bits not in (8, 16, 32) or head.get("SaveOrder", "Intel") != "Intel":
            raise file.error(f"[{title}] has an unsupported encoding ({bits} bits)")
        if head.get("SaveSign", "Signed") != "Signed" or points * lines > _MOST:
            raise file.error(f"[{title}] is unsigned, or is too long")
        size = points * lines * bits // 8
        piece = content[at : at + size]
        if len(piece) < size:
            raise file.error(
                f"[{title}] ends after {len(piece)} of {size} bytes; the file is truncated"
            )
        at += size
        frame, channel = head.get("Frame", ""), head.get("Dim2Name", "")
        if not frame.startswith("Spec") or not size:
            continue
        wanted = {"Deflection": "N", "Z-Axis Sensor": "m", "Z-Axis": "m"}.get(channel)
        if wanted is None or head.get("Dim2Unit") != wanted:
            continue
        if lines > 1:
            raise file.error(f"[{title}] contains {lines} curves; export one curve per file")
        low, span = real(file, head, "Dim2Min", label), real(file, head, "Dim2Range", label)
        counts = np.frombuffer(piece, dtype=f"<i{bits // 8}").astype(float)
        found[frame, channel] = low + span * (counts / 2.0**bits + 0.5)
    return found


def _step(file: LabFile, sections: dict[str, Words]) -> tuple[float, tuple[str, ...]]:
    """Return the time between points [s], and notes."""
    for key, section in sections.items():
        if not key.endswith("Spec") or "Modulation time" not in section:
            continue
        match = _TIME.fullmatch(section["Modulation time"])
        planned = whole(file, section, "Data points", f"[{key}]: ")
        if match is None or planned < 2 or not float(match[1]):
            break
        return float(match[1]) * _PARTS[match[2]] / planned, (
            f"{planned} equidistant points were planned in {section['Modulation time']}",
        )
    raise file.error("the header lacks the modulation time and the number of points")
