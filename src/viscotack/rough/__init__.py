"""Rough surfaces in three dimensions, pulled off a soft body at a set rate."""

from .criteria import Stickiness, stickiness
from .problem import RoughProblem, Zone
from .pulling import pull
from .result import RoughResult
from .rough_file import read_rough
from .superposition import Superposition, superposed

__all__ = [
    "RoughProblem",
    "RoughResult",
    "Stickiness",
    "Superposition",
    "Zone",
    "pull",
    "read_rough",
    "stickiness",
    "superposed",
]
