"""viscotack: predict and simulate the detachment of soft, viscoelastic, adhesive contacts.

The public names are listed in the order in which data flow. Each is imported on first use, so
``import viscotack`` imports no other library.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .version import __version__

if TYPE_CHECKING:
    from . import bem as bem
    from . import campaign as campaign
    from . import datasets as datasets
    from . import lab as lab
    from . import materials as materials
    from . import operations as operations
    from . import theory as theory
    from .bem import SimulationError as SimulationError
    from .cards import Quantity as Quantity
    from .design import Design as Design
    from .design import DesignSpace as DesignSpace
    from .design import Targets as Targets
    from .design import find_design as find_design
    from .design import read_design as read_design
    from .design.arrays import ArrayPull as ArrayPull
    from .design.arrays import ArrayYield as ArrayYield
    from .design.arrays import Backing as Backing
    from .design.arrays import PadArray as PadArray
    from .design.arrays import Scatter as Scatter
    from .design.arrays import array_yield as array_yield
    from .design.arrays import pull_array as pull_array
    from .design.window import CriticalSpeed as CriticalSpeed
    from .design.window import SeriesOpening as SeriesOpening
    from .design.window import SeriesResult as SeriesResult
    from .design.window import Window as Window
    from .design.window import simulate_in_series as simulate_in_series
    from .design.window import which_opens as which_opens
    from .design.window import window as window
    from .errors import InputError as InputError
    from .errors import NotInstalled as NotInstalled
    from .errors import OutOfRange as OutOfRange
    from .geometry import Bonded as Bonded
    from .geometry import Cone as Cone
    from .geometry import Disc as Disc
    from .geometry import FlatPunch as FlatPunch
    from .geometry import Frictionless as Frictionless
    from .geometry import HalfSpace as HalfSpace
    from .geometry import Layer as Layer
    from .geometry import MeasuredProfile as MeasuredProfile
    from .geometry import PowerLawProfile as PowerLawProfile
    from .geometry import Sphere as Sphere
    from .geometry import WavySphere as WavySphere
    from .materials import Elastic as Elastic
    from .materials import FractionalZener as FractionalZener
    from .materials import Prony as Prony
    from .materials import RelaxationPowerLaw as RelaxationPowerLaw
    from .materials import RetardationPowerLaw as RetardationPowerLaw
    from .materials import StandardSolid as StandardSolid
    from .methods import CrackContact as CrackContact
    from .methods import crack_contact as crack_contact
    from .methods import solve as solve
    from .operations import ask as ask
    from .plot.material import draw_fit as draw_fit
    from .plot.prediction import draw_prediction as draw_prediction
    from .plot.regimes import draw_regimes as draw_regimes
    from .plot.simulation import draw_energy as draw_energy
    from .plot.simulation import draw_force as draw_force
    from .plot.simulation import draw_overview as draw_overview
    from .plot.simulation import draw_radius as draw_radius
    from .plot.style import save_figure as save_figure
    from .prediction import Advice as Advice
    from .prediction import Estimate as Estimate
    from .prediction import Prediction as Prediction
    from .prediction import advise as advise
    from .prediction import predict as predict
    from .prediction import predict_table as predict_table
    from .prediction import prediction_summary as prediction_summary
    from .prediction import threshold_contact_radius as threshold_contact_radius
    from .prediction.uncertainty import Uncertainty as Uncertainty
    from .prediction.uncertainty import uncertainty as uncertainty
    from .problem import Groups as Groups
    from .problem import Problem as Problem
    from .problem import PunchScales as PunchScales
    from .problem import Scales as Scales
    from .problem.case_file import read_case as read_case
    from .problem.record import from_dict as from_dict
    from .problem.record import run_id as run_id
    from .problem.record import to_dict as to_dict
    from .protocol import Apart as Apart
    from .protocol import Approach as Approach
    from .protocol import AtDepth as AtDepth
    from .protocol import AtForce as AtForce
    from .protocol import AtRadius as AtRadius
    from .protocol import Dwell as Dwell
    from .protocol import LoadTo as LoadTo
    from .protocol import MoveTo as MoveTo
    from .protocol import Retract as Retract
    from .protocol import Retraction as Retraction
    from .result import Energies as Energies
    from .result import Event as Event
    from .result import Outcome as Outcome
    from .result import Result as Result
    from .result import columns as columns
    from .result import load as load
    from .result import save as save
    from .result import write_csv as write_csv
    from .result.cycles import Cycle as Cycle
    from .result.cycles import cycles as cycles
    from .result.cycles import write_cycles as write_cycles
    from .result.dead_load import time_to_detachment as time_to_detachment
    from .result.edge_energy import EdgeEnergy as EdgeEnergy
    from .result.edge_energy import edge_energy as edge_energy
    from .result.loops import Loop as Loop
    from .result.observables import Observable as Observable
    from .result.observables import PullOff as PullOff
    from .result.observables import contact_radius_at_pull_off as contact_radius_at_pull_off
    from .result.observables import crack_speed_at_pull_off as crack_speed_at_pull_off
    from .result.observables import depth_at_pull_off as depth_at_pull_off
    from .result.observables import effective_surface_energy as effective_surface_energy
    from .result.observables import ligament_at_pull_off as ligament_at_pull_off
    from .result.observables import peaks as peaks
    from .result.observables import pull_off as pull_off
    from .result.observables import pull_off_force as pull_off_force
    from .result.observables import pull_off_stress as pull_off_stress
    from .result.observables import summary as summary
    from .result.observables import work_of_separation as work_of_separation
    from .result.observables import work_to_pull_off as work_to_pull_off
    from .traction import Dugdale as Dugdale
    from .traction import Exponential as Exponential
    from .traction import Eyring as Eyring
    from .traction import GentSchultz as GentSchultz
    from .traction import LennardJones as LennardJones
    from .traction import LogarithmicAgeing as LogarithmicAgeing
    from .traction import SaturatingAgeing as SaturatingAgeing
    from .traction import Tabulated as Tabulated
    from .units import parse as parse

# Module -> its public names, in the order in which data flow.
_NAMES = {
    "units": ("parse",),
    "errors": ("InputError", "OutOfRange", "NotInstalled"),
    "cards": ("Quantity",),
    "traction": (
        "Dugdale",
        "Exponential",
        "Eyring",
        "GentSchultz",
        "LennardJones",
        "LogarithmicAgeing",
        "SaturatingAgeing",
        "Tabulated",
    ),
    "geometry": (
        "Sphere",
        "FlatPunch",
        "Cone",
        "PowerLawProfile",
        "WavySphere",
        "MeasuredProfile",
        "Disc",
        "Layer",
        "Frictionless",
        "HalfSpace",
        "Bonded",
    ),
    "protocol": (
        "AtDepth",
        "AtForce",
        "AtRadius",
        "Apart",
        "Approach",
        "Retract",
        "MoveTo",
        "Dwell",
        "LoadTo",
        "Retraction",
    ),
    "materials": (
        "Elastic",
        "StandardSolid",
        "FractionalZener",
        "Prony",
        "RetardationPowerLaw",
        "RelaxationPowerLaw",
    ),
    "problem": ("Problem", "Groups", "Scales", "PunchScales"),
    "problem.record": ("to_dict", "from_dict", "run_id"),
    "problem.case_file": ("read_case",),
    "bem": ("SimulationError",),
    "methods": ("solve", "crack_contact", "CrackContact"),
    "result": ("Result", "Energies", "Event", "Outcome", "save", "load", "columns", "write_csv"),
    "result.observables": (
        "Observable",
        "PullOff",
        "pull_off",
        "peaks",
        "pull_off_force",
        "depth_at_pull_off",
        "contact_radius_at_pull_off",
        "crack_speed_at_pull_off",
        "work_to_pull_off",
        "work_of_separation",
        "pull_off_stress",
        "ligament_at_pull_off",
        "effective_surface_energy",
        "summary",
    ),
    "result.cycles": ("Cycle", "cycles", "write_cycles"),
    "result.dead_load": ("time_to_detachment",),
    "result.edge_energy": ("EdgeEnergy", "edge_energy"),
    "result.loops": ("Loop",),
    "prediction": (
        "advise",
        "Advice",
        "Estimate",
        "predict",
        "predict_table",
        "Prediction",
        "prediction_summary",
        "threshold_contact_radius",
    ),
    "plot.simulation": (
        "draw_energy",
        "draw_force",
        "draw_radius",
        "draw_overview",
    ),
    "plot.regimes": ("draw_regimes",),
    "plot.style": ("save_figure",),
    "plot.material": ("draw_fit",),
    "design.window": (
        "which_opens",
        "SeriesOpening",
        "simulate_in_series",
        "SeriesResult",
        "window",
        "Window",
        "CriticalSpeed",
    ),
    "design.arrays": (
        "PadArray",
        "Backing",
        "pull_array",
        "ArrayPull",
        "Scatter",
        "array_yield",
        "ArrayYield",
    ),
    "design": ("find_design", "read_design", "Design", "DesignSpace", "Targets"),
    "prediction.uncertainty": ("uncertainty", "Uncertainty"),
    "plot.prediction": ("draw_prediction",),
    "operations": ("ask",),
}
_ROOMS = (
    "materials",
    "theory",
    "bem",
    "lab",
    "campaign",
    "datasets",
    "operations",
)
_HOMES = {name: module for module, names in _NAMES.items() for name in names}

__all__ = ["__version__", *_ROOMS, *_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    if name in _ROOMS:
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module 'viscotack' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
