"""viscotack: how hard must one pull a soft, sticky, rate-dependent contact.

The public names, in the order in which data flow. A name is imported when it is first used, so
that ``import viscotack`` costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from . import bem as bem
    from . import campaign as campaign
    from . import datasets as datasets
    from . import materials as materials
    from . import measured as measured
    from . import theory as theory
    from .advice import Advice as Advice
    from .advice import Estimate as Estimate
    from .advice import advise as advise
    from .advice import threshold_contact_radius as threshold_contact_radius
    from .bem import SimulationError as SimulationError
    from .bem import solve as solve
    from .case_file import read_case as read_case
    from .dead_load import time_to_detachment as time_to_detachment
    from .forecast import predict as predict
    from .forecast_plot import draw_prediction as draw_prediction
    from .forecast_table import predict_table as predict_table
    from .geometry import Cone as Cone
    from .geometry import FlatPunch as FlatPunch
    from .geometry import PowerLawProfile as PowerLawProfile
    from .geometry import Sphere as Sphere
    from .layer import Bonded as Bonded
    from .layer import Frictionless as Frictionless
    from .layer import Layer as Layer
    from .materials import Elastic as Elastic
    from .materials import Prony as Prony
    from .materials import RelaxationPowerLaw as RelaxationPowerLaw
    from .materials import RetardationPowerLaw as RetardationPowerLaw
    from .materials import StandardSolid as StandardSolid
    from .observables import PullOff as PullOff
    from .observables import contact_radius_at_pull_off as contact_radius_at_pull_off
    from .observables import crack_speed_at_pull_off as crack_speed_at_pull_off
    from .observables import effective_surface_energy as effective_surface_energy
    from .observables import ligament_at_pull_off as ligament_at_pull_off
    from .observables import pull_off as pull_off
    from .observables import pull_off_depth as pull_off_depth
    from .observables import pull_off_force as pull_off_force
    from .observables import pull_off_stress as pull_off_stress
    from .observables import summary as summary
    from .observables import work_of_separation as work_of_separation
    from .observables import work_to_pull_off as work_to_pull_off
    from .plot import draw_energy as draw_energy
    from .plot import draw_force as draw_force
    from .plot import draw_overview as draw_overview
    from .plot import draw_radius as draw_radius
    from .plot import draw_rates as draw_rates
    from .plot import draw_regimes as draw_regimes
    from .plot import save_figure as save_figure
    from .prediction import OutOfRange as OutOfRange
    from .prediction import Prediction as Prediction
    from .prediction import prediction_summary as prediction_summary
    from .problem import Groups as Groups
    from .problem import Problem as Problem
    from .problem import Scales as Scales
    from .profile_problem import ProfileGroups as ProfileGroups
    from .profile_problem import ProfileProblem as ProfileProblem
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
    from .punch_problem import PunchGroups as PunchGroups
    from .punch_problem import PunchProblem as PunchProblem
    from .punch_problem import PunchScales as PunchScales
    from .record import from_dict as from_dict
    from .record import run_id as run_id
    from .record import to_dict as to_dict
    from .result import Event as Event
    from .result import Outcome as Outcome
    from .result import Result as Result
    from .result import columns as columns
    from .result import load as load
    from .result import save as save
    from .result import write_csv as write_csv
    from .traction import Dugdale as Dugdale
    from .traction import Exponential as Exponential
    from .traction import LennardJones as LennardJones
    from .traction import Tabulated as Tabulated
    from .units import parse as parse

# Module -> the public names it has.
_NAMES = {
    # words with units, and what a contact is made of
    "units": ("parse",),
    "traction": ("Dugdale", "Exponential", "LennardJones", "Tabulated"),
    "geometry": (
        "Sphere",
        "FlatPunch",
        "Cone",
        "PowerLawProfile",
    ),
    "layer": (
        "Layer",
        "Frictionless",
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
        "Prony",
        "RetardationPowerLaw",
        "RelaxationPowerLaw",
    ),
    # the problem, in SI and in groups, in memory and in files
    "problem": (
        "Problem",
        "Groups",
        "Scales",
    ),
    "punch_problem": (
        "PunchProblem",
        "PunchGroups",
        "PunchScales",
    ),
    "profile_problem": (
        "ProfileProblem",
        "ProfileGroups",
    ),
    "record": (
        "to_dict",
        "from_dict",
        "run_id",
    ),
    "case_file": ("read_case",),
    # the answer
    "bem": (
        "solve",
        "SimulationError",
    ),
    "result": (
        "Result",
        "Event",
        "Outcome",
        "save",
        "load",
        "columns",
        "write_csv",
    ),
    # which answer to trust
    "advice": (
        "advise",
        "Advice",
        "Estimate",
        "threshold_contact_radius",
    ),
    # the answer at once
    "forecast": ("predict",),
    "forecast_table": ("predict_table",),
    "prediction": (
        "Prediction",
        "OutOfRange",
        "prediction_summary",
    ),
    "forecast_plot": ("draw_prediction",),
    # its numbers and its pictures
    "dead_load": ("time_to_detachment",),
    "observables": (
        "PullOff",
        "pull_off",
        "pull_off_force",
        "pull_off_depth",
        "contact_radius_at_pull_off",
        "crack_speed_at_pull_off",
        "work_to_pull_off",
        "work_of_separation",
        "pull_off_stress",
        "ligament_at_pull_off",
        "effective_surface_energy",
        "summary",
    ),
    "plot": (
        "draw_energy",
        "draw_force",
        "draw_radius",
        "draw_overview",
        "draw_rates",
        "draw_regimes",
        "save_figure",
    ),
}
_ROOMS = ("materials", "theory", "bem", "measured", "campaign", "datasets")
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
