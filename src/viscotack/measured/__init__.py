"""What laboratories have, and what it says: sweeps, master curves, relaxation and creep tests."""

from viscotack.measured.draw import draw_fit
from viscotack.measured.fit import fit
from viscotack.measured.fit_passport import issued
from viscotack.measured.fit_report import FitReport
from viscotack.measured.kramers_kronig import Consistency, consistency, loss_from_storage
from viscotack.measured.master_curve import master_curve
from viscotack.measured.reading import (
    FORMATS,
    read_creep,
    read_dma,
    read_relaxation,
    read_shifts,
)
from viscotack.measured.shift_laws import ShiftFit, fit_arrhenius, fit_wlf
from viscotack.measured.shifting import shift_factors
from viscotack.measured.sweeps import (
    CreepTest,
    FrequencySweeps,
    MasterCurve,
    RelaxationTest,
    ShiftTable,
    Source,
)

__all__ = [
    "FORMATS",
    "Consistency",
    "CreepTest",
    "FitReport",
    "FrequencySweeps",
    "MasterCurve",
    "RelaxationTest",
    "ShiftFit",
    "ShiftTable",
    "Source",
    "consistency",
    "draw_fit",
    "fit",
    "fit_arrhenius",
    "fit_wlf",
    "issued",
    "loss_from_storage",
    "master_curve",
    "read_creep",
    "read_dma",
    "read_relaxation",
    "read_shifts",
    "shift_factors",
]
