"""What a fit of a rate series gives, whatever its model."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from viscotack.arrays import Array
from viscotack.model.materials import Passport

from .likelihood import Best, Interval, Objective, Posterior, posterior
from .pull_off import PullOff
from .rate_series import RateSeries
from .search import Settled

_LOUD = 2.0  # residuals over their uncertainty above which no such interface fits the forces


@dataclass(frozen=True, eq=False)
class SeriesFit:
    """Unknowns fitted to a rate series.

    Parameters
    ----------
    found : Settled
        The search with the covariance of the forces, its best fit, and the scatter of the forces.
    solutions : tuple of Best
        Separate solutions that fit the forces, the most likely first; mostly one.
    intervals : dict of str to Interval
        Profile likelihood intervals of the unknowns.
    """

    found: Settled
    solutions: tuple[Best, ...]
    intervals: dict[str, Interval]

    @classmethod
    def of(cls, found: Settled, intervals: dict[str, Interval], **more: Any) -> Self:
        """Return a fit with all its solutions; intervals are those of the most likely one."""
        search, level = found.search, found.search.series.level
        several = search.objective.solutions(found.best, intervals, level)
        if several[0].misfit < found.best.misfit:
            found = replace(found, best=several[0])
            intervals = search.intervals(found.best, level)
        return cls(found, several, intervals, **more)

    @property
    def given(self) -> RateSeries:
        """The fitted tests, with material, machine and assumptions."""
        return self.found.search.series

    @property
    def series(self) -> tuple[PullOff, ...]:
        """The fitted tests."""
        return tuple(self.given.tests)

    @property
    def passport(self) -> Passport:
        """Passport of the material."""
        return self.given.passport

    @property
    def best(self) -> Best:
        """The most likely parameters."""
        return self.found.best

    @property
    def work_of_adhesion(self) -> float:
        """Most likely work of adhesion [J/m2]."""
        return self.best.values["work_of_adhesion"]

    @cached_property
    def forces(self) -> tuple[float, ...]:
        """Pull-off forces of the most likely parameters at the measured speeds [N]."""
        return tuple(self.found.search.forces(self.best).tolist())

    @property
    def covariance(self) -> Array:
        """Covariance of the relative forces: noise, theory, material and machine."""
        return self.found.search.spread

    @property
    def objective(self) -> Objective:
        """Objective function, for profiles and sampling."""
        return self.found.search.objective

    def sampled(self, seed: int = 0) -> Posterior:
        """Sample the unknowns from the posterior, of all solutions."""
        return posterior(self.objective, self.best, others=self.solutions[1:], seed=seed)

    @property
    def scatter(self) -> float:
        """Root mean square of residuals over their uncertainty, without `between_speeds`."""
        return self.found.scatter

    @property
    def between_speeds(self) -> float:
        """Relative scatter from speed to speed beyond that of repeated tests and theory."""
        return self.found.between

    @property
    def trend(self) -> bool:
        """Whether most of the variance of that scatter follows a power of the speed."""
        return self.found.trend

    @property
    def criterion(self) -> float:
        """Bayesian information criterion, -2 ln L + k ln n; smaller is better."""
        unknowns = len(self.best.values) + (self.between_speeds > 0)
        return self.found.surprise + unknowns * float(np.log(len(self.series)))

    @property
    def theory(self) -> float:
        """Relative standard uncertainty of the forward model, in the covariance."""
        return self.given.theory_error

    @property
    def level(self) -> float:
        """Confidence level of the intervals."""
        return self.given.level

    @property
    def describes_tests(self) -> bool:
        """Whether residuals are as large as noise and theory let them be."""
        return self.scatter <= _LOUD
