"""Simulation: boundary elements in space, retardation modes in time, tractions across the gap."""

import warnings
from importlib import import_module
from typing import Any

from viscotack.bem.settings import DEFAULT_ACCURACY, Accuracy, Settings
from viscotack.bem.solver import SimulationError

__all__ = ["DEFAULT_ACCURACY", "Accuracy", "Settings", "SimulationError"]

# Kept for a release (docs/migration.md).
_MOVED = ("CrackContact", "crack_contact", "has_start", "solve")


def __getattr__(name: str) -> Any:
    """Find a name where it is now."""
    if name not in _MOVED:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    new = "viscotack.methods"
    warnings.warn(f"{__name__}.{name} is {new}.{name} now", DeprecationWarning, stacklevel=2)
    return getattr(import_module(new), name)
