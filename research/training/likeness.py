r"""Where the search for the power law that a solid is like begins, and which samples count in it.

The search is done slowly here, for many made-up tests on random solids, and a network learns what
came out, so that an answer needs a few steps from there. First with a bell of the counts that is
the same for all, from the best of some power laws; then with the bell whose middle and widths
follow from Tabor number, depth, modulus ratio, the share of the way between slowest and fastest
pull-off, and the exponent that the first search found. The nineteen numbers of that were found by
least squares of the forces of 974 rows of `solids`; 1,700 rows gave none better.
"""

from dataclasses import dataclass, replace

import numpy as np

from viscotack.arrays import Array
from viscotack.model.materials import power_law
from viscotack.model.materials.random_solids import creep_spectrum
from viscotack.prediction.surrogate import physics, store
from viscotack.prediction.surrogate.contact import share
from viscotack.prediction.surrogate.linear_solids import (
    DECADES,
    DOUBTS,
    SOUGHT,
    TIMES,
    USUAL,
    WIDEST,
    Alike,
    alike,
    begin_inputs,
    bell,
    climbed,
    crept,
    left,
)
from viscotack.prediction.surrogate.network import Networks

from .fitting import Fit, Task, fit

Tests = tuple[Array, Array, Array]

# The bell that is the same for all, and what each sample counts at least.
_CENTRE, _WIDTH, _LEAST = 0.25, 0.6, 0.005
PLAIN = np.exp(-((DECADES - _CENTRE) ** 2) / (2 * _WIDTH**2)) + _LEAST
# Middle and logarithms of the widths of the other bell by the features, and its floor.
_WINDOW = np.array(
    [
        [-0.038, -1.542, 0.019],
        [0.047, 0.838, 0.525],
        [0.598, 0.526, 0.046],
        [-0.049, 0.197, 0.01],
        [-0.164, -0.461, -1.175],
        [0.255, -0.015, 0.194],
    ]
)
FLOOR = 0.000321
_FARTHEST = 3.0
# Where a slow search begins, and the step with which it ends.
_EXPONENTS, _RATES = np.geomspace(0.15, 2.0, 10), np.arange(-2.0, 10.1, 0.5)
_ENOUGH = 1e-6
# Made-up tests: random solids from this number on, and power laws; the slowest and the fastest, in
# decades beyond the times of a solid.
SOLIDS, FIRST, POWER_LAWS, _BEYOND, _SEED = 18_000, 500_000, 9_000, 2.5, 5
# Numbers of order one stand for what a network is to say.
_ABOUT = np.array([-3.0, -0.6, 2.0, 0.0, -1.0, 0.0])
_SPREAD = np.array([2.0, 0.8, 2.5, 0.7, 1.0, 1.0])
HOW = Fit(hidden=(32, 32), steps=1200, scale=0.3, penalty=1e-7)


@dataclass(frozen=True, eq=False)
class Sought:
    """What a slow search found, and what a network should have said."""

    like: Alike
    said: Array  # the three numbers that were sought, and the bell, shape (n, 6)


def first(tests: Tests, creep: Array) -> Alike:
    """Return the power laws that solids are like with the bell that is the same for all."""
    k, climb = tests[1], climbed(tests[1], creep)
    ln_n, rate = (x.ravel() for x in np.meshgrid(np.log(_EXPONENTS), _RATES, indexing="ij"))
    part = np.exp(crept(ln_n, rate)[0])
    best = np.empty(len(k), dtype=int)
    for i, ratio in enumerate(k):
        over = np.log(ratio + (1 - ratio) * part) / np.log(ratio) - climb[i]
        best[i] = np.argmin(over**2 @ PLAIN + DOUBTS[1] * (ln_n - USUAL) ** 2)
    begun = np.column_stack([np.log(k), ln_n[best], rate[best]])
    return alike(tests, creep, begun, np.broadcast_to(PLAIN, creep.shape), enough=_ENOUGH)


def sought(tests: Tests, creep: Array) -> Sought:
    """Return the power laws that solids are like with the bell of each test."""
    before = first(tests, creep)
    said = np.clip(_features(before) @ _WINDOW, -WIDEST, WIDEST)
    said[:, 0] = np.clip(said[:, 0], -_FARTHEST, _FARTHEST)
    found = alike(tests, creep, _numbers(before), bell(said, FLOOR), enough=_ENOUGH)
    return Sought(found, np.column_stack([_numbers(found), said]))


def begin(*, how: Fit = HOW, thinned: int = 1) -> Networks:
    """Return the network that says where a search begins, and which samples count.

    Of the made-up tests one in so many is learned from.
    """
    tests, creep = made_up(SOLIDS // thinned, POWER_LAWS // thinned)
    found = sought(tests, creep)
    whole = np.log(tests[1])[:, None]
    _, slopes = left(found.said[:, :3], whole, climbed(tests[1], creep))
    # a number that the samples do not tell is not worth the attention of the network
    told = np.einsum("nim,nm->ni", slopes**2, found.like.counts)
    weight = np.clip(told / np.median(told, axis=0), 0.01, 2.0)
    weight = np.column_stack([weight, np.ones_like(weight)])
    target = (found.said - _ABOUT) / _SPREAD
    network = fit(Task(begin_inputs(tests, creep), target, weight), how, seed=0)
    return replace(network, centre=_ABOUT, spread=_SPREAD)


def made_up(solids: int, power_laws: int) -> tuple[Tests, Array]:
    """Return tests on random solids and on power laws, and what these creep."""
    random = np.random.default_rng(_SEED)
    count = solids + power_laws
    places = random.random((count, len(physics.INPUTS)))
    mu, k, n, depth, rate = (physics.LOW * (physics.HIGH / physics.LOW) ** places).T
    creep = np.empty((count, len(TIMES)))
    for i in range(count):
        if i < solids:
            weights, tau = creep_spectrum(FIRST + i, k[i])
            ends = np.log10(tau[[0, -1]]) + [-_BEYOND, _BEYOND]
            times = TIMES * 10 ** (ends[0] + (ends[1] - ends[0]) * places[i, physics.RATE])
            crept_then = -np.expm1(-times[:, None] / tau) @ (weights / weights.sum())
        else:
            crept_then = power_law.crept(n[i], TIMES / rate[i])
        creep[i] = k[i] + (1 - k[i]) * crept_then
    return (mu, k, depth), np.clip(creep, k[:, None], 1.0)


def _numbers(like: Alike) -> Array:
    """Return the logarithms that were sought, shape (n, 3)."""
    k, n, rate = like.groups[:, SOUGHT].T
    return np.column_stack([np.log(k), np.log(n), np.log10(rate)])


def _features(before: Alike) -> Array:
    """Return what the bell depends on, of order one, shape (n, 6)."""
    groups = before.groups
    said = store.shipped().networks["force"](physics.scaled(groups))[..., 0].mean(axis=0)
    mu, k, n, depth, _ = groups.T
    return np.column_stack(
        [
            np.ones(len(groups)),
            np.log10(mu) / 1.5 + 1 / 3,
            (np.log10(depth) - 0.2) / 2.5,
            (np.log10(k) + 2) / 2,
            2 * share(said) - 1,
            np.log(n),
        ]
    )
