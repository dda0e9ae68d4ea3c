"""Rough surfaces in three dimensions, pulled off a soft body at a set rate."""

from .criteria import LONGEST_RANGE, stickiness
from .problem import RoughProblem, problem_of, read_rough, read_rough_case
from .pulling import pull

__all__ = [
    "LONGEST_RANGE",
    "RoughProblem",
    "problem_of",
    "pull",
    "read_rough",
    "read_rough_case",
    "stickiness",
]
