r"""Surrogate for any linear solid: an equivalent power law and first-order corrections.

Force, work and curve are those of the surrogate of power laws (:mod:`.physics`) for the equivalent
power law (:mod:`.alike`), corrected for the residuals of its creep. The weights
of the samples of the creep are a bell curve with two widths,

.. math:: w_i = e^{-(x_i - c)^2/2 b_\pm^2} + w_0, \qquad x_i = \log_{10}(t_i v/h_0) .

A small network predicts its centre c, its widths b and the start of the search from Tabor number,
depth, modulus ratio and the samples.

Every output is a functional of the logarithm of the creep. For residuals :math:`d_i` at the samples
it changes by :math:`\sum_i K_i d_i` to first order. Here the K for the position of the force
between its limits, and for work over force, are networks of the case and of d itself. Both limits
are valid for any linear solid and are satisfied. A power law gives the same prediction as in the
surrogate of power laws, and a slower solid retracted more slowly too.
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
from .contact import Contact, Further, mean_limit, share
from .model import Surrogate
from .network import Networks
from .physics import MODULUS_RATIO, PRELOAD, TABOR, SphereContact
from .trust import Answers

SAMPLES = len(DECADES)
# Times over depth over speed at which the second networks know the creep [decades].
_AROUND_DEPTH = np.array([-1.5, -1.0, -0.5, -0.25, 0.0, 0.25, 0.5])
# Values below which dissimilarity and corrections have no effect.
_LEAST_UNLIKE, _LEAST_BEND = 1e-4, 1e-4
# Allowed logarithms of the widths of the bell [decades].
WIDEST = 2.4


@dataclass(frozen=True, eq=False)
class SolidContact(SphereContact):
    """A sphere on any linear solid, by its equivalent power law with corrections.

    Networks in addition to those of power laws are ``begin``, for the start of the search for a
    power law and the weights of the samples, and ``bend_force`` and ``bend_work``, for the
    corrections. Constants are ``floor``, the smallest weight of a sample; ``usual``, the root mean
    square of the residuals; ``spread``, a matrix that normalises the residuals of the training
    data; and ``farthest``, their largest :attr:`.alike.Alike.unlike` and :attr:`far`. A further
    output (:attr:`.trust.Answers.more`) is ``bends``, shape (n, 4): the sizes of the corrections
    of force and work, and their standard deviations between the networks.
    """

    like: Alike

    name = "solids"
    shared = ("start", "fast", "force", "work", "give", "line")
    smooth = False

    @classmethod
    def of(
        cls, networks: Mapping[str, Networks], constants: Mapping[str, Array], given: Any
    ) -> Self:
        """Return the tests on solids that were fitted by :func:`like`."""
        return cls(networks, constants, given.groups, given)

    def deeper(self, factors: Array) -> Contact:
        """Return uncorrected tests on the power laws with their depths multiplied by factors."""
        return SphereContact(self.networks, self.constants, self.rows).deeper(factors)

    @cached_property
    def far(self) -> Array:
        """Distance of the solids from the centre of the training data, shape (n,)."""
        return far(self.like, self.constants["spread"])

    def inside(self) -> npt.NDArray[np.bool_]:
        """Return whether the solids are as similar to power laws as the training data, (n, 2)."""
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

    @cached_property
    def second_limits(self) -> tuple[Array, Array]:
        """log10 of the limits of the force with the modulus ratio of the solid, shape (n,) each."""
        rows = self.rows.copy()
        rows[:, MODULUS_RATIO] = self.like.modulus_ratio
        return self.slow, mean_limit(SphereContact(self.networks, self.constants, rows).fast)

    @cached_property
    def told_of_second(self) -> Array:
        """Inputs of the second networks, without the equivalent power law; (n, columns)."""
        depth = self.rows[:, PRELOAD]
        return np.column_stack(
            [
                *_test(self.rows[:, TABOR], depth),
                np.log10(self.like.modulus_ratio) / 2 + 1,
                *self.second_limits,
                2 * self.like.climb - 1,
                2 * _at_times(self.like.climb, np.log10(depth)[:, None] + _AROUND_DEPTH) - 1,
            ]
        )

    def told_of_errors(self, answers: Answers) -> Array:
        """Return the inputs of the networks of the errors, shape (n, columns)."""
        unlike = np.log10(self.like.unlike + _LEAST_UNLIKE) + 3
        far = np.log10(self.far + _LEAST_UNLIKE) + 1
        bends = np.log10(answers.more["bends"] + _LEAST_BEND) + 2
        return np.column_stack([super().told_of_errors(answers), unlike, far, bends])


def like(
    made: Surrogate, tabor: Array, modulus_ratio: Array, preload: Array, creep: Array
) -> Alike:
    """Fit the power laws equivalent to solids in tests.

    Parameters
    ----------
    made : Surrogate
        Surrogate of solids.
    tabor, modulus_ratio, preload : ndarray, shape (n,)
        Inputs of the tests.
    creep : ndarray, shape (n, 15)
        Creep relative to the relaxed one, at ``alike.TIMES`` in units of h0 over the speed.
    """
    tests = tabor, modulus_ratio, preload
    said = made.networks["begin"](begin_inputs(tests, creep))[0]
    return alike(tests, creep, said[:, :3], bell(said[:, 3:], float(made.constants["floor"])))


def far(like: Alike, spread: Array) -> Array:
    """Return the distance of solids from the centre of the training data, shape (n,)."""
    return np.sqrt(np.mean((like.over @ spread) ** 2, axis=1))


def begin_inputs(tests: tuple[Array, Array, Array], creep: Array) -> Array:
    """Return the normalised inputs of the network for the start of a search, (n, 18).

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
    """Return the weights of the samples, shape (n, 15).

    Parameters
    ----------
    said : ndarray, shape (n, 3)
        Centre and logarithms of the widths below and above it.
    floor : float
        Smallest weight.
    """
    away = DECADES - said[:, :1]
    below, above = np.exp(np.minimum(np.maximum(said[:, 1:], -WIDEST), WIDEST)).T[..., None]
    return np.exp(-((away / np.where(away < 0, below, above)) ** 2) / 2) + floor


