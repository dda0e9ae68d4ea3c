"""Laboratory data: frequency sweeps, master curves, relaxation and creep tests, and their fits."""

from viscotack.materials.shift import FittedShift as ShiftFit

from .fit_passport import issued
from .fit_report import FitReport
from .fitting import fit
from .in_time import superposed
from .judging import Superposition, contradiction, superposition
from .kramers_kronig import Consistency, consistency, loss_from_storage
from .master_curves import master_curve
from .options import Options
from .reading import (
    FORMATS,
    read,
    read_creep,
    read_creeps,
    read_dma,
    read_relaxation,
    read_relaxations,
    read_shifts,
)
from .shift_laws import fit_arrhenius, fit_wlf, nearest_law
from .shift_spread import allow_for_shifts
from .shifting import shift_factors
from .sweeps import CreepTest, FrequencySweeps, MasterCurve, RelaxationTest, ShiftTable, Source

__all__ = [
    "FORMATS",
    "Consistency",
    "CreepTest",
    "FitReport",
    "FrequencySweeps",
    "MasterCurve",
    "Options",
    "RelaxationTest",
    "ShiftFit",
    "ShiftTable",
    "Source",
    "Superposition",
    "allow_for_shifts",
    "consistency",
    "contradiction",
    "fit",
    "fit_arrhenius",
    "fit_wlf",
    "issued",
    "loss_from_storage",
    "master_curve",
    "nearest_law",
    "read",
    "read_creep",
    "read_creeps",
    "read_dma",
    "read_relaxation",
    "read_relaxations",
    "read_shifts",
    "shift_factors",
    "superposed",
    "superposition",
]
