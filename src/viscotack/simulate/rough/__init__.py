"""Rough surfaces in three dimensions, pulled off a soft body at a set rate."""

from .criteria import LONGEST_RANGE, Stickiness, stickiness
from .problem import RoughProblem, Zone, problem_of, read_rough, read_rough_case
from .pulling import pull
from .result import RoughResult

__all__ = [
    "LONGEST_RANGE",
    "RoughProblem",
    "RoughResult",
    "Stickiness",
    "Zone",
    "problem_of",
    "pull",
    "read_rough",
    "read_rough_case",
    "stickiness",
]
