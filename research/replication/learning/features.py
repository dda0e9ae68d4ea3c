r"""What is learned from, and what is learned: inputs, analytic descriptor, targets.

Inputs are those of Maghami, PhD thesis (2025), appendix VII: log10 of preload, rate and modulus
ratio, the Tabor number and the exponent as they are. The descriptor is what the thesis calls XPB:
the crack of Persson and Brener at the speed that Eq. 4.24 gives to the rate. Published as
doi:10.1016/j.jmps.2024.105844 (the descriptor).
"""

from enum import StrEnum

import numpy as np

from research.cases import reduced
from viscotack.theory import persson_brener, rate

from ..table import Array, Detachments


class Target(StrEnum):
    """What is learned, as its log10."""

    FORCE = "force"
    WORK = "work"


def inputs(rows: Detachments) -> Array:
    """Return the five inputs, shape (n, 5)."""
    logs = (np.log10(x) for x in (rows.preload, rows.rate, rows.modulus_ratio))
    preload, speed, ratio = logs
    return np.stack([preload, rows.tabor, speed, ratio, rows.exponent], axis=1)


def crack_amplification(rows: Detachments) -> Array:
    r"""Return effective over intrinsic surface energy at the speed that the rate is given.

    :math:`\hat v = 2.887 \, (\hat r_u / (\mu \pi^{2/3}))^{1.171}` with :math:`\mu` = 3.24 in every
    row, as the authors computed it.

    Examples
    --------
    >>> one = np.ones(1)
    >>> rows = Detachments(
    ...     tabor=one, modulus_ratio=0.1 * one, exponent=0.6 * one, preload=10 * one,
    ...     rate=100 * one, pull_off_force=one, work_to_pull_off=one, work_known=one > 0,
    ... )
    >>> print(f"{crack_amplification(rows)[0]:.3f}")
    4.547
    """
    # The law is used as the authors use it, far from the only Tabor number that it was fitted to.
    v = np.asarray(rate.crack_speed(rate.rate_as_published(rows.rate), tabor=rate.FITTED_TABOR))
    found = np.empty(len(rows))
    solids = np.stack([rows.modulus_ratio, rows.exponent], axis=1)
    for k, n in np.unique(solids, axis=0):
        of_solid = np.all(solids == (k, n), axis=1)
        found[of_solid] = persson_brener.amplification(v[of_solid], material=reduced(k, n))
    return found


def features(rows: Detachments, *, descriptor: bool) -> Array:
    """Return inputs, with the descriptor as it is (not its logarithm) as a last column or not."""
    if not descriptor:
        return inputs(rows)
    return np.column_stack([inputs(rows), crack_amplification(rows)])


def target(rows: Detachments, which: Target) -> Array:
    """Return log10 of the pull-off force, or of the work to pull-off."""
    found = rows.pull_off_force if which is Target.FORCE else rows.work_to_pull_off
    return np.log10(found)
