"""Headers of microscope files: keys, their numbers, and the resulting record."""

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
    """Return an integer of a header; raise an error if it is missing or malformed."""
    value = words.get(key, "")
    if re.fullmatch(r"[0-9]{1,8}", value) is None:
        raise file.error(f"{section}{key} must be an integer, got {value[:20]!r}")
    return int(value)


def real(file: LabFile, words: Words, key: str, section: str = "") -> float:
    """Return a finite number of a header; raise an error if it is missing or malformed."""
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
    """Return the record of a file from time, force, position and further fields.

    Raises
    ------
    ValueError
        As :class:`TackRecord`; the message names the file.
    """
    source = Source(file.path, file.sha256, format, (*file.notes, *notes))
    time, force, position = columns
    try:
        return [TackRecord(time, force, position, source=source, **more)]
    except InputError as error:
        raise file.error(str(error)) from None


def bending(stiffness: float) -> str:
    """Return the note on a cantilever [N/m]."""
    rig = f"cantilever of {readable(stiffness, 'N/m')}"
    return f"{rig}, whose deflection is subtracted from the height"
