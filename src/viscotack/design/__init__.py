"""Design of pads for wanted forces: radius, preload, number and speeds.

The search uses the fast tiers with their intervals, and a simulation of the best candidates
decides. docs/design.md describes file, method and limits.
"""

from .design_file import DesignFile, read_design
from .finding import Design, find_design
from .limits import Limit
from .margins import Candidate, Simulated
from .space import Bounds, Choice, Conditions, DesignSpace, Targets

__all__ = [
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
    "find_design",
    "read_design",
]
