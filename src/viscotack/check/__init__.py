"""Conformance checks for traction laws, materials, shapes, bodies, observables and tiers.

Each function checks one kind of object, whether it belongs to the package or is user-defined. It
returns a :class:`Report` of findings; ``raise_if_failed()`` raises an error if any check failed.
"""

from .bodies import check_body
from .findings import CheckFailed, Finding, Report
from .laws import check_law
from .materials import check_material
from .observables import check_observable
from .shapes import check_shape
from .tiers import Tier, check_tier

__all__ = [
    "CheckFailed",
    "Finding",
    "Report",
    "Tier",
    "check_body",
    "check_law",
    "check_material",
    "check_observable",
    "check_shape",
    "check_tier",
]
