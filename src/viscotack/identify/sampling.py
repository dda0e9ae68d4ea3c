"""Sample the posterior of an objective by an ensemble of walkers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, install_command

from .objective import Best, Objective, Parameter

_WALKERS, _STEPS, _BEGIN = 16, 600, 100
_AROUND = 1e-3  # fraction of the distance between the bounds over which the walkers start
_INDEPENDENT = 200.0  # number of independent samples needed for a band


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

    def of(self, name: str) -> Array:
        """Return the samples of one parameter."""
        names = [one.name for one in self.parameters]
        return self.values[:, names.index(name)]

    def thinned(self, count: int) -> Array:
        """Select evenly a number of samples, shape (count, parameters)."""
        if not 0 < count <= len(self.values):
            raise InputError(f"count must be at most the {len(self.values)} samples, got {count}")
        return self.values[np.linspace(0, len(self.values) - 1, count).astype(int)]


def posterior(
    objective: Objective,
    best: Best,
    *,
    others: Sequence[Best] = (),
    steps: int = _STEPS,
    seed: int = 0,
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
    steps : int
        Steps of each of the 16 walkers, after 100 discarded steps.
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
    starts = (best, *others)
    chains = [_sampled(objective, one, steps, seed + i) for i, one in enumerate(starts)]
    evidence = np.array(
        [
            -start.misfit / 2 + _volume(inner)
            for start, (inner, _) in zip(starts, chains, strict=True)
        ]
    )
    shares = np.exp(evidence - evidence.max())
    counts = np.round(shares / shares.sum() * chains[0][0].shape[0]).astype(int)
    rng = np.random.default_rng(seed)
    inner = np.concatenate(
        [
            chain if count == len(chain) else rng.choice(chain, count)
            for (chain, _), count in zip(chains, counts, strict=True)
        ]
    )
    parameters = objective.parameters
    values = [p.outer_of(x) for p, x in zip(parameters, inner.T, strict=True)]
    time = max(time for _, time in chains)
    enough = steps * _WALKERS > _INDEPENDENT * time
    return Posterior(parameters, np.stack(values, axis=1), time, enough)


def _volume(inner: Array) -> float:
    """Return the logarithm of the volume of a cloud of samples, up to a constant."""
    return float(np.linalg.slogdet(np.atleast_2d(np.cov(inner.T)))[1]) / 2


def _sampled(objective: Objective, best: Best, steps: int, seed: int) -> tuple[Array, float]:
    """Return samples around one solution in search coordinates, and the correlation time."""
    try:
        import emcee
    except ImportError as error:
        raise InputError(
            f"sampling needs emcee; install it with: {install_command('lab')}"
        ) from error

    parameters = objective.parameters
    low = np.array([p.inner(p.low) for p in parameters])
    high = np.array([p.inner(p.high) for p in parameters])
    middle = np.array([p.inner(best.values[p.name]) for p in parameters])
    rng = np.random.default_rng(seed)
    begin = middle + _AROUND * (high - low) * rng.standard_normal((_WALKERS, middle.size))
    margin = 1e-6 * (high - low)
    sampler = emcee.EnsembleSampler(_WALKERS, middle.size, objective.log_density)
    sampler.random_state = np.random.RandomState(seed).get_state()
    state = sampler.run_mcmc(np.clip(begin, low + margin, high - margin), _BEGIN)
    sampler.reset()
    sampler.run_mcmc(state, steps)
    time = float(np.max(sampler.get_autocorr_time(quiet=True, tol=0)))
    return np.asarray(sampler.get_chain(flat=True)), time
