"""Identify the interface from measured curves: work of adhesion and range, with intervals.

A fit goes from data over a model and a likelihood to a result; sentences are made from its numbers.

============  ======================================================================
data          ``pull_off``, ``rate_series``
model         ``forward``, ``force_ratios``
likelihood    ``likelihood``, ``covariances``, ``search``
result        ``rate_fit``, ``forecasting``, ``ranked_tests``
sentences     ``words``
============  ======================================================================

Slow tests, one or a folder, go through ``slow_tests`` and ``contacts``, an approach through
``approach``, tests after several dwells through ``contact_time``. ``computed`` keeps forces for the
next time.
"""

from .approach import attraction, identify_approach
from .contact_time import identify_dwell
from .forecasting import RateForecast, forecast_edge, forecast_rates, interfaces
from .likelihood import Objective, Parameter, Posterior, posterior
from .pull_off import PullOff, Trial, pull_offs
from .ranked_tests import NextTests, next_tests
from .rate_fit import EdgeFit, RateSeriesFit, identify_edge, identify_rates
from .rate_series import RateSeries
from .slow_tests import (
    CurveGroup,
    SlowTest,
    SlowTestFit,
    fit_curves,
    fitted_force,
    group_curves,
    identify_slow,
    slow_test,
)

__all__ = [
    "CurveGroup",
    "EdgeFit",
    "NextTests",
    "Objective",
    "Parameter",
    "Posterior",
    "PullOff",
    "RateForecast",
    "RateSeries",
    "RateSeriesFit",
    "SlowTest",
    "SlowTestFit",
    "Trial",
    "attraction",
    "fit_curves",
    "fitted_force",
    "forecast_edge",
    "forecast_rates",
    "group_curves",
    "identify_approach",
    "identify_dwell",
    "identify_edge",
    "identify_rates",
    "identify_slow",
    "interfaces",
    "next_tests",
    "posterior",
    "pull_offs",
    "slow_test",
]
