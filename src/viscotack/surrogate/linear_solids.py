r"""Detachments from any linear solid: from the power law that it is like, and what it leaves over.

Force, work and curve are those that the surrogate of power laws (:mod:`viscotack.surrogate.model`)
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

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from . import physics, sealed, store
from .alike import DECADES, Alike, alike, climbed
from .answers import Answers, Intervals
from .line import Curves
from .model import Scaled, Surrogate
from .network import Networks, from_arrays
from .trust import CONFIDENCES, INPUTS, OF, Trust, error_inputs

SHIPPED = Path(__file__).with_name("solids.npz")
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
_SAYS = ("start", "fast", "force", "work", "give", "line")
_FORM, _MOST = "viscotack solids 2", 5e6
# Below these likenesses and bends tell nothing more.
_LEAST_UNLIKE, _LEAST_BEND = 1e-4, 1e-4
# Logarithms of widths of the bell [decades] that it may have.
WIDEST = 2.4


@dataclass(frozen=True, eq=False)
class SolidAnswers(Answers):
    """Predicted numbers of some rows, and how they were bent.

    Attributes
    ----------
    bends : ndarray, shape (n, 4)
        How far the output that places the force and log10 of work over force were bent, and how
        far the networks are apart in it.
    """

    bends: Array


@dataclass(frozen=True, eq=False)
class Solids:
    """A sphere on any linear solid, pulled from a relaxed start at a constant speed.

    Attributes
    ----------
    power_law : Surrogate
        What answers.
    begin : Scaled
        Where the search for a power law begins, and which samples count in it.
    floor : float
        What each sample counts at least.
    usual : ndarray, shape (15,)
        Root mean square of what is left over.
    force, work : Networks
        How what is left over bends an answer.
    trust : Trust
        How wide the intervals are.
    spread : ndarray, shape (15, 15)
        What is left over times this is of order one for the solids learned from.
    farthest : ndarray, shape (2,)
        How unlike, and how far out by that measure, solids are for which there is an answer.
    """

    power_law: Surrogate
    begin: Scaled
    floor: float
    usual: Array
    force: Networks
    work: Networks
    trust: Trust
    spread: Array
    farthest: Array

    def like(self, tabor: Array, modulus_ratio: Array, preload: Array, creep: Array) -> Alike:
        """Return the power laws that stand for solids in tests.

        Parameters
        ----------
        tabor, modulus_ratio, preload : ndarray, shape (n,)
            Of the tests.
        creep : ndarray, shape (n, 15)
            Creep over the relaxed one, at ``alike.TIMES`` in units of h0 over the speed.
        """
        tests = tabor, modulus_ratio, preload
        said = self.begin(begin_inputs(tests, creep))[0]
        return alike(tests, creep, said[:, :3], bell(said[:, 3:], self.floor))

    def far(self, like: Alike) -> Array:
        """Return how far out solids are among those that were learned from, shape (n,)."""
        return np.sqrt(np.mean((like.over @ self.spread) ** 2, axis=1))

    def inside(self, like: Alike) -> npt.NDArray[np.bool_]:
        """Return which solids are like those that were learned from, shape (n,)."""
        return (like.unlike <= self.farthest[0]) & (self.far(like) <= self.farthest[1])

    def evaluate(self, like: Alike) -> SolidAnswers:
        """Return force and work; they are not checked to lie inside."""
        over = scaled_over(like, self.usual)
        bends: list[Array] = []

        def bent(output: Array) -> tuple[Array, Array]:
            inputs = np.column_stack([features(like, output), over])
            ways = (self.force, over), (self.work, over * felt(output))
            each = [(part(inputs) * factors).mean(axis=2) for part, factors in ways]
            mean = [one.mean(axis=0) for one in each]
            bends.extend([*map(np.abs, mean), *(one.std(axis=0) for one in each)])
            return mean[0], mean[1]

        said = self.power_law.evaluate(like.groups, bent)
        return SolidAnswers(**vars(said), bends=np.column_stack(bends))

    def curves(self, like: Alike, answers: Answers) -> Curves:
        """Return the unloading curves that belong to the answers."""
        return self.power_law.curves(like.groups, answers)

    def told(self, like: Alike, answers: SolidAnswers) -> Array:
        """Return what the network of the errors is told, shape (n, TRUST_INPUTS)."""
        plain = error_inputs(physics.scaled(like.groups), answers)
        unlike = np.log10(like.unlike + _LEAST_UNLIKE) + 3
        far = np.log10(self.far(like) + _LEAST_UNLIKE) + 1
        return np.column_stack([plain, unlike, far, np.log10(answers.bends + _LEAST_BEND) + 2])

    def intervals(
        self, like: Alike, answers: SolidAnswers, *, confidence: float = 0.9
    ) -> Intervals:
        """Return intervals that held so many of the cases that were kept apart.

        Raises
        ------
        ValueError
            If the confidence is not one of those that were measured.
        """
        return self.trust.intervals(self.told(like, answers), answers, confidence)


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
    share = physics.share(output).mean(axis=0)[:, None]
    return 4 * share * (1 - share)


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
            2 * physics.share(output).mean(axis=0) - 1,
            np.log(n),
            np.log10(rate) / 3 - 1,
            np.log10(like.modulus_ratio) / 2 + 1,
        ]
    )


def _test(tabor: Array, preload: Array) -> tuple[Array, Array]:
    return np.log10(tabor) / 1.5 + 1 / 3, (np.log10(preload) - 0.2) / 2.5


def save(made: Solids, path: str | os.PathLike[str], facts: dict[str, Any]) -> None:
    """Write what was learned of solids, and beside its arrays what is to be known of it.

    The surrogate of power laws is not in the file; the file says which it goes with.
    """
    arrays: dict[str, Any] = made.begin.arrays("begin.") | made.force.arrays("force.")
    arrays |= made.work.arrays("work.") | made.trust.reach.arrays("trust.")
    arrays |= {"trust.levels": made.trust.levels, "floor": np.array(made.floor)}
    arrays |= {name: getattr(made, name) for name in ("usual", "spread", "farthest")}
    sealed.write(path, arrays, _FORM, {"power law": _power_law(), **facts})


def load(path: str | os.PathLike[str]) -> tuple[Solids, dict[str, Any]]:
    """Return what a file has, and what it says of that.

    Raises
    ------
    ValueError
        If the file is not one that :func:`save` wrote, is damaged, or was made for another
        surrogate of power laws than that of the package.
    """
    with sealed.opened(path, _FORM, "what was learned of solids", _MOST) as (arrays, words):
        if words["power law"] != _power_law():
            raise InputError("it corrects another surrogate of power laws; learn it again")
        made = Solids(
            power_law=store.shipped(),
            begin=Scaled.of(arrays, "begin."),
            floor=float(arrays["floor"]),
            usual=arrays["usual"],
            force=from_arrays(arrays, "force."),
            work=from_arrays(arrays, "work."),
            trust=Trust(from_arrays(arrays, "trust."), arrays["trust.levels"]),
            spread=arrays["spread"],
            farthest=arrays["farthest"],
        )
        _check(made)
        return made, words


@cache
def shipped() -> Solids:
    """Return what comes with the package, read once."""
    return load(SHIPPED)[0]


def _check(made: Solids) -> None:
    """Refuse arrays that do not fit to one another."""
    for name, part, wanted in (
        ("begin", made.begin.networks, (BEGIN_INPUTS, BEGIN_OUTPUTS)),
        ("force", made.force, (BEND_INPUTS, SAMPLES)),
        ("work", made.work, (BEND_INPUTS, SAMPLES)),
        ("trust", made.trust.reach, (TRUST_INPUTS, len(OF))),
    ):
        ends = part.weights[0].shape[1], part.weights[-1].shape[2]
        if ends != wanted:
            raise InputError(f"its network {name} goes from and to {ends}, not {wanted}")
    for name, shape in (
        ("usual", (SAMPLES,)),
        ("spread", (SAMPLES, SAMPLES)),
        ("farthest", (2,)),
    ):
        if getattr(made, name).shape != shape:
            raise InputError(f"{name} has the shape {getattr(made, name).shape}, not {shape}")
    if made.trust.levels.shape != (len(OF), len(CONFIDENCES)):
        raise InputError(f"its levels have the shape {made.trust.levels.shape}")


def _power_law() -> str:
    """Return the checksum of what the surrogate of power laws says; its own intervals are apart."""
    arrays: dict[str, Any] = {}
    for name in _SAYS:
        arrays |= getattr(store.shipped(), name).arrays(f"{name}.")
    return sealed.checksum(arrays)
