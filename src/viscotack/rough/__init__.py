"""Rough surfaces in three dimensions, pulled off a soft body at a set rate."""

from .problem import RoughProblem, Zone
from .pulling import pull
from .result import RoughResult
from .rough_file import read_rough

__all__ = ["RoughProblem", "RoughResult", "Zone", "pull", "read_rough"]
