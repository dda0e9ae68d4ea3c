"""Rough surfaces in three dimensions, pulled off a soft body at a set rate."""

from .criteria import Stickiness, stickiness
from .problem import RoughProblem, Zone
from .pulling import pull
from .result import RoughResult
from .rough_file import read_rough

__all__ = [
    "RoughProblem",
    "RoughResult",
    "Stickiness",
    "Zone",
    "pull",
    "read_rough",
    "stickiness",
]
