"""Simulation: boundary elements in space, retardation modes in time, tractions across the gap."""

from viscotack.bem.settings import DEFAULT_ACCURACY, Accuracy, Settings
from viscotack.bem.solver import SimulationError

__all__ = ["DEFAULT_ACCURACY", "Accuracy", "Settings", "SimulationError"]
