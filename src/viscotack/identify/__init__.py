"""Identify the interface from measured curves: work of adhesion and range, with intervals.

A fit goes from data over a model and a likelihood to a result; sentences are made from its numbers.

============  ======================================================================
data          ``pull_off``, ``travel``, ``temperatures``, ``rate_series``
model         ``forward``, ``growth``, ``simulated_tests``, ``force_ratios``, ``simulations``
likelihood    ``likelihood``, ``covariances``, ``interpolated_forces``, ``search``
result        ``series_fit``, ``rate_fit``, ``edge_fit``, ``forecasting``, ``ranked_tests``
sentences     ``rate_words``, ``slow_words``
============  ======================================================================

One slow test goes through ``slow_tests`` and ``contacts``, a folder through ``curves``, an approach
through ``approach``, tests after several dwells through ``contact_time``. ``computed`` keeps forces
for the next time.
"""

from .approach import ApproachFit, Attraction, attraction, identify_approach
from .contact_time import DwellFit, identify_dwell
from .curves import CurveFit, CurveGroup, fit_curves, group_curves
from .edge_fit import EdgeFit, identify_edge
from .forecasting import RateForecast, forecast_edge, forecast_rates, interfaces
from .likelihood import Best, Interval, Objective, Parameter, Posterior, posterior
from .pull_off import PullOff, pull_offs
from .ranked_tests import NextTests, RankedTest, Trial, next_tests
from .rate_fit import RateSeriesFit, identify_rates
from .rate_series import RateSeries
from .slow_tests import ModelFit, SlowTest, SlowTestFit, fitted_force, identify_slow, slow_test

__all__ = [
    "ApproachFit",
    "Attraction",
    "Best",
    "CurveFit",
    "CurveGroup",
    "DwellFit",
    "EdgeFit",
    "Interval",
    "ModelFit",
    "NextTests",
    "Objective",
    "Parameter",
    "Posterior",
    "PullOff",
    "RankedTest",
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
