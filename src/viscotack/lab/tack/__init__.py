"""Tack tests and force curves: read, cut into cycles, corrected, and what they say.

A record is what the rig wrote; a cycle is one approach, dwell and retraction with its zero, tilt,
drift and compliance taken off, and its pull-off, work, depths and true speed.
"""

from .cycle import Cycle, Measured
from .evaluation import Evaluation, Refusal, evaluate
from .reading import FORMATS, read
from .record import TackRecord
from .segments import Segments
from .surveying import Survey, Unread, survey

__all__ = [
    "FORMATS",
    "Cycle",
    "Evaluation",
    "Measured",
    "Refusal",
    "Segments",
    "Survey",
    "TackRecord",
    "Unread",
    "evaluate",
    "read",
    "survey",
]
