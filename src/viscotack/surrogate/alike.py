r"""The power law that a solid is like around the times of a test.

A retraction at the speed v feels the creep of its solid around h0/v, some decades to both sides.
There any solid is like one of the retardation power laws that simulations are known of,

.. math:: c(t) = k + (1 - k) F_n(t/\tau_0) ,

with its own modulus ratio k and an exponent and a time that make the logarithms of the two creeps
agree best. Creep is sampled at fifteen fixed multiples of h0/v, so that no rate and no temperature
is an input: a solid that is slower, pulled slower, has the same samples. How much each of them
counts is a window that is sought first around a time somewhat above h0/v, and then where
:mod:`viscotack.surrogate.solids` has learned that it matters. A power law is like itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from viscotack.materials import spectrum

from . import physics

Array = npt.NDArray[np.float64]

# Where creep is sampled: times over h0/v, two a decade.
DECADES = np.arange(-3.5, 3.6, 0.5)
TIMES = 10.0**DECADES
# How much each of the samples counts in the likeness: those around 10^_CENTRE most.
_CENTRE, _WIDTH, _LEAST = 0.25, 0.6, 0.005
_COUNTS = np.exp(-((DECADES - _CENTRE) ** 2) / (2 * _WIDTH**2)) + _LEAST
# Logarithms of exponents and of times at which the creep of power laws is tabulated; on steps of
# the times the samples fall again.
_LN_N = np.linspace(np.log(0.1), np.log(3.0), 40)
_STEP, _FIRST, _LAST = 0.1, -36.0, 8.0
_LOG_T = _FIRST + _STEP * np.arange(round((_LAST - _FIRST) / _STEP) + 1)
# All has crept by then, and the formula has no digits left.
_CREPT = 5.9
_APART = np.rint((DECADES - DECADES[0]) / _STEP).astype(int)
# Where the search begins, how many steps it takes, and the longest and the shortest.
_EXPONENTS, _RATES = np.geomspace(0.15, 2.0, 10), np.arange(-2.0, 10.1, 0.5)
_STEPS, _LONGEST, _ENOUGH = 12, np.array([1.0, 0.5, 1.0]), 1e-6
# What is sought: modulus ratio, exponent and rate.
_SOUGHT = (physics.MODULUS_RATIO, physics.EXPONENT, physics.RATE)
_STIFFEST = np.log(physics.LIMITS["modulus_ratio"][1])
# Where creep is as good as over, or has not begun, it tells no exponent; then it is this one. And
# where it does not tell how stiff the glass is, the modulus ratio is that of the solid.
_USUAL, _DOUBTS = np.log(0.6), np.array([1e-5, 1e-6, 1e-9])
_ROWS = 2000


@dataclass(frozen=True, eq=False)
class Alike:
    """Power laws that creep like solids around the times of their tests.

    Attributes
    ----------
    groups : ndarray, shape (n, 5)
        Of the tests on these power laws, in the order of ``physics.INPUTS``.
    over : ndarray, shape (n, 15)
        What is left over at ``TIMES``: logarithm of the power law's creep less that of the solid's,
        over that of the modulus ratio.
    counts : ndarray, shape (n, 15) or (15,)
        How much each of the samples counted.
    """

    groups: Array
    over: Array
    counts: Array

    @property
    def unlike(self) -> Array:
        """How unlike the solids are: root mean square of what is left over, shape (n,)."""
        return np.sqrt(_weighed(self.counts, self.over**2) / self.counts.sum(axis=-1))


@cache
def _table() -> Array:
    """Return the logarithm of the part of the creep of power laws that is over; made once."""
    times = 10.0 ** np.minimum(_LOG_T, _CREPT)
    return np.log([spectrum.crept(np.exp(ln_n), times) for ln_n in _LN_N])


def alike(tabor: Array, modulus_ratio: Array, preload: Array, creep: Array) -> Alike:
    """Return the power laws that solids are like.

    Parameters
    ----------
    tabor, modulus_ratio, preload : ndarray, shape (n,)
        Of the tests.
    creep : ndarray, shape (n, 15)
        Creep over the relaxed one, at ``TIMES`` in units of h0 over the speed.

    Examples
    --------
    A standard solid, whose creep is over within one decade, is steeper than any power law:

    >>> one = np.ones(1)
    >>> found = alike(one, 0.1 * one, 10 * one, 1 - 0.9 * np.exp(-TIMES / 30)[None])
    >>> f"{found.groups[0, 2]:.1f}, {found.unlike[0]:.3f}"
    '2.0, 0.016'
    """
    share = np.log(creep) / np.log(modulus_ratio)[:, None]
    starts = range(0, len(creep), _ROWS)
    parts = [_begun(modulus_ratio[i : i + _ROWS], share[i : i + _ROWS]) for i in starts]
    begun = np.concatenate(parts)
    k, n, rate = np.exp(begun[:, 0]), np.exp(begun[:, 1]), 10 ** begun[:, 2]
    groups = np.column_stack([tabor, k, n, preload, rate])
    plain = Alike(groups, np.zeros_like(creep), _COUNTS)
    return again(plain, modulus_ratio, creep, np.broadcast_to(_COUNTS, creep.shape))


def again(first: Alike, modulus_ratio: Array, creep: Array, counts: Array) -> Alike:
    """Return the power laws that solids are like where other samples count.

    Parameters
    ----------
    first : Alike
        From which they are sought.
    modulus_ratio : ndarray, shape (n,)
        Of the solids.
    creep : ndarray, shape (n, 15)
        As :func:`alike` takes it.
    counts : ndarray, shape (n, 15)
        How much each sample counts.
    """
    groups = first.groups.copy()
    over = np.empty_like(creep)
    for i in range(0, len(creep), _ROWS):
        some = slice(i, i + _ROWS)
        k, n, rate = groups[some][:, _SOUGHT].T
        begun = np.column_stack([np.log(k), np.log(n), np.log10(rate)])
        whole = np.log(modulus_ratio[some])[:, None]
        x, over[some] = _sought(whole, np.log(creep[some]) / whole, begun, counts[some])
        groups[some, _SOUGHT[0]], groups[some, _SOUGHT[1]] = np.exp(x[:, 0]), np.exp(x[:, 1])
        groups[some, _SOUGHT[2]] = 10 ** x[:, 2]
    return Alike(groups, over, counts)


def _sought(whole: Array, share: Array, begun: Array, counts: Array) -> tuple[Array, Array]:
    """Return ln k, ln n and log10 of the rate of power laws, shape (n, 3), and what is left over.

    Levenberg and Marquardt's steps; a number at its end stays there, and the others follow.

    Parameters
    ----------
    whole : ndarray, shape (n, 1)
        ln k of the solids.
    share : ndarray, shape (n, 15)
        Of the way from rubber to glass, in the logarithm.
    begun : ndarray, shape (n, 3)
    counts : ndarray, shape (n, 15)
    """
    ends = [np.log(physics.LIMITS["exponent"]), np.log10(physics.LIMITS["rate"])]
    low = np.column_stack([whole[:, 0], *(np.full(len(share), end[0]) for end in ends)])
    high = np.array([_STIFFEST, *(end[1] for end in ends)])
    usual = np.column_stack([whole[:, 0], np.full((len(share), 1), _USUAL), begun[:, 2]])

    def left(x: Array) -> tuple[Array, Array]:
        """Return what is left over, and its derivatives, shape (n, 15, 3)."""
        k = np.exp(x[:, :1])
        log_f, by_n, by_rate = _crept(x[:, 1], x[:, 2])
        part = np.exp(log_f)
        c = k + (1 - k) * part
        steep = (1 - k) * part / (c * whole)
        slopes = (k * (1 - part) / (c * whole), steep * by_n, steep * by_rate)
        return np.log(c) / whole - share, np.stack(slopes, axis=-1)

    def cost(over: Array, x: Array) -> Array:
        return _weighed(counts, over**2) + _weighed(_DOUBTS, (x - usual) ** 2)

    x = np.clip(begun, low, high)
    over, slopes = left(x)
    best, damping = cost(over, x), np.full(len(x), 1e-3)
    one = np.eye(3)
    for _ in range(_STEPS):
        bent = np.einsum("nm,nmi,nmj->nij", counts, slopes, slopes) + one * _DOUBTS
        bent = bent + one * (damping[:, None] * np.einsum("nii->ni", bent))[:, None]
        fall = -np.einsum("nm,nmi,nm->ni", counts, slopes, over) - _DOUBTS * (x - usual)
        step = np.linalg.solve(bent, fall[..., None])[..., 0]
        new = np.clip(x + np.clip(step, -_LONGEST, _LONGEST), low, high)
        held = (new == low) | (new == high)
        if held.any():
            away = np.where(held, new - x, 0.0)
            fall = np.where(held, away, fall - np.einsum("nij,nj->ni", bent, away))
            both = held[:, :, None] | held[:, None]
            step = np.linalg.solve(np.where(both, one, bent), fall[..., None])[..., 0]
            new = np.clip(x + np.clip(step, -_LONGEST, _LONGEST), low, high)
        found, found_slopes = left(new)
        new_cost = cost(found, new)
        better = new_cost <= best
        moved = np.abs(new - x).max()
        x, over = np.where(better[:, None], new, x), np.where(better[:, None], found, over)
        slopes = np.where(better[:, None, None], found_slopes, slopes)
        best = np.where(better, new_cost, best)
        damping = np.where(better, damping * 0.2, damping * 5)
        if moved < _ENOUGH:
            break
    return x, over


def _begun(k: Array, share: Array) -> Array:
    """Return the best of some power laws of the same modulus ratio, as `_sought` takes them."""
    ln_n, rate, part = _beginnings()
    best = np.empty(len(k), dtype=int)
    for i, ratio in enumerate(k):
        over = np.log(ratio + (1 - ratio) * part) / np.log(ratio) - share[i]
        best[i] = np.argmin(_weighed(_COUNTS, over**2) + _DOUBTS[1] * (ln_n - _USUAL) ** 2)
    return np.column_stack([np.log(k), ln_n[best], rate[best]])


@cache
def _beginnings() -> tuple[Array, Array, Array]:
    """Return logarithms of exponents and rates, and what has crept at the samples."""
    ln_n, rate = (x.ravel() for x in np.meshgrid(np.log(_EXPONENTS), _RATES, indexing="ij"))
    return ln_n, rate, np.exp(_crept(ln_n, rate)[0])


def _weighed(counts: Array, values: Array) -> Array:
    return np.sum(counts * values, axis=-1)


def _crept(ln_n: Array, rate: Array) -> tuple[Array, Array, Array]:
    """Return the logarithm of what has crept at the samples, and its derivatives; (n, 15) each.

    Cubics through four neighbours in the table, along both of its sides.
    """
    at = (ln_n - _LN_N[0]) / (_LN_N[1] - _LN_N[0])
    i = np.clip(at.astype(int), 1, len(_LN_N) - 3)
    along, slope = _cubic(at - i)
    at = (DECADES[0] - rate - _FIRST) / _STEP
    j = np.floor(at).astype(int)
    across, bend = _cubic(at - j)
    near = np.arange(-1, 3)
    columns = j[:, None, None] + _APART[:, None] + near
    some = _table()[(i[:, None] + near)[:, :, None, None], columns[:, None]]
    of_n = np.einsum("nimx,nx->nmi", some, across)
    by_n = np.einsum("nmi,ni->nm", of_n, slope) / (_LN_N[1] - _LN_N[0])
    by_rate = -np.einsum("nimx,nx,ni->nm", some, bend, along) / _STEP
    return np.einsum("nmi,ni->nm", of_n, along), by_n, by_rate


def _cubic(f: Array) -> tuple[Array, Array]:
    """Return weights of the neighbours at -1, 0, 1 and 2 of a place f, and their derivatives."""
    values = (
        -f * (f - 1) * (f - 2) / 6,
        (f + 1) * (f - 1) * (f - 2) / 2,
        -(f + 1) * f * (f - 2) / 2,
        (f + 1) * f * (f - 1) / 6,
    )
    slopes = (
        -(3 * f**2 - 6 * f + 2) / 6,
        (3 * f**2 - 4 * f - 1) / 2,
        -(3 * f**2 - 2 * f - 2) / 2,
        (3 * f**2 - 1) / 6,
    )
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)
