"""Design of pads for wanted forces: radius, preload, number and speeds.

The search uses the fast tiers with their intervals, and a simulation of the best candidates
decides. docs/design.md describes file, method and limits.
"""

from .files import ArrayFile, DesignFile, WindowFile, read_array, read_design, read_window
from .finding import Design, find_design
from .margins import Candidate, Limit, Simulated
from .space import Bounds, Choice, Conditions, DesignSpace, Targets

__all__ = [
    "ArrayFile",
    "Bounds",
    "Candidate",
    "Choice",
    "Conditions",
    "Design",
    "DesignFile",
    "DesignSpace",
    "Limit",
    "Simulated",
    "Targets",
    "WindowFile",
    "find_design",
    "read_array",
    "read_design",
    "read_window",
]
