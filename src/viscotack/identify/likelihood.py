"""Likelihood and posterior of a fit: measured points, a model and a prior.

Least squares, profile likelihood and sampling use the same object, and therefore the same
likelihood. Points and model are independent of each other. The posterior is sampled by emcee: for
two to four parameters, a likelihood in microseconds and no gradients its walkers need no tuning.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.errors import InputError, install_command

Residuals = Callable[[Mapping[str, float]], Array]

# Fractions of the distance from the best value to a bound, for intervals of any width or in two
# parts.
_PLACES = np.union1d(np.geomspace(2e-3, 1.0, 9), np.linspace(0.2, 1.0, 9))
EVIDENCE = 6.0  # difference of two information criteria: strong evidence
_BEYOND = 1e-9
_SAME = 0.05  # relative difference of equal solutions
_TRIALS = 32  # values of a parameter between the ends of its interval
_WALKERS, _STEPS, _BEGIN = 16, 600, 100
_AROUND = 1e-3  # fraction of the distance between the bounds over which the walkers start
_INDEPENDENT = 200.0  # number of independent samples needed for a band


@dataclass(frozen=True)
class Parameter:
    """One unknown with its bounds; searched in its logarithm if positive.

    Parameters
    ----------
    name : str
        Name in the model.
    low, high : float
        Bounds of the search.
    start : float
        Start of the search.
    logarithmic : bool
        Whether the logarithm is searched.
    prior : (float, float), optional
        Known value and standard uncertainty: a normal distribution of the number, or of its
        logarithm if that is searched (then the uncertainty is relative).
    """

    name: str
    low: float
    high: float
    start: float
    logarithmic: bool = True
    prior: tuple[float, float] | None = None

    def __post_init__(self):
        if not self.low < self.start < self.high or (self.logarithmic and self.low <= 0):
            raise InputError(
                f"{self.name}: the start {self.start:g} must lie between {self.low:g} and "
                f"{self.high:g}"
            )

    def inner(self, value: Any) -> Any:
        """Convert a value, or several, to the search coordinate."""
        return np.log(value) if self.logarithmic else value

    def outer(self, inner: Any) -> Any:
        """Convert a search coordinate, or several, to the parameter."""
        return np.exp(inner) if self.logarithmic else inner


@dataclass(frozen=True)
class Best:
    """The most likely parameters and their misfit.

    Parameters
    ----------
    values : mapping
        Parameter -> value.
    misfit : float
        Sum of squares of residuals and priors, in standard deviations.
    points : int
        Number of residuals.
    """

    values: Mapping[str, float]
    misfit: float
    points: int


@dataclass(frozen=True)
class Interval:
    """Interval of a parameter, and whether the data bound it on each side.

    Parameters
    ----------
    low, high : float
        Ends of the interval; the bound of the search where the data do not bound it.
    closed_below, closed_above : bool
        Whether the data bound it below and above.
    split : bool
        Whether the interval consists of two separate ranges with unlikely values in between.
    """

    low: float
    high: float
    closed_below: bool
    closed_above: bool
    split: bool = False

    @property
    def told(self) -> bool:
        """Whether the data bound the interval on both sides."""
        return self.closed_below and self.closed_above


@dataclass(frozen=True)
class Objective:
    """Normalised residuals of a model as a function of its parameters."""

    residuals: Residuals
    parameters: tuple[Parameter, ...]

    @staticmethod
    def ends(parameters: Sequence[Parameter]) -> tuple[Array, Array]:
        """Return the bounds of parameters in search coordinates."""
        low, high = zip(*((p.inner(p.low), p.inner(p.high)) for p in parameters), strict=True)
        return np.array(low), np.array(high)

    def log_density(self, inner: Array) -> float:
        """Return the log-likelihood plus log-prior, up to a constant, for a sampler."""
        low, high = self.ends(self.parameters)
        if not np.all((low <= inner) & (inner <= high)):
            return -np.inf
        rest = self._rest(inner, self.parameters, {})
        return -0.5 * float(rest @ rest)

    def best(self, held: Mapping[str, float] | None = None, near: Best | None = None) -> Best:
        """Minimise the sum of squares, optionally with some parameters fixed."""
        held = held or {}
        free = tuple(p for p in self.parameters if p.name not in held)
        if not free:
            rest = self._rest(np.zeros(0), free, held)
            return Best(dict(held), float(rest @ rest), rest.size)
        start = [p.inner(p.start if near is None else near.values[p.name]) for p in free]
        low, high = self.ends(free)
        margin = _BEYOND * (high - low)
        found = least_squares(
            self._rest,
            np.clip(start, low + margin, high - margin),
            bounds=(low, high),
            args=(free, held),
            x_scale=np.array([1.0 if p.logarithmic else (p.high - p.low) / 10 for p in free]),
            diff_step=1e-5,
        )
        values = {p.name: float(p.outer(x)) for p, x in zip(free, found.x, strict=True)}
        return Best(values | dict(held), 2 * float(found.cost), found.fun.size)

    def best_along(self, parameter: Parameter, parts: Sequence[float]) -> Best:
        """Return the best fit from starts at parts of the range of a parameter."""
        low, high = parameter.inner(parameter.low), parameter.inner(parameter.high)
        places = (parameter.outer(low + part * (high - low)) for part in parts)
        starts = [self.best({parameter.name: place}) for place in places]
        return min((self.best(near=start) for start in starts), key=lambda best: best.misfit)

    def slopes(self, best: Best) -> Array:
        """Return the derivatives of residuals and priors by the search coordinates."""
        at = np.array([p.inner(best.values[p.name]) for p in self.parameters])
        sizes = [1e-5 if p.logarithmic else 1e-5 * (p.high - p.low) for p in self.parameters]
        rest = partial(self._rest, free=self.parameters, held={})
        rows = zip(np.diag(sizes), sizes, strict=True)
        columns = [(rest(at + step) - rest(at - step)) / (2 * size) for step, size in rows]
        return np.stack(columns, axis=1)

    def covariance(self, best: Best) -> Array:
        """Return the covariance of the search coordinates in the linearised model."""
        jacobian = self.slopes(best)
        return np.asarray(np.linalg.pinv(jacobian.T @ jacobian), dtype=float)

    def interval(self, name: str, best: Best, level: float = 0.9) -> Interval:
        """Compute the profile likelihood interval of one parameter.

        At each trial value all other parameters are fitted again.
        """
        (parameter,) = (p for p in self.parameters if p.name == name)
        limit = best.misfit + float(chi2.ppf(level, 1))
        middle = parameter.inner(best.values[name])
        (low, below, first), (high, above, second) = (
            self._end(parameter, middle, parameter.inner(bound), limit, best)
            for bound in (parameter.low, parameter.high)
        )
        ends = float(parameter.outer(low)), float(parameter.outer(high))
        return Interval(*ends, below, above, first or second)

    def _end(
        self, parameter: Parameter, middle: float, bound: float, limit: float, best: Best
    ) -> tuple[float, bool, bool]:
        """Find the last crossing of the limit by the misfit on the way to a bound.

        Also return whether it crosses before the bound, and whether there was an earlier crossing.
        """

        def misfit(inner: float, near: Best) -> Best:
            return self.best({parameter.name: parameter.outer(inner)}, near)

        # continue to the bound, because the misfit may fall below the limit again
        tried = [(middle, best)]
        for part in _PLACES:
            tried.append((x := middle + part * (bound - middle), misfit(x, tried[-1][1])))
        last = max(i for i, (_, found) in enumerate(tried) if found.misfit <= limit)
        split = any(found.misfit > limit for _, found in tried[:last])
        if last == len(tried) - 1:
            return bound, False, split
        (inside, near), (outside, _) = tried[last : last + 2]
        for _ in range(8):
            half = (inside + outside) / 2
            found = misfit(half, near)
            if found.misfit > limit:
                outside = half
            else:
                inside, near = half, found
        return (inside + outside) / 2, True, split

    def solutions(
        self, best: Best, intervals: Mapping[str, Interval], level: float
    ) -> tuple[Best, ...]:
        """Return the best fit and, where intervals are split, the others inside them.

        Each is a local minimum of the misfit; the most likely is first.
        """
        limit = best.misfit + float(chi2.ppf(level, 1))
        found = [best]
        for parameter in self.parameters:
            if intervals[parameter.name].split:
                for one in self._others(parameter, best, intervals[parameter.name], limit):
                    values = list(one.values.values())
                    others = (list(other.values.values()) for other in found)
                    if not any(np.allclose(values, other, rtol=_SAME) for other in others):
                        found.append(one)
        return tuple(sorted(found, key=lambda one: one.misfit))

    def _others(self, parameter: Parameter, best: Best, ends: Interval, limit: float) -> list[Best]:
        """Return the best fit of each likely range of a parameter without the best of all."""
        near = best
        ranges: list[list[Best]] = [[]]
        middle = parameter.inner(best.values[parameter.name])
        trials = np.linspace(parameter.inner(ends.low), parameter.inner(ends.high), _TRIALS)
        for x in np.sort(np.append(trials, middle)):
            held = {parameter.name: parameter.outer(x)}
            near = best if x == middle else self.best(held, near)
            if near.misfit <= limit:
                ranges[-1].append(near)
            elif ranges[-1]:
                ranges.append([])
        likely = (min(one, key=lambda fit: fit.misfit) for one in ranges if one and best not in one)
        return [self.best(near=one) for one in likely]

    def _rest(self, inner: Array, free: tuple[Parameter, ...], held: Mapping[str, float]) -> Array:
        values = {p.name: p.outer(x) for p, x in zip(free, inner, strict=True)} | dict(held)
        priors = [
            (p.inner(values[p.name]) - p.inner(p.prior[0])) / p.prior[1]
            for p in self.parameters
            if p.prior is not None
        ]
        return np.concatenate([self.residuals(values), priors])


@dataclass(frozen=True, eq=False)
class Posterior:
    """Samples of the posterior distribution of the parameters.

    Parameters
    ----------
    parameters : tuple of Parameter
        In the order of the columns.
    values : ndarray, shape (N, parameters)
        Samples, in the unit of each parameter.
    correlation_time : float
        Steps between independent samples.
    converged : bool
        Whether there are at least 200 independent samples.
    """

    parameters: tuple[Parameter, ...]
    values: Array
    correlation_time: float
    converged: bool

    def thinned(self, count: int) -> dict[str, Array]:
        """Select evenly a number of samples: parameter -> values, shape (count, 1)."""
        some = self.values[np.linspace(0, len(self.values) - 1, count).astype(int)]
        return {one.name: some[:, i : i + 1] for i, one in enumerate(self.parameters)}


def posterior(
    objective: Objective, best: Best, *, others: Sequence[Best] = (), seed: int = 0
) -> Posterior:
    """Sample the parameters from the posterior density of an objective.

    Without a given prior, it is uniform between the bounds, in the logarithm of positive
    parameters.

    Parameters
    ----------
    objective : Objective
        Objective of a fit.
    best : Best
        Most likely parameters, near which the walkers start.
    others : sequence of Best
        Separate solutions. Walkers do not cross the unlikely range between solutions, so each has
        its own walkers, and their shares are the evidence of each solution, with the covariance of
        its samples (Laplace's approximation).
    seed : int
        Seed of the random numbers.

    Raises
    ------
    ValueError
        If emcee is not installed (``pip install 'viscotack[lab]'``).

    References
    ----------
    Foreman-Mackey et al., emcee: the MCMC hammer (2013), doi:10.1086/670067.
    """
    try:
        import emcee
    except ImportError as error:
        raise InputError(
            f"sampling needs emcee; install it with: {install_command('lab')}"
        ) from error

    parameters = objective.parameters
    low, high = objective.ends(parameters)
    span, count = high - low, len(parameters)
    chains, evidence, times = [], [], []
    for own, one in enumerate((best, *others), start=seed):
        middle = np.array([p.inner(one.values[p.name]) for p in parameters])
        noise = np.random.default_rng(own).standard_normal((_WALKERS, count))
        begin = np.clip(middle + _AROUND * span * noise, low + 1e-6 * span, high - 1e-6 * span)
        sampler = emcee.EnsembleSampler(_WALKERS, count, objective.log_density)
        sampler.random_state = np.random.RandomState(own).get_state()
        state = sampler.run_mcmc(begin, _BEGIN)
        sampler.reset()
        sampler.run_mcmc(state, _STEPS)
        times.append(float(np.max(sampler.get_autocorr_time(quiet=True, tol=0))))
        chains.append(np.asarray(sampler.get_chain(flat=True)))
        # ln of the volume of the cloud of samples, up to a constant
        volume = np.linalg.slogdet(np.atleast_2d(np.cov(chains[-1].T)))[1] / 2
        evidence.append(volume - one.misfit / 2)
    shares = np.exp(np.array(evidence) - max(evidence))
    counts = np.round(shares / shares.sum() * len(chains[0])).astype(int)
    rng = np.random.default_rng(seed)
    kept = [
        chain if count == len(chain) else rng.choice(chain, count)
        for chain, count in zip(chains, counts, strict=True)
    ]
    columns = zip(parameters, np.concatenate(kept).T, strict=True)
    values = np.stack([one.outer(x) for one, x in columns], axis=1)
    enough = _STEPS * _WALKERS > _INDEPENDENT * max(times)
    return Posterior(parameters, values, max(times), enough)
