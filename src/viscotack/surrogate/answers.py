"""What a surrogate answers: numbers of many rows at once, and between what they are."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from viscotack.arrays import Array


@dataclass(frozen=True, eq=False)
class Answers:
    """Predicted numbers of some rows, dimensionless; arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0], positive.
    work_to_pull_off : ndarray
        [1.5 pi R dg0 h0], from zero force or from a start in tension; nan where none was learned.
    force_spread, work_spread : ndarray
        Standard deviation of log10 among the networks.
    way, share : ndarray
        From the slow limit of the force to the fast one, log10, and the part of it that is covered.
    more : mapping of str to ndarray
        What else was learned of the contact (:meth:`.contact.Contact.further`).
    """

    pull_off_force: Array
    work_to_pull_off: Array
    force_spread: Array
    work_spread: Array
    way: Array
    share: Array
    more: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Intervals:
    """Between what the simulated numbers are.

    Attributes
    ----------
    pull_off_force, work_to_pull_off : ndarray, shape (n, 2)
        As in :class:`Answers`.
    curve : ndarray, shape (n,)
        How far forces in tension are off at worst, over the pull-off force, at the same travel from
        zero force or from a start in tension.
    travel : ndarray, shape (n, 2)
        From a pressed start to zero force, over what a curve has.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    curve: Array
    travel: Array
