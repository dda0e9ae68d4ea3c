r"""A sphere on a power law: limits of the force, relaxed start, and scaling of the inputs.

The inputs of a row are the five groups of a sphere on a power law by retardation, retracted from a
relaxed start: Tabor number mu, modulus ratio k, exponent n, depth d [h0] and rate [h0/tau0].

The force lies between two limits:

.. math:: \log \hat P = (1 - s) \log f(\mu) + s \log \hat G(\mu, k, d) , \qquad 0 < s < 1 .

The slow limit f is the elastic pull-off force of the relaxed solid. The fast limit G is that of a
solid that does not relax, from the relaxed start; it lies between f and the fast limit of the
largest contact, :math:`f(\mu k^{1/3})/k` (:mod:`viscotack.theory.sphere.bounds`). Therefore no
prediction exceeds these limits, and the slow, fast, JKR and Bradley limits are satisfied. A network
predicts G between them, to 0.15 %, where the solver is accurate to 0.1 %. The force of the relaxed
start is the Hertz force,

.. math:: \hat F_H = \frac{8}{9 \pi} \left( \frac{\hat d}{\mu} \right)^{3/2} ,

plus :math:`\sqrt{1 + \hat F_H}` times a network, because adhesion changes a deep contact by that
power.
"""

from functools import cached_property

import numpy as np

from viscotack.arrays import Array
from viscotack.theory import lennard_jones

from .contact import Contact, between, scaled_logarithms

INPUTS = ("tabor", "modulus_ratio", "exponent", "preload", "rate")
TABOR, MODULUS_RATIO, EXPONENT, PRELOAD, RATE = range(5)
# Ranges of the set `broad`; the few deeper rows of `thesis` are used, but do not justify a wider
# one.
LIMITS = {
    "tabor": (0.01, 10.0),
    "modulus_ratio": (1e-4, 0.7),
    "exponent": (0.15, 2.0),
    "preload": (0.005, 500.0),
    "rate": (0.01, 1e10),
}
LOW, HIGH = np.array(list(LIMITS.values())).T
# Ends that are scaled to -1 and 1, including the deepest rows.
_LOW, _HIGH = np.log10(LOW), np.log10([*HIGH[:3], 550.0, HIGH[4]])
# Inputs of the relaxed start and of the fast limit.
START, FAST = [TABOR, PRELOAD], [TABOR, MODULUS_RATIO, PRELOAD]


def scaled(groups: Array) -> Array:
    """Return the logarithms of inputs, scaled to [-1, 1] over the training rows; shape (n, 5)."""
    return scaled_logarithms(groups, _LOW, _HIGH)


def slow_limit(groups: Array) -> Array:
    """Return log10 of the slowest pull-off force [1.5 pi R dg0], shape (n,)."""
    return np.log10(lennard_jones.pull_off_ratio(groups[:, TABOR]))


def largest_fast_limit(groups: Array) -> Array:
    """Return log10 of the fastest pull-off force from a large contact, shape (n,)."""
    k = groups[:, MODULUS_RATIO]
    return np.log10(lennard_jones.pull_off_ratio(groups[:, TABOR] * np.cbrt(k)) / k)


def hertz(groups: Array) -> Array:
    """Return the force of a relaxed start without adhesion [1.5 pi R dg0], shape (n,)."""
    return 8 / (9 * np.pi) * (groups[:, PRELOAD] / groups[:, TABOR]) ** 1.5


def start_force(groups: Array, output: Array) -> Array:
    """Return the force of the relaxed start, compression positive, from the output of a network."""
    without = hertz(groups)
    return without + np.sqrt(1 + without) * output


def start_output(groups: Array, force: Array) -> Array:
    """Return the network output for a given force of the relaxed start."""
    without = hertz(groups)
    return (force - without) / np.sqrt(1 + without)


def with_start(inputs: Array, force: Array, radius: Array, *logarithms: Array) -> Array:
    """Append start and further quantities to inputs of a network; shape (n, 8 + further).

    Parameters
    ----------
    inputs : ndarray, shape (n, 5)
        As from :func:`scaled`.
    force, radius : ndarray, shape (n,)
        Force and contact radius of the relaxed start.
    logarithms : ndarray, shape (n,)
        log10 of further quantities.
    """
    start = (np.arcsinh(force) / 5, np.tanh(force), np.log10(radius))
    return np.column_stack([inputs, *start, *logarithms])


class SphereContact(Contact):
    """A sphere on a power law by retardation."""

    name, inputs, low, high, ends = "sphere", INPUTS, LOW, HIGH, (_LOW, _HIGH)
    start_inputs, search = START, (64, 4)
    no_start = (
        "no relaxed start between depths of {low:g} and {high:g} h0 has a {what} of {wanted:g}; at "
        "that Tabor number it is between {least:.4g} and {most:.4g}"
    )

    @cached_property
    def slow(self) -> Array:
        """log10 of the elastic pull-off force of the relaxed solid, shape (n,)."""
        return slow_limit(self.rows)

    @property
    def least(self) -> Array:
        """log10 of the elastic pull-off force of the relaxed solid, shape (n,)."""
        return self.slow

    @cached_property
    def fast(self) -> Array:
        """log10 of the pull-off force of a solid that does not relax, shape (m, n)."""
        said = self.networks["fast"](self.scaled[:, FAST])[..., 0]
        return between(self.slow, largest_fast_limit(self.rows), said)

    def started(self, said: Array) -> tuple[Array, Array]:
        """Return force and radius of starts, from outputs of shape (n, 2)."""
        return start_force(self.rows, said[:, 0]), 10 ** said[:, 1]

    def knowing(self, force: Array) -> Array:
        """Return the inputs of networks that depend on start and force, shape (n, 9)."""
        return with_start(self.scaled, *self.start, force)
