"""The learned answer to a detachment: force, work and curve, and how sure they are.

Evaluated with NumPy alone. What is learned and what is not: :mod:`viscotack.surrogate.physics`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from viscotack.errors import InputError

from . import physics
from .answers import Answers, Intervals, answered
from .line import Curves, curves
from .network import Networks, from_arrays
from .physics import LIMITS, START, Array
from .slopes import Sloped, by_logarithms
from .trust import Trust, error_inputs

Bent = Callable[[Array], tuple[Array, Array]]
_STARTS = 64
_REFINEMENTS = 4


@dataclass(frozen=True, eq=False)
class Scaled:
    """Networks whose outputs are numbers of order one, and what they stand for."""

    networks: Networks
    centre: Array
    spread: Array

    def __call__(self, inputs: Array) -> Array:
        """Return outputs in their own units, shape (m, n, outputs)."""
        return self.centre + self.spread * self.networks(inputs)

    def arrays(self, before: str = "") -> dict[str, Array]:
        """Return all arrays by names for a file, with something before each name."""
        scale = {f"{before}centre": self.centre, f"{before}spread": self.spread}
        return scale | self.networks.arrays(before)

    @classmethod
    def of(cls, arrays: Mapping[str, Array], before: str) -> "Scaled":
        """Return what :meth:`arrays` was given for."""
        networks = from_arrays(arrays, before)
        return cls(networks, arrays[f"{before}centre"], arrays[f"{before}spread"])


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A sphere on a power law by retardation, pulled from a relaxed start at a constant rate.

    Inputs are rows of the five groups in the order of ``INPUTS``: Tabor number, modulus ratio,
    exponent, preload [h0] and rate [h0/tau0].

    Attributes
    ----------
    start, fast : Scaled, Networks
        Of the relaxed start: force and log10 of the radius; of the fast limit. One each, or as many
        as there are for the force, each of which then has a limit of its own.
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
        said = self.start(physics.scaled(groups)[:, START]).mean(axis=0)
        return physics.start_force(groups, said[:, 0]), 10 ** said[:, 1]

    def evaluate(self, groups: npt.ArrayLike, bent: Bent | None = None) -> Answers:
        """Return force and work of rows of groups; they are not checked to lie inside.

        Parameters
        ----------
        groups : array_like, shape (n, 5)
        bent : callable, optional
            Takes what the networks of the force say, shape (m, n), and returns what is added to
            that, and to log10 of work over force, shape (n,) each.
        """
        rows = _rows(groups)
        slow, fast = physics.way(rows, self.fast)
        output = self.force(physics.scaled(rows))[..., 0]
        further: Any = None
        if bent is not None:
            more, further = bent(output)
            output = output + more
        forces = physics.between(slow, fast, output)
        force = forces.mean(axis=0)
        works = force + self.work(self._told(rows, force))[..., 0]
        if further is not None:
            works = works + further
        return answered(forces, works, slow, fast.mean(axis=0))

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
        inputs = error_inputs(physics.scaled(_rows(groups)), answers)
        return self.trust.intervals(inputs, answers, confidence)

    def slopes(self, groups: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the derivatives of log force and log work by the logarithms of the inputs, exact.

        Parameters
        ----------
        groups : array_like, shape (n, 5)
            Rows, not checked to lie inside.

        Returns
        -------
        force, work : ndarray, shape (n, 5)
            Part by which the answer changes for a part by which an input does; the derivative by
            the input itself is this times answer over input.

        Examples
        --------
        >>> from viscotack.surrogate.store import shipped
        >>> force, _ = shipped().slopes([[3.24, 0.1, 0.8, 73.0, 316.23]])
        >>> bool(0 < force[0, 4] < 0.5)
        True
        """
        inputs: Any = by_logarithms(_rows(groups))
        said = self.evaluate(inputs)
        numbers = said.pull_off_force, said.work_to_pull_off
        force, work = (
            np.column_stack([s / x.value for s in x.slopes])
            for x in numbers
            if isinstance(x, Sloped)
        )
        return force, work

    def start_depth(
        self, tabor: float, *, force: float | None = None, contact_radius: float | None = None
    ) -> float:
        """Return the depth [h0] of the relaxed start with a force or a contact radius.

        Of contacts with the Lennard-Jones law and its range, as they were simulated; for forces of
        short range see :func:`viscotack.theory.elastic.relaxed.contact`.

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

    def start_doubt(self, groups: Array, *, by: str) -> Array:
        """Return standard deviations of log10 of depths of starts that were told otherwise, (n,).

        Parameters
        ----------
        groups : ndarray, shape (n, 5)
            With the depths that were found.
        by : {"force", "contact_radius"}
            What was told; how much the networks of the start differ in it tells the doubt.
        """
        which, step = ("force", "contact_radius").index(by), 1e-3

        near = np.tile(groups, (3, 1))
        near[:, physics.PRELOAD] *= np.repeat(10 ** (step * np.arange(-1, 2)), len(groups))
        said = self.start(physics.scaled(near)[:, START])[..., which]
        if not which:
            said = np.array([physics.start_force(near, one) for one in said])
        before, here, after = np.split(said, 3, axis=1)
        rise = np.abs((after - before).mean(axis=0)) / (2 * step)
        # where what was told hardly depends on the depth, it tells no depth
        return np.minimum(here.std(axis=0) / np.maximum(rise, 1e-30), 1.0)

    def with_start_doubt(
        self, groups: Array, answers: Answers, held: Intervals, *, by: str, quantile: float
    ) -> Intervals:
        """Return intervals that hold the doubt of the depths of their starts as well.

        Parameters
        ----------
        groups, answers, held : ndarray, Answers, Intervals
            Rows, what is said of them, and intervals without that doubt.
        by : {"force", "contact_radius"}
            What was told of the start.
        quantile : float
            Standard deviations in half an interval.
        """
        doubt = 10 ** (quantile * self.start_doubt(groups, by=by))
        near = np.tile(groups, (3, 1))
        near[:, physics.PRELOAD] *= np.concatenate([np.ones_like(doubt), doubt, 1 / doubt])
        others = self.evaluate(near)

        def wider(name: str) -> Array:
            value, pair = np.log(getattr(answers, name)), np.log(getattr(held, name))
            here, *there = np.log(getattr(others, name)).reshape(3, -1)
            far = np.array(there) - here
            down, up = -np.minimum(far.min(axis=0), 0.0), np.maximum(far.max(axis=0), 0.0)
            low, high = np.hypot(value - pair[:, 0], down), np.hypot(pair[:, 1] - value, up)
            return np.exp(np.column_stack([value - low, value + high]))

        return replace(
            held,
            pull_off_force=wider("pull_off_force"),
            work_to_pull_off=wider("work_to_pull_off"),
        )

    def _told(self, rows: Array, force: Array) -> Array:
        return physics.with_start(rows, *self.relaxed(rows), force)


def _rows(groups: Any) -> Any:
    # what only stands for an array, as where formulas are exported, stays what it is
    return groups if isinstance(groups, NDArrayOperatorsMixin) else np.asarray(groups, dtype=float)
