"""A problem: material, traction law, geometry and protocol, in SI, in groups and in files."""

from .plane import PunchScales
from .problem import Case, Groups, Problem, PunchGroups
from .revolution import Scales

__all__ = ["Case", "Groups", "Problem", "PunchGroups", "PunchScales", "Scales"]
