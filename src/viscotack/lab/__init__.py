"""Laboratory data: frequency sweeps, master curves, relaxation and creep tests, and their fits."""

from .fit.fitting import allow_for_shifts, fit
from .fit.master_curve import contradiction, master_curve, superposed
from .fit.report import FitReport, issued
from .fit.shift_factors import fit_arrhenius, fit_wlf, nearest_law, shift_factors
from .fit.superposition import at_one_temperature, superposition
from .options import Options, TackOptions
from .reading import (
    FORMATS,
    read,
    read_dma,
    read_shifts,
)
from .sweeps import CreepTest, FrequencySweeps, MasterCurve, RelaxationTest, Source

__all__ = [
    "FORMATS",
    "CreepTest",
    "FitReport",
    "FrequencySweeps",
    "MasterCurve",
    "Options",
    "RelaxationTest",
    "Source",
    "TackOptions",
    "allow_for_shifts",
    "at_one_temperature",
    "contradiction",
    "fit",
    "fit_arrhenius",
    "fit_wlf",
    "issued",
    "master_curve",
    "nearest_law",
    "read",
    "read_dma",
    "read_shifts",
    "shift_factors",
    "superposed",
    "superposition",
]
