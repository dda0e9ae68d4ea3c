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

import os
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import gamma, kv

from viscotack.arrays import Array
from viscotack.errors import InputError

from . import physics, sealed
from .network import Networks, from_arrays

SHIPPED = Path(__file__).with_name("short_range.npz")
# Tabor number, modulus ratio and exponent; the start's depth over the Tabor number, in heights of a
# contact beta^2/R; and the rate over it, in these heights a time of the material.
LOW, HIGH = np.array([10.0, 1e-4, 0.15]), np.array([1e6, 0.5, 2.0])
STARTS, TIMES = (0.1, 1000.0), (1e-6, 1e6)
# Of Gamma - 1, below which it says nothing.
LEAST = 1e-3
# The theory holds from an effective Tabor number of 2 and 1.5 zones on; so much above them the
# networks may be off.
_LEAST_TABOR, _LEAST_ZONES, _SLOW = 2.2, 1.8, 1.1
_FORM, _MOST = "viscotack short range 1", 5e6
_INPUTS = 10
# Length of a zone in crossing times that tells most, halvings of its energy's logarithm, and the
# largest energy's decades.
_ZONE, _HALVINGS, _DECADES = 0.3, 25, 4.0


def scaled(groups: Array) -> Array:
    """Return the logarithms of what the theory depends on, from -1 to 1 over the range; (n, 5).

    These are Tabor number, modulus ratio, exponent, and start and rate in units of the contact.
    """
    tabor = groups[:, physics.TABOR]
    columns = np.column_stack(
        [groups[:, :3], groups[:, physics.PRELOAD] / tabor, groups[:, physics.RATE] / tabor]
    )
    low = np.log10([*LOW, STARTS[0], TIMES[0]])
    high = np.log10([*HIGH, STARTS[1], TIMES[1]])
    return (2 * np.log10(columns) - (low + high)) / (high - low)


def told(groups: Array) -> Array:
    """Return what the networks are told of rows, shape (n, 10)."""
    mu, k, _, depth, rate = groups.T
    energy, most = crack_alone(groups), -np.log(k)
    radius = np.sqrt(np.maximum(depth / mu, 1e-3))
    with np.errstate(invalid="ignore", over="ignore"):
        bulk = crept(groups, depth / rate)
        pulled = crept(groups, np.exp(energy * 2 / 3) * mu / rate)
    return np.column_stack(
        [
            scaled(groups),
            2 * energy / most - 1,
            2 * energy / (_DECADES * np.log(10)) - 1,
            2 * np.log10(bulk) / _DECADES + 1,
            2 * np.log10(pulled) / _DECADES + 1,
            np.tanh(np.log10(radius) - energy / np.log(10) / 3 - 0.1),
        ]
    )


def crept(groups: Array, time: Array) -> Array:
    """Return the creep of the solids at times [tau0] over what they creep at last, shape (n,).

    Examples
    --------
    >>> rows = np.array([[100.0, 0.1, 0.6, 10.0, 1.0]] * 2)
    >>> crept(rows, np.array([0.0, 1e9])).round(6).tolist()
    [0.1, 1.0]
    """
    k, n = groups[:, physics.MODULUS_RATIO], groups[:, physics.EXPONENT]
    with np.errstate(invalid="ignore", over="ignore"):
        left = 2 / gamma(n) * time ** (n / 2) * kv(n, 2 * np.sqrt(time))
    # at no time nothing has crept, and K is infinite
    return 1 - (1 - k) * np.where(np.isfinite(left), np.minimum(left, 1.0), 1.0)


def crack_alone(groups: Array) -> Array:
    """Return ln of the energy of a crack whose zone creeps while it crosses it, shape (n,)."""
    speed = groups[:, physics.TABOR] * groups[:, physics.RATE]
    low = np.zeros(len(groups))
    high = -np.log(groups[:, physics.MODULUS_RATIO])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = middle < -np.log(crept(groups, _ZONE * np.exp(middle) / speed))
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return low


def limits(groups: Array) -> tuple[Array, Array]:
    """Return log10 of the slowest and of the fastest pull-off force, each of shape (n,)."""
    return physics.slow_limit(groups), physics.largest_fast_limit(groups)


@dataclass(frozen=True, eq=False)
class Said:
    """What was learned says of some cases, arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0]
    amplification : ndarray
        Energy of the crack at the pull-off over the work of adhesion.
    zones : ndarray
        Way of the edge to the pull-off in zones of the crack.
    effective : ndarray
        Tabor number of an elastic contact whose zone is as large beside it.
    """

    pull_off_force: Array
    amplification: Array
    zones: Array
    effective: Array


