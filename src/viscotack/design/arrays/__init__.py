"""Arrays of pads on a common backing: force, order of detachment, load sharing and yield.

All pads are of one kind, with their own heights and works of adhesion, on a backing with springs,
tilt and curvature. Each follows the curve of one pad. The derivation is in docs/arrays.md.
"""

from .load import Hold, Holding, holding, preload_after
from .pulling import (
    ArrayPull,
    ArrayYield,
    Backing,
    PadArray,
    Scatter,
    array_yield,
    grid,
    pull_array,
)

__all__ = [
    "ArrayPull",
    "ArrayYield",
    "Backing",
    "Hold",
    "Holding",
    "PadArray",
    "Scatter",
    "array_yield",
    "grid",
    "holding",
    "preload_after",
    "pull_array",
]
