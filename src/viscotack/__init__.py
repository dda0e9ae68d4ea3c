"""viscotack: predict and simulate the detachment of soft, viscoelastic, adhesive contacts.

The public names are listed in the order in which data flow. Each is imported on first use, so
``import viscotack`` imports no other library.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from viscotack.version import __version__

if TYPE_CHECKING:
    from viscotack.app.operations import ask as ask
    from viscotack.cards import Quantity as Quantity
    from viscotack.design import Design as Design
    from viscotack.design import DesignSpace as DesignSpace
    from viscotack.design import Targets as Targets
    from viscotack.design import find_design as find_design
    from viscotack.design import read_design as read_design
    from viscotack.design.arrays import ArrayPull as ArrayPull
    from viscotack.design.arrays import ArrayYield as ArrayYield
    from viscotack.design.arrays import Backing as Backing
    from viscotack.design.arrays import PadArray as PadArray
    from viscotack.design.arrays import Scatter as Scatter
    from viscotack.design.arrays import array_yield as array_yield
    from viscotack.design.arrays import pull_array as pull_array
    from viscotack.design.window import CriticalSpeed as CriticalSpeed
    from viscotack.design.window import SeriesOpening as SeriesOpening
    from viscotack.design.window import SeriesResult as SeriesResult
    from viscotack.design.window import Window as Window
    from viscotack.design.window import simulate_in_series as simulate_in_series
    from viscotack.design.window import which_opens as which_opens
    from viscotack.design.window import window as window
    from viscotack.errors import InputError as InputError
    from viscotack.errors import NotInstalled as NotInstalled
    from viscotack.errors import OutOfRange as OutOfRange
    from viscotack.model.geometry import Bonded as Bonded
    from viscotack.model.geometry import Cone as Cone
    from viscotack.model.geometry import Disc as Disc
    from viscotack.model.geometry import FlatPunch as FlatPunch
    from viscotack.model.geometry import Frictionless as Frictionless
    from viscotack.model.geometry import HalfSpace as HalfSpace
    from viscotack.model.geometry import Layer as Layer
    from viscotack.model.geometry import MeasuredProfile as MeasuredProfile
    from viscotack.model.geometry import PowerLawProfile as PowerLawProfile
    from viscotack.model.geometry import Sphere as Sphere
    from viscotack.model.geometry import WavySphere as WavySphere
    from viscotack.model.materials import Elastic as Elastic
    from viscotack.model.materials import FractionalZener as FractionalZener
    from viscotack.model.materials import Prony as Prony
    from viscotack.model.materials import RelaxationPowerLaw as RelaxationPowerLaw
    from viscotack.model.materials import RetardationPowerLaw as RetardationPowerLaw
    from viscotack.model.materials import StandardSolid as StandardSolid
    from viscotack.model.problem import Groups as Groups
    from viscotack.model.problem import Problem as Problem
    from viscotack.model.problem import PunchScales as PunchScales
    from viscotack.model.problem import Scales as Scales
    from viscotack.model.problem.case_file import from_dict as from_dict
    from viscotack.model.problem.case_file import read_case as read_case
    from viscotack.model.problem.case_file import run_id as run_id
    from viscotack.model.problem.case_file import to_dict as to_dict
    from viscotack.model.protocol import Apart as Apart
    from viscotack.model.protocol import Approach as Approach
    from viscotack.model.protocol import AtDepth as AtDepth
    from viscotack.model.protocol import AtForce as AtForce
    from viscotack.model.protocol import AtRadius as AtRadius
    from viscotack.model.protocol import Dwell as Dwell
    from viscotack.model.protocol import LoadTo as LoadTo
    from viscotack.model.protocol import MoveTo as MoveTo
    from viscotack.model.protocol import Retract as Retract
    from viscotack.model.protocol import Retraction as Retraction
    from viscotack.model.traction import Dugdale as Dugdale
    from viscotack.model.traction import Exponential as Exponential
    from viscotack.model.traction import Eyring as Eyring
    from viscotack.model.traction import GentSchultz as GentSchultz
    from viscotack.model.traction import LennardJones as LennardJones
    from viscotack.model.traction import LogarithmicAgeing as LogarithmicAgeing
    from viscotack.model.traction import SaturatingAgeing as SaturatingAgeing
    from viscotack.model.traction import Tabulated as Tabulated
    from viscotack.plot.design import draw_regimes as draw_regimes
    from viscotack.plot.material import draw_fit as draw_fit
    from viscotack.plot.prediction import draw_prediction as draw_prediction
    from viscotack.plot.simulation import draw_energy as draw_energy
    from viscotack.plot.simulation import draw_force as draw_force
    from viscotack.plot.simulation import draw_overview as draw_overview
    from viscotack.plot.simulation import draw_radius as draw_radius
    from viscotack.plot.style import save_figure as save_figure
    from viscotack.prediction.advice import Advice as Advice
    from viscotack.prediction.advice import advise as advise
    from viscotack.prediction.closed_forms import Estimate as Estimate
    from viscotack.prediction.predict import predict as predict
    from viscotack.prediction.prediction import Prediction as Prediction
    from viscotack.prediction.prediction import prediction_summary as prediction_summary
    from viscotack.prediction.table import predict_table as predict_table
    from viscotack.prediction.uncertainty import Uncertainty as Uncertainty
    from viscotack.prediction.uncertainty import uncertainty as uncertainty
    from viscotack.result import Energies as Energies
    from viscotack.result import Event as Event
    from viscotack.result import Outcome as Outcome
    from viscotack.result import Result as Result
    from viscotack.result import columns as columns
    from viscotack.result import load as load
    from viscotack.result import save as save
    from viscotack.result import write_csv as write_csv
    from viscotack.result.cycles import Cycle as Cycle
    from viscotack.result.cycles import Loop as Loop
    from viscotack.result.cycles import cycles as cycles
    from viscotack.result.cycles import time_to_detachment as time_to_detachment
    from viscotack.result.cycles import write_cycles as write_cycles
    from viscotack.result.edge_energy import EdgeEnergy as EdgeEnergy
    from viscotack.result.edge_energy import edge_energy as edge_energy
    from viscotack.result.observables import Observable as Observable
    from viscotack.result.observables import PullOff as PullOff
    from viscotack.result.observables import (
        contact_radius_at_pull_off as contact_radius_at_pull_off,
    )
    from viscotack.result.observables import crack_speed_at_pull_off as crack_speed_at_pull_off
    from viscotack.result.observables import depth_at_pull_off as depth_at_pull_off
    from viscotack.result.observables import effective_surface_energy as effective_surface_energy
    from viscotack.result.observables import ligament_at_pull_off as ligament_at_pull_off
    from viscotack.result.observables import peaks as peaks
    from viscotack.result.observables import pull_off as pull_off
    from viscotack.result.observables import pull_off_force as pull_off_force
    from viscotack.result.observables import pull_off_stress as pull_off_stress
    from viscotack.result.observables import summary as summary
    from viscotack.result.observables import work_of_separation as work_of_separation
    from viscotack.result.observables import work_to_pull_off as work_to_pull_off
    from viscotack.simulate import SimulationError as SimulationError
    from viscotack.simulate.crack_contact.by_crack import CrackContact as CrackContact
    from viscotack.simulate.crack_contact.by_crack import crack_contact as crack_contact
    from viscotack.simulate.solver import solve as solve
    from viscotack.units import parse as parse

    from . import campaign as campaign
    from . import datasets as datasets
    from . import lab as lab
    from . import simulate as simulate
    from . import theory as theory
    from .app import operations as operations
    from .design import control as control
    from .model import materials as materials

# Module -> its public names, in the order in which data flow.
_NAMES = {
    "units": "parse",
    "errors": "InputError OutOfRange NotInstalled",
    "cards": "Quantity",
    "model.traction": (
        "Dugdale Exponential Eyring GentSchultz LennardJones LogarithmicAgeing SaturatingAgeing "
        "Tabulated"
    ),
    "model.geometry": (
        "Sphere FlatPunch Cone PowerLawProfile WavySphere MeasuredProfile Disc Layer Frictionless "
        "HalfSpace Bonded"
    ),
    "model.protocol": (
        "AtDepth AtForce AtRadius Apart Approach Retract MoveTo Dwell LoadTo Retraction"
    ),
    "model.materials": (
        "Elastic StandardSolid FractionalZener Prony RetardationPowerLaw RelaxationPowerLaw"
    ),
    "model.problem": "Problem Groups Scales PunchScales",
    "model.problem.case_file": "read_case to_dict from_dict run_id",
    "simulate": "SimulationError",
    "simulate.solver": "solve",
    "simulate.crack_contact.by_crack": "crack_contact CrackContact",
    "result": "Result Energies Event Outcome save load columns write_csv",
    "result.observables": (
        "Observable PullOff pull_off peaks pull_off_force depth_at_pull_off "
        "contact_radius_at_pull_off crack_speed_at_pull_off work_to_pull_off work_of_separation "
        "pull_off_stress ligament_at_pull_off effective_surface_energy summary"
    ),
    "result.cycles": "Cycle Loop cycles time_to_detachment write_cycles",
    "result.edge_energy": "EdgeEnergy edge_energy",
    "prediction.advice": "advise Advice",
    "prediction.closed_forms": "Estimate",
    "prediction.predict": "predict",
    "prediction.table": "predict_table",
    "prediction.prediction": "Prediction prediction_summary",
    "plot.simulation": "draw_energy draw_force draw_radius draw_overview",
    "plot.design": "draw_regimes",
    "plot.style": "save_figure",
    "plot.material": "draw_fit",
    "design.window": (
        "which_opens SeriesOpening simulate_in_series SeriesResult window Window CriticalSpeed"
    ),
    "design.arrays": "PadArray Backing pull_array ArrayPull Scatter array_yield ArrayYield",
    "design": "find_design read_design Design DesignSpace Targets",
    "prediction.uncertainty": "uncertainty Uncertainty",
    "plot.prediction": "draw_prediction",
    "app.operations": "ask",
}
# Room -> its module.
_ROOMS = {
    "materials": "model.materials",
    "theory": "theory",
    "simulate": "simulate",
    "lab": "lab",
    "campaign": "campaign",
    "datasets": "datasets",
    "operations": "app.operations",
    "control": "design.control",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = ["__version__", *_ROOMS, *_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f".{_HOMES[name]}", __name__), name)
    if name in _ROOMS:
        return import_module(f".{_ROOMS[name]}", __name__)
    raise AttributeError(f"module 'viscotack' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
