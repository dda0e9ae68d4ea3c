"""Vectorised predictions of a surrogate and their intervals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from viscotack.arrays import Array


@dataclass(frozen=True, eq=False)
class Answers:
    """Predicted numbers, dimensionless; arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0], positive.
    work_to_pull_off : ndarray
        [1.5 pi R dg0 h0], from zero force or from a start in tension; nan if not predicted.
    force_spread, work_spread : ndarray
        Standard deviation of log10 between the networks.
    way, share : ndarray
        log10 of the fast over the slow limit of the force, and the fraction of it that is reached.
    more : mapping of str to ndarray
        Further outputs of the contact (:meth:`.contact.Contact.further`).
    factor : ndarray, or None
        By which measured forces moved force and work (:mod:`.moving`); None without these.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    force_spread: Array
    work_spread: Array
    way: Array
    share: Array
    more: Mapping[str, Array] = field(default_factory=dict)
    factor: Array | None = None

    def times(self, factor: Array) -> Answers:
        """Return the predictions moved by a factor."""
        force, work = self.pull_off_force * factor, self.work_to_pull_off * factor
        return replace(self, pull_off_force=force, work_to_pull_off=work, factor=factor)

    @property
    def learned(self) -> Answers:
        """The predictions as the networks learned them."""
        return self if self.factor is None else replace(self.times(1 / self.factor), factor=None)


@dataclass(frozen=True, eq=False)
class Intervals:
    """Intervals of the simulated numbers.

    Attributes
    ----------
    pull_off_force, work_to_pull_off : ndarray, shape (n, 2)
        As in :class:`Answers`.
    curve : ndarray, shape (n,)
        Largest error of tensile forces over the pull-off force, at the same travel from
        zero force or from a start in tension.
    travel : ndarray, shape (n, 2)
        Travel from a compressed start to zero force, relative to that of the curve.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    curve: Array
    travel: Array