def scaled_over(like: Alike, usual: Array) -> Array:
    """Return normalised residuals, with large ones compressed, shape (n, 15)."""
    return np.arcsinh(like.over / usual)


def felt(output: Array) -> Array:
    """Return the sensitivity of the work to viscoelasticity: 0 at both limits, up to 1, (n, 1).

    Parameters
    ----------
    output : ndarray, shape (m, n)
        Outputs of the networks of the force of power laws.
    """
    part = share(output).mean(axis=0)[:, None]
    return 4 * part * (1 - part)


def features(like: Alike, output: Array) -> Array:
    """Return the inputs of the correction networks that describe the case, shape (n, 7).

    Parameters
    ----------
    like : Alike
    output : ndarray, shape (m, n)
        Outputs of the networks of the force of power laws.
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


def _at_times(climb: Array, decades: Array) -> Array:
    """Interpolate the creep of each solid to log10 of times over h0/v, shape (n, times)."""
    place = np.clip((decades - DECADES[0]) / (DECADES[1] - DECADES[0]), 0, SAMPLES - 1)
    i = np.clip(place.astype(int), 1, SAMPLES - 3)
    f, (before, a, b, after) = (
        place - i,
        (np.take_along_axis(climb, i + j, axis=1) for j in (-1, 0, 1, 2)),
    )
    # a cubic through the values, with the mean slopes of both neighbours (Catmull and Rom)
    rise, bend = b - before, 2 * before - 5 * a + 4 * b - after
    return a + 0.5 * f * (rise + f * (bend + f * (3 * (a - b) + after - before)))


def _test(tabor: Array, preload: Array) -> tuple[Array, Array]:
    return np.log10(tabor) / 1.5 + 1 / 3, (np.log10(preload) - 0.2) / 2.5
