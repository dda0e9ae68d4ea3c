"""Simulation: boundary elements in space, retardation modes in time, tractions across the gap.

Names are imported on first use, because predictions do not simulate.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viscotack.simulate.settings import Settings
    from viscotack.simulate.solver import SimulationError, has_start, solve

_HOMES = {
    "Settings": "settings",
    "SimulationError": "solver",
    "has_start": "solver",
    "solve": "solver",
}
__all__ = ["Settings", "SimulationError", "has_start", "solve"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
