r"""A punch on a sliding layer: limits of the stress, relaxed start, and scaling of the inputs.

The inputs of a row are half width a and thickness b [a0], modulus ratio k, depth d of the relaxed
start [h0] and rate [h0/tau0]; the solid is a standard solid.

**Start.** A mean stress of sigma0 moves the punch by about :math:`C = \pi l/(2 \hat\sigma) +
1/c` [h0], with the strength :math:`\hat\sigma` [dg0/h0] and the stiffness c [sigma0/h0] of the
interface at rest, and the length

.. math:: l = \frac{4 \hat a}{\pi} \ln \left( 1 + \frac{\pi \hat b}{4 \hat a} \right) ,

which is b for a thin layer and logarithmic in b/a for a thick one. So d/C equals the mean
stress of the start within a quarter, and is an input of the networks: the same depth
is negligible for a thick layer, and large for a thin one.

**Limits.** The networks do not predict the pull-off stress itself, but its position between limits,

.. math:: \log \hat\sigma = (1 - s) \log S(\hat a, \hat b)
          + s \log F(\hat a, \hat b, k, d/C), \qquad 0 < s < 1 .

The slow limit S is that of the relaxed layer, for any start; the fast limit F that of a layer that
does not relax during retraction. Both lie between the strength, 1,
and half of the smaller of crack stress (for a layer of modulus E) and strength, combined as

.. math:: \frac{1}{2} \left( 1 + \frac{1}{g^2} \right)^{-1/2} , \qquad
          g^2 = \left( \frac{4}{\pi \hat b} + \frac{1}{\hat a} \right) \frac{E}{E_0} ,

which includes the thin layer, :math:`\sqrt{2 E \Delta\gamma/b}`, and the half-plane,
:math:`\sqrt{\pi E \Delta\gamma/2a}`.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from viscotack.arrays import Array
from viscotack.model.traction import LennardJones

from .contact import Contact, between, scaled_logarithms
from .line import Curves
from .trust import Answers

INPUTS = ("size", "thickness", "modulus_ratio", "preload", "rate")
SIZE, THICKNESS, MODULUS_RATIO, PRELOAD, RATE = range(5)
STRENGTH = LennardJones(1.0, 1.0).strength
# Slope of the traction at rest, 16 dg0/h0^2, in sigma0/h0.
_CONTACT = 16 / STRENGTH
# Ranges of size, thickness, modulus ratio, start's depth over the compliance, and rate.
LOW = np.array([1.0, 0.1, 1e-3, 1.5e-3, 1e-3])
HIGH = np.array([200.0, 1000.0, 0.7, 10.0, 1e6])
_ENDS = np.log10(LOW), np.log10(HIGH)
# Inputs of the limits and of the start.
SLOW, FAST, START = [SIZE, THICKNESS], [SIZE, THICKNESS, MODULUS_RATIO, PRELOAD], [0, 1, PRELOAD]


def compliance(groups: Array) -> Array:
    """Return the approximate displacement of a relaxed punch by a mean stress sigma0 [h0], (n,).

    Examples
    --------
    >>> compliance(np.array([[64.85, 3.24, 0.1, 1.0, 10.0]])).round(3).tolist()
    [4.928]
    """
    size, thickness = groups[:, SIZE], groups[:, THICKNESS]
    length = 4 / np.pi * size * np.log1p(np.pi / 4 * thickness / size)
    return np.pi / (2 * STRENGTH) * length + 1 / _CONTACT


def unit(rows: Array) -> Array:
    """Return the units of the inputs' ranges; depths of starts are relative to the compliance."""
    return np.where(np.arange(len(INPUTS)) == PRELOAD, compliance(rows)[:, None], 1.0)


def scaled(groups: Array) -> Array:
    """Return the logarithms of the inputs, scaled to [-1, 1] over the range; shape (n, 5)."""
    return scaled_logarithms(groups / unit(groups), *_ENDS)


def least(groups: Array, stiffer: Array | float = 1.0) -> Array:
    """Return log10 of a lower bound of the pull-off stress of elastic layers [sigma0], (n,).

    Parameters
    ----------
    groups : ndarray, shape (n, 5)
    stiffer : ndarray or float, shape (n,)
        Modulus of the layer relative to the relaxed one.
    """
    crack = (4 / (np.pi * groups[:, THICKNESS]) + 1 / groups[:, SIZE]) * stiffer
    return -0.5 * np.log10(1 + 1 / crack) - np.log10(2)


def least_fast(groups: Array) -> Array:
    """Return log10 of a lower bound of the pull-off stress without relaxation, shape (n,)."""
    return least(groups, 1 / groups[:, MODULUS_RATIO])


def told(inputs: Array, slow: Array, stress: Array) -> Array:
    """Return the inputs of networks that depend on the slow limit and the stress, shape (n, 7).

    Parameters
    ----------
    inputs : ndarray, shape (n, 5)
        As from :func:`scaled`.
    slow, stress : ndarray, shape (n,)
        log10 of the slow limit of the stress and of the stress itself.
    """
    return np.column_stack([inputs, 2 * slow, 2 * (stress - slow)])


class PunchContact(Contact):
    """A flat punch on a sliding layer of a standard solid; forces are mean stresses [sigma0]."""

    name, inputs, low, high, ends = "punch", INPUTS, LOW, HIGH, _ENDS
    start_inputs, search = START, (24, 3)
    no_start = (
        "preload_force is {wanted:.4g} sigma0, outside the training range of {least:.4g} to "
        "{most:.4g} sigma0 for this size and thickness"
    )
    # works are in dg0, areas below curves in sigma0 h0
    give_knows_work, work_unit = False, STRENGTH
    unit = staticmethod(unit)

    @cached_property
    def slow(self) -> Array:
        """log10 of the pull-off stress of the relaxed layer, shape (m, n)."""
        said = self.networks["slow"](self.scaled[:, SLOW])[..., 0]
        return between(least(self.rows), np.zeros(len(self.rows)), said)

    @cached_property
    def fast(self) -> Array:
        """log10 of the pull-off stress of a layer that does not relax, shape (m, n)."""
        said = self.networks["fast"](self.scaled[:, FAST])[..., 0]
        fast = between(least_fast(self.rows), np.zeros(len(self.rows)), said)
        return np.maximum(self.slow, fast)

    def started(self, said: Array) -> tuple[Array, Array]:
        """Return stress and ligament of starts, from outputs of shape (n, 1)."""
        return self.ranged[:, PRELOAD] * 10 ** said[:, 0], self.rows[:, SIZE]

    def knowing(self, force: Array) -> Array:
        """Return the inputs of networks that depend on slow limit and stress, shape (n, 7)."""
        return told(self.scaled, self.slow.mean(axis=0), force)

    def give(self, said: Array) -> Array:
        """Return (travel to zero stress) * size / stress, from the output of its networks."""
        stress, size = self.start
        return self.rows[:, PRELOAD] * 10**said * size / stress

    def curves(self, answers: Answers) -> Curves:
        """Return the unloading curves: depths in h0, stresses in sigma0, the edge in a0."""
        found = super().curves(answers)
        # the contact is at most as wide as the punch
        edge = np.minimum(found.contact_radius, self.rows[:, [SIZE]])
        return replace(found, contact_radius=edge)
