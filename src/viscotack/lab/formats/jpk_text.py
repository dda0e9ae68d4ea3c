"""Layout of JPK's text exports: a header in comments above each segment, then columns of numbers.

The header names the columns (``# columns: vDeflection measuredHeight seriesTime``) and their units
(``# units: N m s``), and the spring constant of the cantilever.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .file import Curve, LabFile, positive
from .jpk import HEIGHTS
from .numbers import number

_LOOKED = 300  # lines searched for the first header
# positions of the tip, from which the bending of the cantilever is already subtracted
_TIPS = ("verticalTipPosition", "tipSampleSeparation")


@dataclass
class _Segment:
    """Header and rows of one segment."""

    words: dict[str, str]
    rows: list[list[float]] = field(default_factory=list)

    @property
    def names(self) -> list[str]:
        """Names of the columns."""
        return self.words.get("columns", "").split()

    def column(self, file: LabFile, name: str, unit: str) -> Array:
        """Return a column; raise an error if it has another unit."""
        at = self.names.index(name)
        own = [*self.words.get("units", "").split(), *["no unit"] * (at + 1)][at]
        if own != unit:
            raise file.error(f"column {name} is in {own}; expected {unit}; calibrate the curve")
        return np.array([row[at] for row in self.rows])


def curves(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the consecutive segments of a force curve as one curve; None for other files.

    Raises
    ------
    ValueError
        If a row is damaged, a column is missing, or a force is not in newtons.
    """
    if not any(text.startswith("# columns:") for text in file.lines[:_LOOKED]):
        return None
    segments = [segment for segment in _segments(file) if segment.rows]
    if not segments:
        raise file.error("no segment has points below '# columns:' and '# units:'")
    shared = set.intersection(*(set(segment.names) for segment in segments))
    used = next((each for each in (*HEIGHTS, *_TIPS) if each in shared), None)
    if used is None or "vDeflection" not in shared:
        raise file.error(
            f"no vDeflection and height in {', '.join(segments[0].names)} of each segment"
        )
    if not shared & {"seriesTime", "time"}:
        raise file.error("no column seriesTime or time; export one of them")
    stiffness = 0.0 if used in _TIPS else positive(file, segments[0].words, "springConstant")
    time: list[Array] = []
    for segment in segments:
        # the time of a series, or of each segment from its own start
        clock = 0.0 if "seriesTime" in shared or not time else float(time[-1][-1])
        column = "seriesTime" if "seriesTime" in shared else "time"
        time.append(clock + segment.column(file, column, "s"))
    force = [segment.column(file, "vDeflection", "N") for segment in segments]
    position = [segment.column(file, used, "m") for segment in segments]
    numbers = [np.concatenate(column) for column in (time, force, position)]
    note = f"position from the column {used}"
    # heights increase away from the sample
    return [Curve(numbers[0], numbers[1], numbers[2], -1, stiffness, (note,))]


def _segments(file: LabFile) -> Iterator[_Segment]:
    segment = _Segment({})
    for line, text in enumerate(file.lines, start=1):
        if text.startswith("#"):
            if segment.rows:
                yield segment
                # what one header states holds for the next until it is stated again
                segment = _Segment(dict(segment.words))
            key, colon, value = text.lstrip("# ").partition(":")
            if colon:
                segment.words[key.strip()] = value.strip()
        elif text.strip():
            cells = text.split()
            if len(cells) != len(segment.names):
                raise file.error(f"{len(cells)} numbers under {len(segment.names)} columns", line)
            try:
                segment.rows.append([number(cell, ".") for cell in cells])
            except InputError as error:
                raise file.error(str(error), line) from None
    yield segment
