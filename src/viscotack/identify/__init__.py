"""The interface from measured curves: which work of adhesion, which range, and how well known."""

from .objective import Best, Interval, Objective, Parameter
from .slow_tests import ModelFit, SlowTest, SlowTestFit, fitted_force, identify_slow, slow_test

__all__ = [
    "Best",
    "Interval",
    "ModelFit",
    "Objective",
    "Parameter",
    "SlowTest",
    "SlowTestFit",
    "fitted_force",
    "identify_slow",
    "slow_test",
]
