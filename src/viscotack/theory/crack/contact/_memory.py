"""Memory of the bulk: modes of the creep, and the hereditary travel of a retraction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.model.materials import Modes
from viscotack.model.materials.interconversion import reciprocal
from viscotack.theory.crack.steady._memory import mean_decay


class Chain(NamedTuple):
    """Creep in exponential modes: instantaneous compliance, weights, retardation times."""

    instantaneous: float
    weights: Array
    times: Array

    def step(self, dt: float) -> tuple[Array, Array, Array, float]:
        """Return decay, weights of the old and the new e, and the compliance of a step."""
        x = dt / self.times
        mean, decay = mean_decay(x), np.exp(-x)
        compliance = self.instantaneous + float(self.weights @ (1 - mean))
        return decay, mean - decay, 1 - mean, compliance


def chain_of(modes: Modes) -> Chain:
    """Return the modes as arrays."""
    return Chain(modes.instantaneous, np.array(modes.weights), np.array(modes.times))


def hereditary_travel(chain: Chain, time: Array) -> Array:
    r"""Return :math:`\int_0^t \psi(s) ds`, psi the relaxation from 1/k to 1.

    It is the travel of an elastic solid equivalent to a retraction at constant unit speed.
    """
    if not chain.times.size:
        return np.asarray(time, dtype=float)
    weights, times = reciprocal(chain.instantaneous, chain.weights, chain.times)
    x = np.asarray(time)[..., None] / times
    return np.asarray(time) + (-np.expm1(-x) * times) @ weights
