"""Conformance: does a law, solid, shape, body, observable or tier keep what the package relies on.

One function for each kind of noun, for those of the package and for one's own alike. Each gives a
:class:`Report` of findings in words; ``raise_if_failed()`` makes an error of them.
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
