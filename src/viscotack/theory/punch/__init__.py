"""A flat punch comes off a layer."""

from . import (
    punch_crossover,
    punch_curve,
    punch_design,
    punch_laws,
    punch_map,
    punch_rate,
    punch_unloading,
)

__all__ = [
    "punch_crossover",
    "punch_curve",
    "punch_design",
    "punch_laws",
    "punch_map",
    "punch_rate",
    "punch_unloading",
]
