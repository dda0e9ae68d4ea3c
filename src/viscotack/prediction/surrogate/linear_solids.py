r"""Surrogate for any linear solid: an equivalent power law and first-order corrections.

Force, work and curve are those of the surrogate of power laws (:mod:`.physics`) for the equivalent
power law (:class:`Alike`), corrected for the residuals of its creep. The weights
of the samples of the creep are a bell curve with two widths,

.. math:: w_i = e^{-(x_i - c)^2/2 b_\pm^2} + w_0, \qquad x_i = \log_{10}(t_i v/h_0) .

A small network predicts its centre c, its widths b and the start of the search from Tabor number,
depth, modulus ratio and the samples.

Every output is a functional of the logarithm of the creep. For residuals :math:`d_i` at the samples
it changes by :math:`\sum_i K_i d_i` to first order. Here the K for the position of the force
between its limits, and for work over force, are networks of the case and of d itself. Both limits
are valid for any linear solid and are satisfied. A power law gives the same prediction as in the
surrogate of power laws, and a slower solid retracted more slowly too.

**Power law equivalent to a solid around the times of a test.** A retraction at the speed v depends
on the creep of its solid around h0/v, within some decades. There the creep of any solid is
approximated by one of the retardation power laws of the training data,

.. math:: c(t) = k + (1 - k) F_n(t/\tau_0) ,

with its own modulus ratio k, and the exponent and time that minimise the difference of the
logarithms of the two creeps. Creep is sampled at fifteen fixed multiples of h0/v, so rate and
temperature are not inputs: a slower solid retracted more slowly has the same samples. The weights
of the samples and the start of the search are computed by the networks above;
a few steps are sufficient. A power law is equivalent to itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.model.materials import power_law
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.contact import Contact, Further, mean_limit, share
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks
from viscotack.prediction.surrogate.physics import MODULUS_RATIO, PRELOAD, TABOR, SphereContact
from viscotack.prediction.surrogate.trust import Answers

# Times over h0/v at which creep is sampled, two per decade.
DECADES = np.arange(-3.5, 3.6, 0.5)
TIMES = 10.0**DECADES
# Logarithms of exponents and of times at which the creep of power laws is tabulated; the samples
# are multiples of the step of the times.
_LN_N = np.linspace(np.log(0.1), np.log(3.0), 40)
_STEP, _FIRST, _LAST = 0.1, -36.0, 8.0
_LOG_T = _FIRST + _STEP * np.arange(round((_LAST - _FIRST) / _STEP) + 1)
_STEP_N = _LN_N[1] - _LN_N[0]
# Time above which all creep is over and the formula cancels.
_CREPT = 5.9
# Flat indices in the table of the neighbours of all samples, relative to a place: 4 exponents,
# 15 samples, 4 times.
_AROUND = np.arange(-1, 3)
_NEAR = (
    _AROUND[:, None, None] * len(_LOG_T)
    + np.rint((DECADES - DECADES[0]) / _STEP).astype(int)[:, None]
    + _AROUND
).ravel()
# From powers of a place between neighbours to their weights in a cubic and to its derivatives.
_CUBIC = (
    np.array(
        [
            [[0, -2], [6, -3], [0, 6], [0, -1]],
            [[-2, 6], [-3, -12], [6, 6], [-1, 0]],
            [[3, -3], [-6, 9], [3, -9], [0, 3]],
            [[-1, 0], [3, 0], [-3, 0], [1, 0]],
        ]
    ).reshape(4, 8)
    / 6
)
# Unknowns: modulus ratio, exponent and rate; largest number of steps, largest step lengths,
# and the fraction of the curvature that damps the first step.
SOUGHT = (physics.MODULUS_RATIO, physics.EXPONENT, physics.RATE)
_MOST, _LONGEST, _SHORTER = 20, np.array([1.0, 0.5, 1.0]), 1e-2
# A step shorter than this ends the search.
ENOUGH = 5e-3
STIFFEST = np.log(physics.LIMITS["modulus_ratio"][1])
ENDS = np.log(physics.LIMITS["exponent"]), np.log10(physics.LIMITS["rate"])
# Prior values: if the creep is over or has not begun, it does not determine the exponent; if it
# does not determine the glassy modulus, the modulus ratio is that of the solid.
USUAL, DOUBTS = np.log(0.6), np.array([1e-5, 1e-6, 1e-9])
_ROWS = 2000
_ONE = np.eye(3)


@dataclass(frozen=True, eq=False)
class Alike:
    """Power laws equivalent to solids around the times of their tests.

    Attributes
    ----------
    groups : ndarray, shape (n, 5)
        Inputs of the tests on these power laws, in the order of ``physics.INPUTS``.
    modulus_ratio : ndarray, shape (n,)
        Modulus ratios of the solids.
    over : ndarray, shape (n, 15)
        Residuals at ``TIMES``: logarithm of the power law's creep minus that of the solid's,
        over that of the modulus ratio.
    counts : ndarray, shape (n, 15)
        Weights of the samples.
    climb : ndarray, shape (n, 15)
        Creep of the solids at ``TIMES`` on a scale from 0 (rubber) to 1 (glass), :func:`climbed`.
    """

    groups: Array
    modulus_ratio: Array
    over: Array
    counts: Array
    climb: Array

    @property
    def unlike(self) -> Array:
        """Root mean square of the residuals, shape (n,)."""
        return np.sqrt(np.sum(self.counts * self.over**2, axis=1) / self.counts.sum(axis=1))


def climbed(modulus_ratio: Array, creep: Array) -> Array:
    """Return ln(creep) on a scale from 0 (rubber) to 1 (glass), shape (n, 15)."""
    return np.log(creep) / np.log(modulus_ratio)[:, None]


def alike(
    tests: tuple[Array, Array, Array],
    creep: Array,
    begun: Array,
    counts: Array,
    *,
    enough: float = ENOUGH,
) -> Alike:
    """Fit the power laws equivalent to solids.

    Parameters
    ----------
    tests : tuple of ndarray, shape (n,)
        Tabor number, modulus ratio and depth of the start.
    creep : ndarray, shape (n, 15)
        Creep relative to the relaxed one, at ``TIMES`` in units of h0 over the speed.
    begun : ndarray, shape (n, 3)
        Start of the search: ln of modulus ratio and exponent, log10 of the rate.
    counts : ndarray, shape (n, 15)
        Weights of the samples.
    enough : float
        A step shorter than this ends the search.

    Examples
    --------
    The creep of a standard solid is over within one decade, more steeply than any power law:

    >>> one = np.ones(1)
    >>> creep, counts = 1 - 0.9 * np.exp(-TIMES / 30)[None], np.exp(-(DECADES[None] ** 2))
    >>> begun = np.log([[0.1, 0.6, 2.0]])
    >>> found = alike((one, 0.1 * one, one), creep, begun, counts)
    >>> f"{found.groups[0, 2]:.1f}, {found.unlike[0]:.3f}"
    '2.0, 0.015'
    """
    tabor, k, preload = tests
    share = climbed(k, creep)
    x, over = np.empty((len(k), 3)), np.empty_like(share)
    for i in range(0, len(k), _ROWS):
        some = slice(i, i + _ROWS)
        whole = np.log(k[some])[:, None]
        x[some], over[some] = _sought(whole, share[some], begun[some], counts[some], enough)
    groups = np.column_stack([tabor, np.exp(x[:, :2]), preload, 10 ** x[:, 2]])
    return Alike(groups, k, over, counts, share)


def _sought(
    whole: Array, share: Array, begun: Array, counts: Array, enough: float
) -> tuple[Array, Array]:
    """Return ln k, ln n and log10 of the rate of power laws, shape (n, 3), and the residuals.

    Uses Levenberg-Marquardt steps; an unknown at its bound is fixed while the others are updated.

    Parameters
    ----------
    whole : ndarray, shape (n, 1)
        ln k of the solids.
    share, counts : ndarray, shape (n, 15)
    begun : ndarray, shape (n, 3)
    enough : float
    """
    low, high = ends(whole)
    x = np.minimum(np.maximum(begun, low), high)
    usual = np.concatenate([whole, np.full_like(whole, USUAL), x[:, 2:]], axis=1)
    over, slopes = left(x, whole, share)
    best, shorter = _cost(counts, over, x - usual), np.full(len(x), _SHORTER)
    found, found_over, place = x.copy(), over.copy(), np.arange(len(x))
    for _ in range(_MOST):
        new = _next(x, over, slopes, usual, counts, shorter, low, high)
        new_over, new_slopes = left(new, whole, share)
        cost = _cost(counts, new_over, new - usual)
        better = cost <= best
        settled = better & (np.abs(new - x).max(axis=1) < enough)
        shorter = np.where(better, 0.1 * shorter, 10 * shorter)
        if not better.all():
            up = ~better
            new[up], new_over[up], new_slopes[up] = x[up], over[up], slopes[up]
            cost = np.minimum(cost, best)
        x, over, slopes, best = new, new_over, new_slopes, cost
        if settled.any():
            found[place], found_over[place] = x, over
            if settled.all():
                return found, found_over
            on = ~settled
            place = place[on]
            rows = x, over, slopes, best, shorter, usual, counts, low, whole, share
            x, over, slopes, best, shorter, usual, counts, low, whole, share = (r[on] for r in rows)
    found[place], found_over[place] = x, over
    return found, found_over


def _next(
    x: Array,
    over: Array,
    slopes: Array,
    usual: Array,
    counts: Array,
    shorter: Array,
    low: Array,
    high: Array,
) -> Array:
    """Return the next iterate, shape (n, 3)."""
    weighed = slopes * counts[:, None]
    bent = weighed @ slopes.transpose(0, 2, 1)
    own = DOUBTS + shorter[:, None] * np.einsum("nii->ni", bent)
    bent = bent + _ONE * own[:, None]
    fall = -(weighed @ over[..., None])[..., 0] - DOUBTS * (x - usual)
    new = _stepped(x, np.linalg.solve(bent, fall[..., None])[..., 0], low, high)
    held = (new == low) | (new == high)
    if not held.any():
        return new
    away = np.where(held, new - x, 0.0)
    fall = np.where(held, away, fall - (bent @ away[..., None])[..., 0])
    both = held[:, :, None] | held[:, None]
    step = np.linalg.solve(np.where(both, _ONE, bent), fall[..., None])[..., 0]
    return _stepped(x, step, low, high)


def ends(whole: Array) -> tuple[Array, Array]:
    """Return the lower bounds of the unknowns, shape (n, 3), and the upper ones, shape (3,)."""
    least = [np.full_like(whole, end[0]) for end in ENDS]
    return np.concatenate([whole, *least], axis=1), np.array([STIFFEST, *(e[1] for e in ENDS)])


def _stepped(x: Array, step: Array, low: Array, high: Array) -> Array:
    limited = np.minimum(np.maximum(step, -_LONGEST), _LONGEST)
    return np.minimum(np.maximum(x + limited, low), high)


def _cost(counts: Array, over: Array, unusual: Array) -> Array:
    return np.sum(counts * over**2, axis=1) + unusual**2 @ DOUBTS


def left(x: Array, whole: Array, share: Array) -> tuple[Array, Array]:
    """Return the residuals, shape (n, 15), and their derivatives, shape (n, 3, 15)."""
    k = np.exp(x[:, :1])
    log_f, by_n, by_rate = crept(x[:, 1], x[:, 2])
    part = np.exp(log_f)
    c = k + (1 - k) * part
    inverse = 1 / (c * whole)
    steep = (1 - k) * part * inverse
    slopes = np.stack([k * (1 - part) * inverse, steep * by_n, steep * by_rate], axis=1)
    return np.log(c) / whole - share, slopes


def crept(ln_n: Array, rate: Array) -> tuple[Array, Array, Array]:
    """Return ln of the finished creep at the samples, and its derivatives; (n, 15) each.

    Uses cubic interpolation in the table, in both directions.

    Parameters
    ----------
    ln_n, rate : ndarray, shape (n,)
        Logarithm of the exponent, log10 of the rate.
    """
    at = (ln_n - _LN_N[0]) / _STEP_N
    i = np.minimum(np.maximum(at.astype(int), 1), len(_LN_N) - 3)
    along = _cubic(at - i)
    at = (DECADES[0] - _FIRST - rate) / _STEP
    j = np.floor(at).astype(int)
    across = _cubic(at - j)
    some = _table().take((i * len(_LOG_T) + j)[:, None] + _NEAR).reshape(-1, 4, len(DECADES), 4)
    of_n = some @ across[:, None]
    both = along.transpose(0, 2, 1) @ of_n.reshape(-1, 4, 2 * len(DECADES))
    both = both.reshape(-1, 2, len(DECADES), 2)
    return both[:, 0, :, 0], both[:, 1, :, 0] / _STEP_N, both[:, 0, :, 1] / -_STEP


@cache
def _table() -> Array:
    """Return ln of the finished fraction of the creep of power laws, computed once."""
    times = 10.0 ** np.minimum(_LOG_T, _CREPT)
    return np.log([power_law.crept(np.exp(ln_n), times) for ln_n in _LN_N]).ravel()


def _cubic(f: Array) -> Array:
    """Return cubic weights of the neighbours at -1, 0, 1, 2, and derivatives; (n, 4, 2)."""
    square = f * f
    powers = np.stack([np.ones_like(f), f, square, square * f], axis=1)
    return (powers @ _CUBIC).reshape(-1, 4, 2)


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
    data; and ``farthest``, their largest :attr:`Alike.unlike` and :attr:`far`. A further
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
