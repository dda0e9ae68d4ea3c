"""Layout of JPK's text exports: a header in comments above each segment, then columns of numbers.

The header names the columns (``# columns: vDeflection measuredHeight seriesTime``) and their units
(``# units: N m s``), and the spring constant of the cantilever.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.lab_file import LabFile
from viscotack.lab.numbers import number

from .header import Words, bending, real, recorded
from .jpk_layout import HEIGHTS
from .record import TackRecord

_LOOKED = 300  # lines searched for the first header
# positions of the tip, from which the bending of the cantilever is already subtracted
_TIPS = ("verticalTipPosition", "tipSampleSeparation")


@dataclass
class _Segment:
    """Header and rows of one segment."""

    words: Words
    rows: list[list[float]] = field(default_factory=list)

    @property
    def names(self) -> list[str]:
        """Names of the columns."""
        return self.words.get("columns", "").split()

    def column(self, file: LabFile, name: str, unit: str) -> Array:
        """Return a column; raise an error if it has another unit."""
        at = self.names.index(name)
        units = self.words.get("units", "").split()
        own = units[at] if at < len(units) else "no unit"
        if own != unit:
            raise file.error(f"column {name} is in {own}; expected {unit}; calibrate the curve")
        return np.array([row[at] for row in self.rows])


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None for other files."""
    known = any(text.startswith("# columns:") for text in file.lines[:_LOOKED])
    return "jpk-text" if known else None


def records(file: LabFile) -> list[TackRecord]:
    """Return the consecutive segments of a force curve as one record.

    Raises
    ------
    ValueError
        If a row is damaged, a column is missing, or a force is not in newtons.
    """
    segments = [segment for segment in _segments(file) if segment.rows]
    if not segments:
        raise file.error("no segment has points below '# columns:' and '# units:'")
    shared = set.intersection(*(set(segment.names) for segment in segments))
    used = next((each for each in (*HEIGHTS, *_TIPS) if each in shared), None)
    if used is None or "vDeflection" not in shared:
        raise file.error(
            "each segment must have vDeflection and a height or position of the tip; the columns "
            f"are {', '.join(segments[0].names)}"
        )
    stiffness = 0.0
    if used not in _TIPS:
        stiffness = real(file, segments[0].words, "springConstant")
        if stiffness <= 0:
            raise file.error(f"springConstant must be positive, got {stiffness:g} N/m")
    force = [segment.column(file, "vDeflection", "N") for segment in segments]
    position = [segment.column(file, used, "m") for segment in segments]
    notes = [f"position from the column {used}"]
    return recorded(
        file,
        "jpk-text",
        [*notes, bending(stiffness)] if stiffness else notes,
        map(np.concatenate, (_times(file, segments, shared), force, position)),
        into=-1,  # heights increase away from the sample
        compliance=1 / stiffness if stiffness else 0.0,
    )


def _times(file: LabFile, segments: list[_Segment], shared: set[str]) -> list[Array]:
    """Return the times [s], from the start of the series or added up over the segments."""
    if "seriesTime" in shared:
        return [segment.column(file, "seriesTime", "s") for segment in segments]
    if "time" not in shared:
        raise file.error("no column seriesTime or time; export one of them")
    clock, found = 0.0, []
    for segment in segments:
        found.append(clock + segment.column(file, "time", "s"))
        clock = float(found[-1][-1])
    return found


def _segments(file: LabFile) -> Iterator[_Segment]:
    words: Words = {}
    segment = _Segment(words)
    for line, text in enumerate(file.lines, start=1):
        if text.startswith("#"):
            if segment.rows:
                yield segment
                # what one header states holds for the next until it is stated again
                words = dict(words)
            key, colon, value = text.lstrip("# ").partition(":")
            if colon:
                words[key.strip()] = value.strip()
            if segment.rows or colon:
                segment = _Segment(words)
        elif text.strip():
            segment.rows.append(_numbers(file, text, line, len(segment.names)))
    yield segment


def _numbers(file: LabFile, text: str, line: int, width: int) -> list[float]:
    cells = text.split()
    if len(cells) != width:
        raise file.error(
            f"{len(cells)} numbers under {width} columns; the file is damaged or truncated", line
        )
    try:
        return [number(cell, ".") for cell in cells]
    except InputError as error:
        raise file.error(str(error), line) from None
