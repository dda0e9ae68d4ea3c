"""Control of a release: force tables, a controller, a simulated rig, and C, FMU and Octave."""

from .making import force_table as force_table
from .release import Release as Release
from .rig import Released as Released
from .rig import let_go as let_go
from .table import ForceTable as ForceTable
from .writing import c_header as c_header
from .writing import fmu as fmu
from .writing import octave_function as octave_function
