"""Campaigns: many problems, what to run, where it is kept, and running it here or on a cluster."""

from .case import CaseSettings, measure
from .export import export
from .lock import FolderInUse
from .plan import Plan, read_plan
from .run import AllCrashed, Progress, run
from .store import Store

__all__ = [
    "AllCrashed",
    "CaseSettings",
    "FolderInUse",
    "Plan",
    "Progress",
    "Store",
    "export",
    "measure",
    "read_plan",
    "run",
]
