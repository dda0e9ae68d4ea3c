"""Campaigns: plan, run and store many simulations, on this machine or on a cluster."""

from viscotack.files.lock import FolderInUse
from viscotack.pool import NoWorker
from viscotack.problem.inputs import Input, inputs_of

from .case import CaseSettings, measure
from .cluster import Security
from .exporting import export
from .plan import Plan, every_combination, read_plan, space_filling
from .running import AllCrashed, Progress, run
from .sharing import merge, shard_of
from .store import Store
from .verifying import Verdict, verify

__all__ = [
    "AllCrashed",
    "CaseSettings",
    "FolderInUse",
    "Input",
    "NoWorker",
    "Plan",
    "Progress",
    "Security",
    "Store",
    "Verdict",
    "every_combination",
    "export",
    "inputs_of",
    "measure",
    "merge",
    "read_plan",
    "run",
    "shard_of",
    "space_filling",
    "verify",
]
