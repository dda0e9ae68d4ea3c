"""Search for the depth at which a relaxed contact has a given force or radius.

Both quantities increase with depth above their minimum, which is the force minimum or the end of
the contact branch, whichever is deeper. Smaller depths have larger values or no contact.
"""

from __future__ import annotations

from collections.abc import Callable

from numpy import inf
from scipy.optimize import brentq

from viscotack.errors import InputError
from viscotack.simulate.equilibrium import ClosedGap

# First step away from a guess, and growth factor of the following steps.
_FIRST_STEP, _LONGER = 0.05, 1.6
# Maximum number of steps; together they exceed any possible depth of a contact.
_MOST_STEPS = 40
# Fraction of the longer side of a bracket used in a golden-section step.
_GOLDEN = 0.381966
# A minimum has converged when its neighbours exceed it by less than this, in the unit of the
# excess.
_FLAT = 1e-7
# Substitute for the excess where the surfaces are pressed shut. It is larger than any real value,
# finite, and increases with depth, so that the search returns to smaller depths.
_SHUT = 1e9


def depth_where(
    excess: Callable[[float], float], guess: float, scale: float, tolerance: float, wanted: str
) -> float | None:
    """Return the zero of an excess at a depth above its minimum, None if there is no zero.

    Parameters
    ----------
    excess : callable
        Value at a depth minus the wanted value. It raises `ClosedGap` if the surfaces are pressed
        shut, another `InputError` if there is no contact.
    guess : float
        Initial depth.
    scale, tolerance : float
        Depth scale of the excess, and absolute tolerance of the depth.
    wanted : str
        Description of the wanted quantity, for the error message.

    Raises
    ------
    ValueError
        If the surfaces are pressed shut before the wanted value is reached.
    """
    found: dict[float, float] = {}
    shut: dict[float, ClosedGap] = {}

    def seen(depth: float) -> float:
        if depth not in found:
            try:
                found[depth] = float(excess(depth))
            except ClosedGap as reason:
                shut[depth], found[depth] = reason, _SHUT + depth
            except InputError:
                found[depth] = inf
        return found[depth]

    low = _not_above_zero(seen, found, guess, scale, tolerance)
    if low is None:
        return None
    high, step = low, _FIRST_STEP * scale
    while seen(high) <= 0:
        known = [depth for depth in found if depth > high]
        low, high, step = high, min(known, default=high + step), _LONGER * step
    root: float = brentq(seen, low, high, xtol=tolerance, maxiter=100)  # type: ignore[assignment]
    for deeper, reason in shut.items():
        if deeper - root < 2 * tolerance:  # the search ran into it
            raise InputError(f"{wanted} is not reached: {reason}") from reason
    return root


def _not_above_zero(
    seen: Callable[[float], float],
    found: dict[float, float],
    guess: float,
    scale: float,
    tolerance: float,
) -> float | None:
    """Return a depth with an excess of zero or less, None if its minimum is positive."""
    at = guess
    for way in (-1, 1):  # second pass deeper: the guess may lie below the minimum or out of contact
        step = way * _FIRST_STEP * scale
        for _ in range(_MOST_STEPS):
            apart = way > 0 and seen(at) == inf
            if seen(at) <= 0 or not (seen(at + step) < seen(at) or apart):
                break
            at, step = at + step, _LONGER * step
    while seen(at) > 0:
        below = max(depth for depth in found if depth < at)
        above = min(depth for depth in found if depth > at)
        flat = max(seen(below), seen(above)) - seen(at) < _FLAT
        if flat or above - below < tolerance:
            return None
        longer = max(above - at, below - at, key=abs)
        other = at + _GOLDEN * longer
        at = other if seen(other) < seen(at) else at
    return at
