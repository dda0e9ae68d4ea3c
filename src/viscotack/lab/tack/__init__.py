"""Tack tests and force curves: reading, division into cycles, correction and evaluation.

A record contains the raw data of a test. A cycle is one approach, dwell and retraction, corrected
for zero, tilt, drift and compliance, with its pull-off force, work, depths and true speed.
"""

from .evaluation import Evaluation, Refusal, Survey, Unread, evaluate, survey
from .reading import FORMATS, read
from .record import Cycle, Measured, Segments, TackRecord

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
