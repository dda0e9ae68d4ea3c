"""Looking for the depth at which a relaxed contact has a wanted force or radius.

Both grow with the depth from the least that there is on: the force minimum, or the end of the
branch in contact, whichever comes first. Depths below it have more than the least, or no contact.
"""

from __future__ import annotations

from collections.abc import Callable

from numpy import inf
from scipy.optimize import brentq

from viscotack.bem.shut import Shut
from viscotack.errors import InputError

# The first step away from a guess, and how much longer each of the next is.
_FIRST_STEP, _LONGER = 0.05, 1.6
# So many steps go farther than any depth that a contact may have.
_MOST_STEPS = 40
# The part of the longer side of a bracket that a step towards the least goes.
_GOLDEN = 0.381966
# A least is known when its neighbours have no more than this, in the unit of the excess.
_FLAT = 1e-7
# What stands for an excess where the surfaces are pressed shut: larger than any, finite, and
# growing with the depth, so that the search finds its way back.
_SHUT = 1e9


def depth_where(
    excess: Callable[[float], float], guess: float, scale: float, tolerance: float, wanted: str
) -> float | None:
    """Return the depth above the least of an excess at which it is zero, None where none is.

    Parameters
    ----------
    excess : callable
        How much more than wanted there is at a depth; `Shut` where the surfaces are pressed shut,
        another `InputError` where there is no contact.
    guess : float
        Where to begin.
    scale, tolerance : float
        The length over which the excess changes as a whole, and that within which depths are found.
    wanted : str
        What is looked for, in words.

    Raises
    ------
    ValueError
        If the surfaces are pressed shut before.
    """
    found: dict[float, float] = {}
    shut: dict[float, Shut] = {}

    def seen(depth: float) -> float:
        if depth not in found:
            try:
                found[depth] = float(excess(depth))
            except Shut as reason:
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
    """Return a depth at which an excess is zero or less, None where its least is more."""
    at = guess
    for way in (-1, 1):  # upwards where the guess is below the least, or out of contact
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
