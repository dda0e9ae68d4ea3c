"""The learned answer to a detachment: force, work and curve, and how sure they are.

Evaluated with NumPy alone. What is learned and what is not: :mod:`viscotack.surrogate.physics`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from viscotack.errors import InputError

from . import physics
from .line import Curves, curves
from .network import Networks
from .physics import INPUTS, LIMITS, START, Array
from .trust import Trust

__all__ = ["INPUTS", "Answers", "Curves", "Intervals", "Surrogate"]
_STARTS = 64
_REFINEMENTS = 4


@dataclass(frozen=True, eq=False)
class Answers:
    """Predicted numbers of some rows, dimensionless; arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0], positive.
    work_to_pull_off : ndarray
        [1.5 pi R dg0 h0], from zero force or from a start in tension.
    force_spread, work_spread : ndarray
        Standard deviation of log10 among the networks.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    force_spread: Array
    work_spread: Array


@dataclass(frozen=True, eq=False)
class Intervals:
    """Between what the simulated numbers are; arrays of shape (n, 2)."""

    pull_off_force: Array
    work_to_pull_off: Array


@dataclass(frozen=True, eq=False)
class Scaled:
    """Networks whose outputs are numbers of order one, and what they stand for."""

    networks: Networks
    centre: Array
    spread: Array

    def __call__(self, inputs: Array) -> Array:
        """Return outputs in their own units, shape (m, n, outputs)."""
        return self.centre + self.spread * self.networks(inputs)


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A sphere on a power law by retardation, pulled from a relaxed start at a constant rate.

    Inputs are rows of the five groups in the order of ``INPUTS``: Tabor number, modulus ratio,
    exponent, preload [h0] and rate [h0/tau0].

    Attributes
    ----------
    start, fast : Scaled, Networks
        Of the relaxed start: force and log10 of the radius; of the fast limit.
    force, work, give, line : Networks, Scaled, Scaled, Scaled
        Several for force, work, and log10 of the give of a start; one for the shapes of a curve.
    trust : Trust
        How wide the intervals are.
    """

    start: Scaled
    fast: Networks
    force: Networks
    work: Scaled
    give: Scaled
    line: Scaled
    trust: Trust

    @property
    def limits(self) -> Mapping[str, tuple[float, float]]:
        """Least and largest of each input that was learned from."""
        return LIMITS

    def inside(self, groups: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which inputs lie in the range learned from, shape (n, 5)."""
        rows = _rows(groups)
        # the ends themselves, whichever way they were rounded
        return (rows >= physics.LOW * (1 - 1e-9)) & (rows <= physics.HIGH * (1 + 1e-9))

    def relaxed(self, groups: Array) -> tuple[Array, Array]:
        """Return force [1.5 pi R dg0] and contact radius of the relaxed starts, shape (n,)."""
        said = self.start(physics.scaled(groups)[:, START])[0]
        return physics.start_force(groups, said[:, 0]), 10 ** said[:, 1]

    def evaluate(self, groups: npt.ArrayLike) -> Answers:
        """Return force and work of rows of groups; they are not checked to lie inside."""
        rows = _rows(groups)
        forces = physics.between(
            *physics.way(rows, self.fast), self.force(physics.scaled(rows))[..., 0]
        )
        force = forces.mean(axis=0)
        works = force + self.work(self._told(rows, force))[..., 0]
        return Answers(
            pull_off_force=10**force,
            work_to_pull_off=10 ** works.mean(axis=0),
            force_spread=forces.std(axis=0),
            work_spread=works.std(axis=0),
        )

    def curves(self, groups: npt.ArrayLike, answers: Answers) -> Curves:
        """Return the unloading curves that belong to the answers of the same rows."""
        rows = _rows(groups)
        force, radius = self.relaxed(rows)
        log_force, log_work = np.log10(answers.pull_off_force), np.log10(answers.work_to_pull_off)
        told = physics.with_start(rows, force, radius, log_force, log_work)
        said = self.line(told)[0]
        return curves(
            said,
            give=10 ** self.give(told)[..., 0].mean(axis=0),
            preload=rows[:, physics.PRELOAD],
            force=force,
            radius=radius,
            pull_off=answers.pull_off_force,
            work=answers.work_to_pull_off,
        )

    def intervals(
        self, groups: npt.ArrayLike, answers: Answers, *, confidence: float = 0.9
    ) -> Intervals:
        """Return intervals that held so many of the cases that were kept apart.

        Raises
        ------
        ValueError
            If the confidence is not one of those that were measured.
        """
        rows = _rows(groups)
        spreads = answers.force_spread, answers.work_spread
        factors = self.trust.factors(rows, spreads, confidence)
        values = answers.pull_off_force, answers.work_to_pull_off
        pairs = [np.column_stack([v / f, v * f]) for v, f in zip(values, factors, strict=True)]
        return Intervals(*pairs)

    def start_depth(
        self, tabor: float, *, force: float | None = None, contact_radius: float | None = None
    ) -> float:
        """Return the depth [h0] of the relaxed start with a force or a contact radius.

        Parameters
        ----------
        tabor : float
            Tabor number.
        force : float, optional
            [1.5 pi R dg0], compression positive.
        contact_radius : float, optional
            [(pi R^2 dg0/E0*)^(1/3)]

        Raises
        ------
        ValueError
            If no start in the range learned from has it.
        """
        if (force is None) == (contact_radius is None):
            raise InputError("give either the force or the contact radius of the start")
        which, wanted = (0, force) if force is not None else (1, contact_radius)
        assert wanted is not None
        low, high = LIMITS["preload"]
        first: tuple[float, float] | None = None
        for _ in range(_REFINEMENTS):
            depths = np.geomspace(low, high, _STARTS)
            groups = np.ones((_STARTS, 5))
            groups[:, physics.TABOR], groups[:, physics.PRELOAD] = tabor, depths
            # in tension and at large Tabor numbers it rises by less than the networks err
            found = np.maximum.accumulate(self.relaxed(groups)[which])
            first = first or (float(found[0]), float(found[-1]))
            if not first[0] <= wanted <= first[1]:
                what = "force [1.5 pi R dg0]" if which == 0 else "contact radius"
                raise InputError(
                    f"no relaxed start between depths of {low:g} and {high:g} h0 has a {what} of "
                    f"{wanted:g}; at that Tabor number it is between {first[0]:.4g} and "
                    f"{first[1]:.4g}"
                )
            i = int(np.clip(np.searchsorted(found, wanted), 1, _STARTS - 1))
            low, high = depths[i - 1], depths[i]
        rise = float(found[i] - found[i - 1])
        part = (wanted - float(found[i - 1])) / rise if rise > 0 else 0.5
        return float(low + np.clip(part, 0.0, 1.0) * (high - low))

    def _told(self, rows: Array, force: Array) -> Array:
        return physics.with_start(rows, *self.relaxed(rows), force)


def _rows(groups: Any) -> Any:
    # what only stands for an array, as where formulas are exported, stays what it is
    return groups if isinstance(groups, NDArrayOperatorsMixin) else np.asarray(groups, dtype=float)
