"""Conversion of numbers to JSON: plain lists, None for missing values."""

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

# What a curve is drawn from needs no more digits, and every one of them is sent.
_DRAWN = 7


def plain(value: Any) -> Any:
    """Convert a value to JSON types: arrays to lists, objects to tables, NaN and infinity to None.

    Examples
    --------
    >>> plain({"force": np.array([1.0, np.nan]), "steps": np.int64(3)})
    {'force': [1.0, None], 'steps': 3}
    """
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if is_dataclass(value):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def drawn(values: Any) -> list[float | None]:
    """Return the numbers of a curve with the digits that a picture needs."""
    return [
        float(f"{x:.{_DRAWN}g}") if np.isfinite(x) else None
        for x in np.asarray(values, dtype=float).tolist()
    ]
