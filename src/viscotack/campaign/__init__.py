"""Campaigns: plan, run and store many simulations, on this machine or on a cluster."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from viscotack.model.problem.inputs import Input, inputs_of

    from .case import CaseSettings, measure
    from .cluster import Dask
    from .exporting import export
    from .plan import Case, Plan, every_combination, read_plan, space_filling
    from .running import AllCrashed, NoWorker, Progress, run
    from .sharing import merge, shard_of
    from .store import FolderInUse, Store

__all__ = [
    "AllCrashed",
    "Case",
    "CaseSettings",
    "Dask",
    "FolderInUse",
    "Input",
    "NoWorker",
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
# Imported in this order until one has a name: predictions need the columns of cases only, also
# where there are no processes and no SQLite.
_HOMES = ("columns", "case", "plan", "exporting", "store", "running", "sharing", "cluster")


def __getattr__(name: str) -> Any:
    for home in _HOMES if name in __all__ else ():
        module = import_module(f".{home}", __name__)
        if name in vars(module):
            return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
