r"""Detachments from any linear solid: from the power law that it is like, and what it leaves over.

Force, work and curve are those that the surrogate of power laws (:mod:`.physics`)
says of the power law that creeps like the solid (:mod:`viscotack.surrogate.alike`), bent by what
that one leaves over. How much a sample of the creep counts in the likeness is a bell with two
widths,

.. math:: w_i = e^{-(x_i - c)^2/2 b_\pm^2} + w_0, \qquad x_i = \log_{10}(t_i v/h_0) ,

whose middle c and widths b are told, with the place where the search begins, by a small network
from Tabor number, depth, modulus ratio and the samples.

An answer is a functional of the logarithm of the creep, of which the samples are what a test
feels. Where the power law leaves over :math:`d_i` of it, the answer is another by
:math:`\sum_i K_i d_i` to first order; here the K of the force's place between its limits, and of
work over force, are networks of the case and of d itself. So both limits, which hold for any linear
solid, hold here; a power law has the same answer through either door; a solid that is slower,
pulled slower, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array

from .alike import DECADES, Alike, alike, climbed
from .answers import Answers
from .contact import Contact, Further, share
from .model import Surrogate
from .network import Networks
from .physics import SphereContact
from .trust import INPUTS, OF

SAMPLES = len(DECADES)
# What the network is told that says where a search begins and what counts, and what it says: three
# numbers of a power law; the middle and the logarithms of the widths of the bell.
BEGIN_INPUTS, BEGIN_OUTPUTS = SAMPLES + 3, 6
# What the networks are told that say how an answer is bent: seven numbers of the case, and what is
# left over.
BEND_INPUTS = 7 + SAMPLES
# What the network of the errors is told: what it is of power laws; how unlike the solid is, how far
# from those learned from, how far force and work were bent, and how far networks are apart in that.
TRUST_INPUTS = INPUTS + 6
# Below these likenesses and bends tell nothing more.
_LEAST_UNLIKE, _LEAST_BEND = 1e-4, 1e-4
# Logarithms of widths of the bell [decades] that it may have.
WIDEST = 2.4


@dataclass(frozen=True, eq=False)
class SolidContact(SphereContact):
    """A sphere on any linear solid: that on the power law that it is like, bent.

    Networks beside those of power laws are ``begin``, for the beginning of the search for a power
    law and the counts of the samples, and ``bend_force`` and ``bend_work``, for the corrections.
    Constants are ``floor``, the least count of a sample; ``usual``, the root mean square of the
    residuals; ``spread``, a matrix that makes the residuals of the solids learned from of order
    one; and ``farthest``, the largest :attr:`.alike.Alike.unlike` and :attr:`far` of these. A
    further output (:attr:`.answers.Answers.more`) is ``bends``, shape (n, 4): the sizes of the
    corrections of force and work, and their deviations among the networks.
    """

    like: Alike

    name = "solids"
    shared = ("start", "fast", "force", "work", "give", "line")
    shapes = {
        "begin": (BEGIN_INPUTS, BEGIN_OUTPUTS),
        "bend_force": (BEND_INPUTS, SAMPLES),
        "bend_work": (BEND_INPUTS, SAMPLES),
        "trust": (TRUST_INPUTS, len(OF)),
    }
    sizes = {"floor": (), "usual": (SAMPLES,), "spread": (SAMPLES, SAMPLES), "farthest": (2,)}
    limiting = ()

    @classmethod
    def of(
        cls, networks: Mapping[str, Networks], constants: Mapping[str, Array], given: Any
    ) -> Self:
        """Return the tests on solids that :func:`like` has compared with power laws."""
        return cls(networks, constants, given.groups, given)

    def deeper(self, factors: Array) -> Contact:
        """Return tests on the power laws with their depths times factors; nothing bends them."""
        return SphereContact(self.networks, self.constants, self.rows).deeper(factors)

    @cached_property
    def far(self) -> Array:
        """How far out solids are among those that were learned from, shape (n,)."""
        return far(self.like, self.constants["spread"])

    def inside(self) -> npt.NDArray[np.bool_]:
        """Return whether solids are as like power laws as those learned from, shape (n, 2)."""
        return np.stack([self.like.unlike, self.far], axis=1) <= self.constants["farthest"]

    def further(self, output: Array) -> Further:
        """Return the corrections of force and work, from the residuals of the power law."""
        over = scaled_over(self.like, self.constants["usual"])
        inputs = np.column_stack([features(self.like, output), over])
        ways = ("bend_force", over), ("bend_work", over * felt(output))
        each = [(self.networks[name](inputs) * factors).mean(axis=2) for name, factors in ways]
        force, work = (one.mean(axis=0) for one in each)
        bends = [np.abs(force), np.abs(work), *(one.std(axis=0) for one in each)]
        return Further(force, work, {"bends": np.column_stack(bends)})

    def told_of_errors(self, answers: Answers) -> Array:
        """Return the inputs of the networks of the errors, shape (n, TRUST_INPUTS)."""
        unlike = np.log10(self.like.unlike + _LEAST_UNLIKE) + 3
        far = np.log10(self.far + _LEAST_UNLIKE) + 1
        bends = np.log10(answers.more["bends"] + _LEAST_BEND) + 2
        return np.column_stack([super().told_of_errors(answers), unlike, far, bends])


def like(
    made: Surrogate, tabor: Array, modulus_ratio: Array, preload: Array, creep: Array
) -> Alike:
    """Return the power laws that stand for solids in tests.

    Parameters
    ----------
    made : Surrogate
        Of solids.
    tabor, modulus_ratio, preload : ndarray, shape (n,)
        Of the tests.
    creep : ndarray, shape (n, 15)
        Creep over the relaxed one, at ``alike.TIMES`` in units of h0 over the speed.
    """
    tests = tabor, modulus_ratio, preload
    said = made.networks["begin"](begin_inputs(tests, creep))[0]
    return alike(tests, creep, said[:, :3], bell(said[:, 3:], float(made.constants["floor"])))


def far(like: Alike, spread: Array) -> Array:
    """Return how far out solids are among those that were learned from, shape (n,)."""
    return np.sqrt(np.mean((like.over @ spread) ** 2, axis=1))


def begin_inputs(tests: tuple[Array, Array, Array], creep: Array) -> Array:
    """Return what is told of where a search begins, of order one, shape (n, BEGIN_INPUTS).

    Parameters
    ----------
    tests : tuple of ndarray, shape (n,)
        Tabor number, modulus ratio and depth of the start.
    creep : ndarray, shape (n, 15)
    """
    mu, k, depth = tests
    case = np.stack([np.log10(k) / 2 + 1, *_test(mu, depth)], axis=1)
    return np.concatenate([2 * climbed(k, creep) - 1, case], axis=1)


def bell(said: Array, floor: float) -> Array:
    """Return how much each sample counts, shape (n, 15).

    Parameters
    ----------
    said : ndarray, shape (n, 3)
        Middle and logarithms of the widths below and above it.
    floor : float
        What each counts at least.
    """
    away = DECADES - said[:, :1]
    below, above = np.exp(np.minimum(np.maximum(said[:, 1:], -WIDEST), WIDEST)).T[..., None]
    return np.exp(-((away / np.where(away < 0, below, above)) ** 2) / 2) + floor


def scaled_over(like: Alike, usual: Array) -> Array:
    """Return what is left over, of order one and large ones less than in proportion, (n, 15)."""
    return np.arcsinh(like.over / usual)


def felt(output: Array) -> Array:
    """Return how much work feels the solid, from 0 at both limits of the force to 1, shape (n, 1).

    Parameters
    ----------
    output : ndarray, shape (m, n)
        What the networks of the force of power laws say.
    """
    part = share(output).mean(axis=0)[:, None]
    return 4 * part * (1 - part)


def features(like: Alike, output: Array) -> Array:
    """Return what the networks of the bends are told of the cases, shape (n, 7).

    Parameters
    ----------
    like : Alike
    output : ndarray, shape (m, n)
        What the networks of the force of power laws say.
    """
    mu, k, n, depth, rate = like.groups.T
    return np.column_stack(
        [
            *_test(mu, depth),
            np.log10(k) / 2 + 1,
            2 * share(output).mean(axis=0) - 1,
            np.log(n),
            np.log10(rate) / 3 - 1,
            np.log10(like.modulus_ratio) / 2 + 1,
        ]
    )


def _test(tabor: Array, preload: Array) -> tuple[Array, Array]:
    return np.log10(tabor) / 1.5 + 1 / 3, (np.log10(preload) - 0.2) / 2.5
