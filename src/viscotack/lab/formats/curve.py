"""Force curves of microscopes: the numbers of a file, and numbers of its headers."""

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array

from .file import LabFile

Words = Mapping[str, str]
MOST_POINTS = 5_000_000


class Curve(NamedTuple):
    """Numbers of a force curve in SI, as the instrument stored them.

    `into` is 1 if a larger position is deeper in the sample, -1 if it is further away, 0 if
    unknown; `stiffness` is that of the cantilever whose bending the position contains [N/m], or 0.
    """

    time: Array
    force: Array
    position: Array
    into: int = 0
    stiffness: float = 0.0
    notes: tuple[str, ...] = ()


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


def positive(file: LabFile, words: Words, key: str) -> float:
    """Return a positive number of a header; raise an error otherwise."""
    number = real(file, words, key)
    if number <= 0:
        raise file.error(f"{key} must be positive, got {number:g}")
    return number