@dataclass(frozen=True, eq=False)
class ShortRange:
    """Networks of the theory of a crack at the edge.

    Attributes
    ----------
    force, state : Networks
        Of the share between the limits; of energy and zones, scaled.
    centre, spread : ndarray, shape (2,)
        Of the logarithms of energy less one and of the zones.
    error : ndarray, shape (2,)
        Part of the force by which the networks differ from the theory in 9 and in 98 of 100 cases
        of solids that they had not learned from.
    """

    force: Networks
    state: Networks
    centre: Array
    spread: Array
    error: Array

    def evaluate(self, groups: Array) -> Said:
        """Return what was learned of rows of groups; they are not checked to lie inside."""
        inputs = told(groups)
        force = 10 ** physics.between(*limits(groups), self.force(inputs)[..., 0]).mean(axis=0)
        state = 10 ** (self.centre + self.spread * self.state(inputs)[0])
        energy = np.clip(state[:, 0] - LEAST, 0.0, 1 / groups[:, physics.MODULUS_RATIO] - 1) + 1
        return Said(force, energy, state[:, 1], groups[:, physics.TABOR] * energy ** (-1 / 3))

    def inside(self, groups: Array) -> npt.NDArray[np.bool_]:
        """Return which rows lie in the range, and where the theory has an answer, shape (n,)."""
        found = self.in_range(groups)
        if np.any(found):
            found[found] = self.holds(self.evaluate(groups[found]))
        return found

    @staticmethod
    def holds(said: Said) -> npt.NDArray[np.bool_]:
        """Return where the theory has an answer, by what was learned of it, shape (n,)."""
        steady = (said.zones >= _LEAST_ZONES) | (said.amplification <= _SLOW)
        return steady & (said.effective >= _LEAST_TABOR)

    @staticmethod
    def in_range(groups: Array) -> npt.NDArray[np.bool_]:
        """Return which rows lie in the range of the cases that were learned from, shape (n,)."""
        with np.errstate(invalid="ignore"):
            return np.all(np.abs(scaled(groups)) <= 1 + 1e-9, axis=1)


def measured(made: ShortRange, groups: Array, said: Array) -> tuple[ShortRange, dict[str, Any]]:
    """Return networks with their error on cases of other solids, and what they are worth.

    Parameters
    ----------
    made : ShortRange
        That has not learned from these cases.
    groups : ndarray, shape (n, 5)
    said : ndarray, shape (n, 4)
        Force, amplification, zones and work by the theory.
    """
    found = made.evaluate(groups)
    inside = made.inside(groups)
    off = np.abs(found.pull_off_force / said[:, 0] - 1)[inside]
    error = np.quantile(off, [0.9, 0.98])
    scores = {
        "cases": int(inside.sum()),
        "mse_log10": float(np.mean(np.log10(found.pull_off_force / said[:, 0])[inside] ** 2)),
        "median": float(np.median(off)),
        "90 %": float(error[0]),
        "98 %": float(error[1]),
        "largest": float(off.max()),
    }
    return replace(made, error=error), scores


def save(made: ShortRange, path: str | os.PathLike[str], facts: dict[str, Any]) -> None:
    """Write networks with what is to be known of them."""
    arrays: dict[str, Any] = made.force.arrays("force.") | made.state.arrays("state.")
    arrays |= {name: getattr(made, name) for name in ("centre", "spread", "error")}
    sealed.write(path, arrays, _FORM, facts)


def load(path: str | os.PathLike[str]) -> tuple[ShortRange, dict[str, Any]]:
    """Return the networks of a file, and what it says of them.

    Raises
    ------
    ValueError
        If the file is not one that :func:`save` wrote, or is damaged.
    """
    with sealed.opened(path, _FORM, "the file of a learned theory", _MOST) as (arrays, words):
        force, state = from_arrays(arrays, "force."), from_arrays(arrays, "state.")
        made = ShortRange(force, state, *(arrays[n] for n in ("centre", "spread", "error")))
        if force.weights[0].shape[1] != _INPUTS or made.centre.shape != (2,):
            raise InputError("its networks have other inputs")
        return made, words


@cache
def shipped() -> ShortRange:
    """Return the networks that come with the package, read once."""
    return load(SHIPPED)[0]
