"""Conversion of numbers to JSON: plain lists, None for missing values."""

from typing import Any

import numpy as np
from pydantic_core import to_jsonable_python

# What a curve is drawn from needs no more digits, and every one of them is sent.
_DRAWN = 7


def plain(value: Any) -> Any:
    """Convert a value to JSON types: arrays to lists, objects to tables, NaN and infinity to None.

    Examples
    --------
    >>> plain({"force": np.array([1.0, np.nan]), "steps": np.int64(3)})
    {'force': [1.0, None], 'steps': 3}
    """
    return to_jsonable_python(value, inf_nan_mode="null", fallback=lambda other: other.tolist())


def drawn(values: Any) -> list[float | None]:
    """Return the numbers of a curve with the digits that a picture needs."""
    return [
        float(f"{x:.{_DRAWN}g}") if np.isfinite(x) else None
        for x in np.asarray(values, dtype=float).tolist()
    ]
