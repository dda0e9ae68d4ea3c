"""Tack tests and force curves: reading, division into cycles, correction and evaluation.

A record contains the raw data of a test. A cycle is one approach, dwell and retraction, corrected
for zero, tilt, drift and compliance, with its pull-off force, work, depths and true speed.
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
