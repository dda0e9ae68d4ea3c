"""Control of a release: force tables, a controller, a simulated rig, C and FMU."""

from .making import force_table
from .release import Release
from .rig import Released, let_go
from .table import ForceTable
from .writing import c_header, fmu

__all__ = [
    "ForceTable",
    "Release",
    "Released",
    "c_header",
    "fmu",
    "force_table",
    "let_go",
]
