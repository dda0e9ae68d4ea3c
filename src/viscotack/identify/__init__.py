"""The interface from measured curves: which work of adhesion, which range, and how well known."""

from .objective import Best, Interval, Objective, Parameter
from .rate_series import PullOff, RateSeriesFit, identify_rates, pull_offs
from .slow_tests import ModelFit, SlowTest, SlowTestFit, fitted_force, identify_slow, slow_test

__all__ = [
    "Best",
    "Interval",
    "ModelFit",
    "Objective",
    "Parameter",
    "PullOff",
    "RateSeriesFit",
    "SlowTest",
    "SlowTestFit",
    "fitted_force",
    "identify_rates",
    "identify_slow",
    "pull_offs",
    "slow_test",
]
