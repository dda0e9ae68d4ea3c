r"""Detachments from any linear solid: from the power law that it is like where that matters.

Force, work and curve are those that the surrogate of power laws (:mod:`viscotack.surrogate.model`)
says of the power law that creeps like the solid (:mod:`viscotack.surrogate.alike`). Which times
matter is learned: how much a sample of the creep counts is a bell with two widths,

.. math:: w_i = e^{-(x_i - c)^2/2 b_\pm^2} + w_0, \qquad x_i = \log_{10}(t_i v/h_0) ,

whose middle c and widths b follow from the test: Tabor number, depth, modulus ratio, the share of
the way between slowest and fastest pull-off, and the exponent that the first likeness found. Both
limits hold for any linear solid, and so they do here; a power law has the same answer through
either door; a solid that is slower, pulled slower, too.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from . import physics, sealed, store
from .alike import DECADES, Alike, again, alike
from .model import Answers, Curves, Intervals, Scaled, Surrogate
from .network import from_arrays
from .trust import CONFIDENCES, INPUTS, OF, Trust, told

Array = npt.NDArray[np.float64]

SHIPPED = Path(__file__).with_name("solids.npz")
# What the window depends on, one and five features; and its middle and the two logarithms of
# widths.
FEATURES, PARTS = 6, 3
# What the network of the errors is told: what it is of power laws; how unlike the solid is, how far
# from those learned from, and how far the window moved exponent and rate.
TRUST_INPUTS = INPUTS + 4
_SAYS = ("start", "fast", "force", "work", "give", "line")
_FORM, _MOST = "viscotack solids 1", 5e6
# Below these likenesses and ways tell nothing more.
_LEAST_UNLIKE, _LEAST_WAY = 1e-4, 1e-3
# Widths of the window [decades] that it may have.
_WIDTHS = (0.05, 12.0)


@dataclass(frozen=True, eq=False)
class Likeness:
    """Power laws that stand for solids.

    Attributes
    ----------
    first : Alike
        With the window that is the same for all.
    found : Alike
        With the one that was learned.
    """

    first: Alike
    found: Alike

    @property
    def groups(self) -> Array:
        """Groups of the tests on the power laws, shape (n, 5)."""
        return self.found.groups

    @property
    def moved(self) -> Array:
        """How far the second window moved exponent and rate [decades], shape (n, 2)."""
        columns = [physics.EXPONENT, physics.RATE]
        return np.log10(self.found.groups[:, columns] / self.first.groups[:, columns])


@dataclass(frozen=True, eq=False)
class Solids:
    """A sphere on any linear solid, pulled from a relaxed start at a constant speed.

    Attributes
    ----------
    power_law : Surrogate
        What answers.
    window : ndarray, shape (6, 3)
        Middle and logarithms of the widths below and above it by the features.
    floor : float
        What each sample counts at least.
    trust : Trust
        How wide the intervals are.
    spread : ndarray, shape (15, 15)
        What is left over times this is of order one for the solids learned from.
    farthest : ndarray, shape (2,)
        How unlike, and how far out by that measure, solids are for which there is an answer.
    """

    power_law: Surrogate
    window: Array
    floor: float
    trust: Trust
    spread: Array
    farthest: Array

    def like(self, tabor: Array, modulus_ratio: Array, preload: Array, creep: Array) -> Likeness:
        """Return the power laws that stand for solids in tests.

        Parameters
        ----------
        tabor, modulus_ratio, preload : ndarray, shape (n,)
            Of the tests.
        creep : ndarray, shape (n, 15)
            Creep over the relaxed one, at ``alike.TIMES`` in units of h0 over the speed.
        """
        first = alike(tabor, modulus_ratio, preload, creep)
        return Likeness(first, again(first, modulus_ratio, creep, self.counts(first)))

    def counts(self, first: Alike) -> Array:
        """Return how much each sample counts, shape (n, 15)."""
        middle, *widths = (features(first, self.power_law) @ self.window).T
        below, above = (np.clip(np.exp(w), *_WIDTHS)[:, None] for w in widths)
        away = DECADES - middle[:, None]
        return np.exp(-((away / np.where(away < 0, below, above)) ** 2) / 2) + self.floor

    def far(self, like: Likeness) -> Array:
        """Return how far out solids are among those that were learned from, shape (n,)."""
        return np.sqrt(np.mean((like.first.over @ self.spread) ** 2, axis=1))

    def inside(self, like: Likeness) -> npt.NDArray[np.bool_]:
        """Return which solids are like those that were learned from, shape (n,)."""
        return (like.first.unlike <= self.farthest[0]) & (self.far(like) <= self.farthest[1])

    def evaluate(self, like: Likeness) -> Answers:
        """Return force and work; they are not checked to lie inside."""
        return self.power_law.evaluate(like.groups)

    def curves(self, like: Likeness, answers: Answers) -> Curves:
        """Return the unloading curves that belong to the answers."""
        return self.power_law.curves(like.groups, answers)

    def told(self, like: Likeness, answers: Answers) -> Array:
        """Return what the network of the errors is told, shape (n, TRUST_INPUTS)."""
        plain = told(like.groups, answers)
        unlike = np.log10(like.first.unlike + _LEAST_UNLIKE) + 3
        far = np.log10(self.far(like) + _LEAST_UNLIKE) + 1
        return np.column_stack([plain, unlike, far, np.log10(np.abs(like.moved) + _LEAST_WAY) + 2])

    def intervals(self, like: Likeness, answers: Answers, *, confidence: float = 0.9) -> Intervals:
        """Return intervals that held so many of the cases that were kept apart.

        Raises
        ------
        ValueError
            If the confidence is not one of those that were measured.
        """
        *halves, curve, travel = self.trust.widths(self.told(like, answers), confidence)
        values = answers.pull_off_force, answers.work_to_pull_off
        force, work = (
            np.column_stack([v / 10**half, v * 10**half])
            for v, half in zip(values, halves, strict=True)
        )
        return Intervals(force, work, curve, np.column_stack([10**-travel, 10**travel]))


def features(first: Alike, power_law: Surrogate) -> Array:
    """Return what the window depends on, of order one, shape (n, FEATURES)."""
    groups = first.groups
    said = power_law.force(physics.scaled(groups))[..., 0].mean(axis=0)
    mu, k, n, depth, _ = groups.T
    return np.column_stack(
        [
            np.ones(len(groups)),
            np.log10(mu) / 1.5 + 1 / 3,
            (np.log10(depth) - 0.2) / 2.5,
            (np.log10(k) + 2) / 2,
            2 * physics.share(said) - 1,
            np.log(n),
        ]
    )


def save(made: Solids, path: str | os.PathLike[str], facts: dict[str, Any]) -> None:
    """Write what was learned of solids, and beside its arrays what is to be known of it.

    The surrogate of power laws is not in the file; the file says which it goes with.
    """
    arrays: dict[str, Any] = made.trust.reach.arrays("trust.")
    arrays |= {"trust.levels": made.trust.levels, "floor": np.array(made.floor)}
    arrays |= {name: getattr(made, name) for name in ("window", "spread", "farthest")}
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
            window=arrays["window"],
            floor=float(arrays["floor"]),
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
    reach, count = made.trust.reach, len(DECADES)
    ends = reach.weights[0].shape[1], reach.weights[-1].shape[2]
    if ends != (TRUST_INPUTS, len(OF)):
        raise InputError(f"its network goes from and to {ends}, not {(TRUST_INPUTS, len(OF))}")
    for name, shape in (
        ("window", (FEATURES, PARTS)),
        ("spread", (count, count)),
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
        part = getattr(store.shipped(), name)
        if isinstance(part, Scaled):
            arrays |= {f"{name}.centre": part.centre, f"{name}.spread": part.spread}
            part = part.networks
        arrays |= part.arrays(f"{name}.")
    return sealed.checksum(arrays)
