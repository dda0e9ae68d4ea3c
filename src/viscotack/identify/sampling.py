"""The posterior of an objective, drawn by an ensemble of walkers."""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .objective import Best, Objective, Parameter

_WALKERS, _STEPS, _BEGIN = 16, 600, 100
_AROUND = 1e-3  # of the way between the bounds, where the walkers begin
_INDEPENDENT = 200.0  # draws of all walkers together that a band needs


@dataclass(frozen=True, eq=False)
class Posterior:
    """What data and prior leave of the parameters.

    Parameters
    ----------
    parameters : tuple of Parameter
        In the order of the columns.
    values : ndarray, shape (N, parameters)
        Draws, in the unit of each parameter.
    correlation_time : float
        Steps of the walk between independent draws.
    converged : bool
        Whether there are 200 independent draws.
    """

    parameters: tuple[Parameter, ...]
    values: Array
    correlation_time: float
    converged: bool

    def of(self, name: str) -> Array:
        """Return the draws of one parameter."""
        names = [one.name for one in self.parameters]
        return self.values[:, names.index(name)]

    def thinned(self, count: int) -> Array:
        """Return so many of the draws, evenly from the whole walk, shape (count, parameters)."""
        if not 0 < count <= len(self.values):
            raise InputError(f"there are {len(self.values)} draws, {count} were asked for")
        return self.values[np.linspace(0, len(self.values) - 1, count).astype(int)]


def posterior(objective: Objective, best: Best, *, steps: int = _STEPS, seed: int = 0) -> Posterior:
    """Return draws of the parameters from the density of an objective.

    Between the bounds, in the logarithm of what is positive, the prior is flat where none is given.

    Parameters
    ----------
    objective : Objective
        Of a fit.
    best : Best
        Its most likely parameters, near which the walkers begin.
    steps : int
        Of each of the 16 walkers, after 100 to forget the beginning.
    seed : int
        Of the random numbers.

    Raises
    ------
    ValueError
        If emcee is not installed, ``pip install viscotack[lab]``.

    References
    ----------
    Foreman-Mackey et al., emcee: the MCMC hammer (2013), doi:10.1086/670067.
    """
    try:
        import emcee
    except ImportError as error:
        raise InputError(
            "a posterior is drawn by emcee; install it with: pip install 'viscotack[lab]'"
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
    inner = np.asarray(sampler.get_chain(flat=True))
    values = [p.outer_of(x) for p, x in zip(parameters, inner.T, strict=True)]
    enough = steps * _WALKERS > _INDEPENDENT * time
    return Posterior(parameters, np.stack(values, axis=1), time, enough)
