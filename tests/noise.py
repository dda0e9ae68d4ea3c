"""Round-off as another processor would have it, and a hundred times more: to test without one.

Processors differ in the last digits of sums of products. Here every stiffness matrix, every factor
of a tangent and every residual and energy of the march gets relative noise, seeded.
"""

from contextlib import ExitStack, contextmanager
from unittest.mock import patch

import numpy as np

from viscotack.simulate import equilibrium, growth, surface


@contextmanager
def noise(seed, size=1e-14):
    """Put noise of this relative size into all that simulations in this block work out."""
    random = np.random.default_rng(seed)
    factor, at, stiffness = equilibrium.factored, equilibrium.Elastic.at, surface.stiffness

    def noisy(value):
        return value * (1 + size * random.uniform(-1, 1, np.shape(value)))

    def noisy_at(self, gap):
        energy, gradient = at(self, gap)
        return float(noisy(energy)), noisy(gradient)

    def noisy_stiffness(*arguments):
        S = noisy(stiffness(*arguments))
        return (S + S.T) / 2

    def noisy_factor(matrix, curvature):
        noised = curvature._replace(diagonal=noisy(curvature.diagonal))
        return factor(noisy(matrix), noised)

    with ExitStack() as stack:
        for owner, name, function in (
            (equilibrium, "factored", noisy_factor),
            (growth, "factored", noisy_factor),
            (equilibrium.Elastic, "at", noisy_at),
            (surface, "stiffness", noisy_stiffness),
        ):
            stack.enter_context(patch.object(owner, name, function))
        yield
