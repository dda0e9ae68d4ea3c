"""Campaigns: many problems, what to run, where it is kept, and running it here or on a cluster."""

from viscotack.files.lock import FolderInUse

from .case import CaseSettings, measure
from .cluster import Security
from .crew import NoWorker
from .exporting import export
from .plan import Plan, read_plan
from .running import AllCrashed, Progress, run
from .sharing import merge, shard_of
from .store import Store
from .verifying import Verdict, verify

__all__ = [
    "AllCrashed",
    "CaseSettings",
    "FolderInUse",
    "NoWorker",
    "Plan",
    "Progress",
    "Security",
    "Store",
    "Verdict",
    "export",
    "measure",
    "merge",
    "read_plan",
    "run",
    "shard_of",
    "verify",
]
