"""Simulation: boundary elements in space, retardation modes in time, tractions across the gap."""

from viscotack.bem.by_crack import CrackContact, crack_contact
from viscotack.bem.settings import DEFAULT_ACCURACY, Accuracy, Settings
from viscotack.bem.solver import SimulationError
from viscotack.bem.solving import has_start, solve

__all__ = [
    "DEFAULT_ACCURACY",
    "Accuracy",
    "CrackContact",
    "Settings",
    "SimulationError",
    "crack_contact",
    "has_start",
    "solve",
]
