r"""Contacts of large Tabor numbers, learned from the theory whose edge is a steady crack.

From a Tabor number of ten on forces reach hardly beyond the edge, and the theory of
:mod:`viscotack.methods.by_crack` answers in a tenth of a second, and some seconds for a new solid.
What it says of spheres on power laws by retardation, pulled from relaxed starts, is learned here:
where the force is between its slowest and its fastest limit,

.. math:: \log \hat P = (1 - s) \log f(\mu) + s \log \frac{f(\mu k^{1/3})}{k} ,

how much energy the crack takes at the pull-off, and how many of its zones it has gone: what the
band of the theory is made of. Where that theory has no answer there is none here.

The networks are told, beside the inputs, what a crack would take whose zone creeps for as long as
it takes to cross it, :math:`\Gamma_s = 1/c(l \Gamma_s/(\mu r))` with the creep c of the solid over
its relaxed one and the rate r, and how far the bulk creeps meanwhile: with these two they tell
other solids from fewer of them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array

from . import physics
from .answers import Answers
from .contact import Contact, Further

# Tabor number, modulus ratio and exponent; the start's depth over the Tabor number, in heights of a
# contact beta^2/R; and the rate over it, in these heights a time of the material.
LOW, HIGH = np.array([10.0, 1e-4, 0.15, 0.1, 1e-6]), np.array([1e6, 0.5, 2.0, 1000.0, 1e6])
_ENDS = np.log10(LOW), np.log10(HIGH)
# Of Gamma - 1, below which it says nothing.
LEAST = 1e-3
# The theory holds from an effective Tabor number of 2 and 1.5 zones on; so much above them the
# networks may be off.
_LEAST_TABOR, _LEAST_ZONES, _SLOW = 2.2, 1.8, 1.1
# Length of a zone in crossing times that tells most, halvings of its energy's logarithm, and the
# largest energy's decades.
_ZONE, _HALVINGS, _DECADES = 0.3, 25, 4.0


def creep_of(groups: Array) -> Callable[[Array], Array]:
    """Return the creep of the solids over the last one as a function of times [tau0], shape (n,).

    Examples
    --------
    >>> rows = np.array([[100.0, 0.1, 0.6, 10.0, 1.0]] * 2)
    >>> creep_of(rows)(np.array([0.0, 1e9])).round(6).tolist()
    [0.1, 1.0]
    """
    k, n = groups[:, physics.MODULUS_RATIO], groups[:, physics.EXPONENT]
    front, half, glassy = 2 / scipy.special.gamma(n), n / 2, 1 - k

    def creep(time: Array) -> Array:
        with np.errstate(invalid="ignore", over="ignore"):
            left = front * time**half * scipy.special.kv(n, 2 * np.sqrt(time))
        # at no time nothing has crept, and K is infinite
        return 1 - glassy * np.where(np.isfinite(left), np.minimum(left, 1.0), 1.0)

    return creep


def crack_alone(groups: Array) -> Array:
    """Return ln of the energy of a crack whose zone creeps while it crosses it, shape (n,)."""
    creep, speed = creep_of(groups), groups[:, physics.TABOR] * groups[:, physics.RATE]
    low = np.zeros(len(groups))
    high = -np.log(groups[:, physics.MODULUS_RATIO])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = middle < -np.log(creep(_ZONE * np.exp(middle) / speed))
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return low


class ShortRangeContact(Contact):
    """A sphere of a large Tabor number on a power law, as the theory of a crack at its edge has it.

    Further outputs, in :attr:`.answers.Answers.more`, are ``amplification``, the energy of the
    crack at the pull-off over the work of adhesion; ``zones``, the way of the edge to the pull-off
    in zones of the crack; and ``effective``, the Tabor number of an elastic contact whose zone is
    as large beside it. The constant ``error`` is the part of the force by which the networks differ
    from the theory in 9 and in 98 of 100 cases of solids that they had not learned from.
    """

    name, inputs, low, high, ends = "short range", physics.INPUTS, LOW, HIGH, _ENDS
    shapes, sizes = {"force": (10, 1), "state": (10, 2)}, {"error": (2,)}

    @staticmethod
    def unit(rows: Array) -> Array:
        """Return the units of the ranges: Tabor numbers for start and rate."""
        found = np.ones_like(rows)
        found[:, physics.PRELOAD] = found[:, physics.RATE] = rows[:, physics.TABOR]
        return found

    @cached_property
    def slow(self) -> Array:
        """log10 of the slowest pull-off force, shape (n,)."""
        return physics.slow_limit(self.rows)

    @cached_property
    def fast(self) -> Array:
        """log10 of the fastest pull-off force of a large contact, shape (n,)."""
        return physics.largest_fast_limit(self.rows)

    @cached_property
    def told(self) -> Array:
        """Inputs of the networks, shape (n, 10)."""
        mu, k, _, depth, rate = self.rows.T
        creep, energy, most = creep_of(self.rows), crack_alone(self.rows), -np.log(k)
        radius = np.sqrt(np.maximum(depth / mu, 1e-3))
        with np.errstate(invalid="ignore", over="ignore"):
            bulk = creep(depth / rate)
            pulled = creep(np.exp(energy * 2 / 3) * mu / rate)
        return np.column_stack(
            [
                self.scaled,
                2 * energy / most - 1,
                2 * energy / (_DECADES * np.log(10)) - 1,
                2 * np.log10(bulk) / _DECADES + 1,
                2 * np.log10(pulled) / _DECADES + 1,
                np.tanh(np.log10(radius) - energy / np.log(10) / 3 - 0.1),
            ]
        )

    def further(self, output: Array) -> Further:
        """Return energy and zones at the pull-off."""
        state = 10 ** self.networks["state"](self.told)[0]
        most = 1 / self.rows[:, physics.MODULUS_RATIO] - 1
        energy = np.clip(state[:, 0] - LEAST, 0.0, most) + 1
        effective = self.rows[:, physics.TABOR] * energy ** (-1 / 3)
        return Further(more={"amplification": energy, "zones": state[:, 1], "effective": effective})

    def holds(self, said: Answers) -> npt.NDArray[np.bool_]:
        """Return where the theory has an answer, by what was learned of it, shape (n,)."""
        steady = (said.more["zones"] >= _LEAST_ZONES) | (said.more["amplification"] <= _SLOW)
        return steady & (said.more["effective"] >= _LEAST_TABOR)
