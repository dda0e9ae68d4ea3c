"""Headers of microscope files: words of text, their numbers, and the record they make."""

import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.lab_file import LabFile
from viscotack.lab.sweeps import Source
from viscotack.units import readable

from .record import TackRecord

Words = dict[str, str]


def whole(file: LabFile, words: Words, key: str, section: str = "") -> int:
    """Return a whole number of a header, or say that there is none."""
    value = words.get(key, "")
    if re.fullmatch(r"[0-9]{1,8}", value) is None:
        raise file.error(f"{section}{key} must be a whole number, got {value[:20]!r}")
    return int(value)


def real(file: LabFile, words: Words, key: str, section: str = "") -> float:
    """Return a finite number of a header, or say that there is none."""
    value = words.get(key, "")
    try:
        number = float(value)
    except ValueError:
        number = np.nan
    if not np.isfinite(number):
        raise file.error(f"{section}{key} must be a number, got {value[:20]!r}")
    return number


def recorded(
    file: LabFile,
    format: str,
    notes: Sequence[str],
    columns: Iterable[Array],
    **more: Any,
) -> list[TackRecord]:
    """Return the one record of a file: time, force, position, and what the header says more.

    Raises
    ------
    ValueError
        As :class:`TackRecord`, with the name of the file.
    """
    source = Source(file.path, file.sha256, format, (*file.notes, *notes))
    time, force, position = columns
    try:
        return [TackRecord(time, force, position, source=source, **more)]
    except InputError as error:
        raise file.error(str(error)) from None


def bending(stiffness: float) -> str:
    """Return the note on a cantilever [N/m]."""
    return f"cantilever of {readable(stiffness, 'N/m')}, whose bending is taken off the height"
