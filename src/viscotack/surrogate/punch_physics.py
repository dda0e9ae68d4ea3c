r"""What is known of a punch on a sliding layer without learning, and how its inputs are scaled.

Inputs of a row are half width a and thickness b [a0], modulus ratio k, depth d of the relaxed start
[h0] and rate [h0/tau0]; the solid is a standard one.

**The start.** A mean stress of sigma0 moves the punch by about :math:`C = \pi l/(2 \hat\sigma) +
1/c` [h0], with the strength :math:`\hat\sigma` [dg0/h0] and the stiffness c [sigma0/h0] of the
interface at rest, and the length

.. math:: l = \frac{4 \hat a}{\pi} \ln \left( 1 + \frac{\pi \hat b}{4 \hat a} \right) ,

which is b for a thin layer and goes with the logarithm of b/a for a thick one. So d/C is the mean
stress of the start but for a quarter of it, and that is what networks are told: the same depth
is nothing to a thick layer, and everything to a thin one.

**The limits.** A network never says a pull-off stress. It says where between its limits it is,

.. math:: \log \hat\sigma = (1 - s) \log S(\hat a, \hat b)
          + s \log F(\hat a, \hat b, k, d/C), \qquad 0 < s < 1 ,

that of the relaxed layer at the slow end, whatever the start, and that of a layer of which nothing
relaxes once it is retracted at the fast end. These two lie in their turn between the strength, 1,
and half of what a crack on a layer of the modulus E would ask for and the strength allows,

.. math:: \frac{1}{2} \left( 1 + \frac{1}{g^2} \right)^{-1/2} , \qquad
          g^2 = \left( \frac{4}{\pi \hat b} + \frac{1}{\hat a} \right) \frac{E}{E_0} ,

which has the thin layer, :math:`\sqrt{2 E \Delta\gamma/b}`, and the half-plane,
:math:`\sqrt{\pi E \Delta\gamma/2a}`, in it.
"""

import numpy as np

from viscotack.arrays import Array
from viscotack.traction import LennardJones

INPUTS = ("size", "thickness", "modulus_ratio", "preload", "rate")
SIZE, THICKNESS, MODULUS_RATIO, PRELOAD, RATE = range(5)
STRENGTH = LennardJones(1.0, 1.0).strength
# Slope of the traction at rest, 16 dg0/h0^2, in sigma0/h0.
_CONTACT = 16 / STRENGTH
# Of size, thickness, modulus ratio, the start's depth over the compliance, and rate.
LOW = np.array([1.0, 0.1, 1e-3, 1.5e-3, 1e-3])
HIGH = np.array([200.0, 1000.0, 0.7, 10.0, 1e6])
# Which of the inputs the limits and the start depend on.
SLOW, FAST, START = [SIZE, THICKNESS], [SIZE, THICKNESS, MODULUS_RATIO, PRELOAD], [0, 1, PRELOAD]


def compliance(groups: Array) -> Array:
    """Return how far a mean stress of sigma0 moves a relaxed punch, about [h0], shape (n,).

    Examples
    --------
    >>> compliance(np.array([[64.85, 3.24, 0.1, 1.0, 10.0]])).round(3).tolist()
    [4.928]
    """
    size, thickness = groups[:, SIZE], groups[:, THICKNESS]
    length = 4 / np.pi * size * np.log1p(np.pi / 4 * thickness / size)
    return np.pi / (2 * STRENGTH) * length + 1 / _CONTACT


def stressed(groups: Array) -> Array:
    """Return rows with the depth of the start over the compliance in place of the depth."""
    found = groups.copy()
    found[:, PRELOAD] /= compliance(groups)
    return found


def scaled(groups: Array) -> Array:
    """Return the logarithms of the inputs, from -1 to 1 over the range; shape (n, 5)."""
    low, high = np.log10(LOW), np.log10(HIGH)
    return (2 * np.log10(stressed(groups)) - (low + high)) / (high - low)


def least(groups: Array, stiffer: Array | float = 1.0) -> Array:
    """Return log10 of a stress [sigma0] below every pull-off of an elastic layer, shape (n,).

    Parameters
    ----------
    groups : ndarray, shape (n, 5)
    stiffer : ndarray or float, shape (n,)
        Modulus of the layer over the relaxed one.
    """
    crack = (4 / (np.pi * groups[:, THICKNESS]) + 1 / groups[:, SIZE]) * stiffer
    return -0.5 * np.log10(1 + 1 / crack) - np.log10(2)


def least_fast(groups: Array) -> Array:
    """Return log10 of a stress below every pull-off of a layer that does not relax, shape (n,)."""
    return least(groups, 1 / groups[:, MODULUS_RATIO])
