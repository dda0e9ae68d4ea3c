"""Simulation: boundary elements in space, retardation modes in time, Lennard-Jones tractions."""

from viscotack.bem.settings import Settings
from viscotack.bem.solve import SimulationError, solve

__all__ = ["Settings", "SimulationError", "solve"]
