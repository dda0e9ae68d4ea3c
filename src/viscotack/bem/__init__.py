"""Simulation: boundary elements in space, retardation modes in time, tractions across the gap."""

from viscotack.bem.settings import DEFAULT_ACCURACY, Accuracy, Settings
from viscotack.bem.solver import SimulationError
from viscotack.renamed import earlier_names

__all__ = ["DEFAULT_ACCURACY", "Accuracy", "Settings", "SimulationError"]

_MOVED = ("CrackContact", "crack_contact", "has_start", "solve")
__getattr__ = earlier_names(__name__, {name: f"viscotack.methods.{name}" for name in _MOVED})
