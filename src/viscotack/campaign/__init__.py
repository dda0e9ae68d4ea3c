"""Campaigns: plan, run and store many simulations, on this machine or on a cluster."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viscotack.model.problem.inputs import Input, inputs_of

    from .case import CaseSettings, measure
    from .plan import Case, Plan, every_combination, read_plan, shard_of, space_filling
    from .running import CannotRun, Dask, Progress, run
    from .store import FolderInUse, Store, export, merge

# Imported when they are asked for: predictions need the columns of cases only, also where there
# are no processes and no SQLite.
_HOMES = {
    "viscotack.model.problem.inputs": ("Input", "inputs_of"),
    ".case": ("CaseSettings", "measure"),
    ".plan": ("Case", "Plan", "every_combination", "read_plan", "shard_of", "space_filling"),
    ".running": ("CannotRun", "Dask", "Progress", "run"),
    ".store": ("FolderInUse", "Store", "export", "merge"),
}
__all__ = [
    "CannotRun",
    "Case",
    "CaseSettings",
    "Dask",
    "FolderInUse",
    "Input",
    "Plan",
    "Progress",
    "Store",
    "every_combination",
    "export",
    "inputs_of",
    "measure",
    "merge",
    "read_plan",
    "run",
    "shard_of",
    "space_filling",
]


def __getattr__(name: str) -> Any:
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(home, __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
