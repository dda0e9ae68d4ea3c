r"""Surrogate for large Tabor numbers, trained on the theory of a steady crack at the edge.

Above a Tabor number of ten the forces hardly extend beyond the edge. The theory of
:mod:`viscotack.simulate.crack_contact.by_crack` takes a tenth of a second, and some seconds for a
new solid. This surrogate approximates it for spheres on power laws by retardation, retracted from
relaxed starts. It predicts the position of the force between its slowest and its fastest limit,

.. math:: \log \hat P = (1 - s) \log f(\mu) + s \log \frac{f(\mu k^{1/3})}{k} ,

the energy of the crack at pull-off, and its travel in zone lengths, which determine the band of the
theory. It does not apply where the theory does not.

Further inputs of the networks are the energy of a crack whose zone creeps during the time to cross
it, :math:`\Gamma_s = 1/c(l \Gamma_s/(\mu r))`, with the creep c of the solid relative to the
relaxed one and the rate r, and the creep of the bulk during that time. With these two, fewer
training solids are sufficient.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.theory import jkr, lennard_jones

from . import physics
from .contact import Contact, Further
from .trust import Answers

# Tabor number, modulus ratio and exponent; the start's depth over the Tabor number, in heights of a
# contact beta^2/R; and the rate over it, in these heights per time of the material.
LOW, HIGH = np.array([10.0, 1e-4, 0.15, 0.1, 1e-6]), np.array([1e6, 0.5, 2.0, 1000.0, 1e6])
_ENDS = np.log10(LOW), np.log10(HIGH)
# Values of Gamma - 1 below this have no effect.
LEAST = 1e-3
# The theory holds from an effective Tabor number of 2 and 1.5 zones; margin for the error of the
# networks.
_LEAST_TABOR, _LEAST_ZONES, _SLOW = 2.2, 1.8, 1.1
# Parameters of JKR whose units are R dg for forces, beta for radii and beta^2/R for depths; these
# over the units of forces and radii here.
_UNIT, _LOAD, _ROOT = ("radius", "contact_modulus", "work_of_adhesion"), 1.5 * np.pi, np.cbrt(np.pi)
# Largest standard deviation of log10 of the work between its networks.
_AGREED = 0.01
# Best length of a zone in crossing times, number of bisections of its energy's logarithm, and the
# decades of the largest energy.
_ZONE, _HALVINGS, _DECADES = 0.3, 25, 4.0


def creep_of(groups: Array) -> Callable[[Array], Array]:
    """Return the creep over the relaxed one as a function of time [tau0], shape (n,).

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
        # no creep at time zero, where K is infinite
        return 1 - glassy * np.where(np.isfinite(left), np.minimum(left, 1.0), 1.0)

    return creep


def crack_alone(groups: Array) -> Array:
    """Return ln of the energy of a crack whose zone creeps while crossing it, shape (n,)."""
    creep, speed = creep_of(groups), groups[:, physics.TABOR] * groups[:, physics.RATE]
    low = np.zeros(len(groups))
    high = -np.log(groups[:, physics.MODULUS_RATIO])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = middle < -np.log(creep(_ZONE * np.exp(middle) / speed))
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return low


class ShortRangeContact(Contact):
    """A sphere of large Tabor number on a power law, by the theory of a crack at its edge.

    Further outputs, in :attr:`.trust.Answers.more`, are ``amplification``, the energy of the
    crack at pull-off over the work of adhesion; ``zones``, the travel of the edge to the pull-off
    in zones of the crack; and ``effective``, the effective Tabor number of the zone. The constant
    ``error`` is the difference between networks and theory, of each quantity in ``trust.OF``, in 9
    and in 98 of 100 cases of solids that are not in the training data: of a curve over the
    pull-off force, the others relative.
    """

    name, inputs, low, high, ends = "short range", physics.INPUTS, LOW, HIGH, _ENDS
    start_inputs = physics.START
    smooth = False

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

    @cached_property
    def start(self) -> tuple[Array, Array]:
        """Force and contact radius of the relaxed starts by JKR, shape (n,) each."""
        mu, unit = self.rows[:, physics.TABOR], dict.fromkeys(_UNIT, 1.0)
        depth = self.rows[:, physics.PRELOAD] / mu
        radius = np.asarray(jkr.contact_radius_at_depth(depth, **unit))
        force = np.asarray(jkr.force(radius, **unit)) / _LOAD
        tension = np.where(force < 0, lennard_jones.pull_off_ratio(mu), 1.0)
        return tension * force, radius / _ROOT

    def knowing(self, force: Array) -> Array:
        """Return the inputs of networks that depend on start and force, shape (n, 14)."""
        return physics.with_start(self.told, *self.start, force)

    def further(self, output: Array) -> Further:
        """Return the unit of work over force, and energy and zones at pull-off."""
        state = 10 ** self.networks["state"](self.told)[0]
        most = 1 / self.rows[:, physics.MODULUS_RATIO] - 1
        energy = np.clip(state[:, 0] - LEAST, 0.0, most) + 1
        effective = self.rows[:, physics.TABOR] * energy ** (-1 / 3)
        more = {"amplification": energy, "zones": state[:, 1], "effective": effective}
        # the networks predict work over force in heights of a contact
        return Further(work=np.log10(self.rows[:, physics.TABOR]), more=more)

    def give(self, said: Array) -> Array:
        """Return (travel to zero force) * radius / force, from the output of its networks."""
        return self.rows[:, physics.TABOR] * super().give(said)

    def agree(self, said: Answers) -> npt.NDArray[np.bool_]:
        """Return a mask of the works that both networks predict alike, shape (n,).

        They differ where the force has two maxima of about the same height.
        """
        return said.work_spread < _AGREED

    def holds(self, said: Answers) -> npt.NDArray[np.bool_]:
        """Return a mask of the tests to which the theory applies, as predicted, shape (n,)."""
        steady = (said.more["zones"] >= _LEAST_ZONES) | (said.more["amplification"] <= _SLOW)
        return steady & (said.more["effective"] >= _LEAST_TABOR)
