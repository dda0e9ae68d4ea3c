"""Contact problems: material, traction law, shape, body and protocol, in SI, groups and files."""

from .plane import PunchScales
from .problem import Case, Groups, Problem
from .revolution import Scales
from .rough_case import RoughCase, StatedSurface

__all__ = [
    "Case",
    "Groups",
    "Problem",
    "PunchScales",
    "RoughCase",
    "Scales",
    "StatedSurface",
]
