"""Time to detachment of a contact under a dead load."""

import numpy as np

from viscotack.errors import InputError

from . import Outcome, Result
from .parts import move_numbers, moves_of, waits

# For results without recorded moves: the hold begins where the force is within this fraction of the
# held force, relative to the held force and the unit of force.
_HELD = 1e-3


def time_to_detachment(result: Result) -> float:
    """Return the time from the start of a hold at constant force to detachment.

    Parameters
    ----------
    result : Result
        Test that ends with a ``Dwell(duration, hold="force")`` as its last move.

    Returns
    -------
    float
        Time to the jump out of contact: in seconds for a problem in SI, in the time unit for
        groups.

    Raises
    ------
    ValueError
        If the test ends otherwise, or the contact detached before the hold, or not at all.

    Notes
    -----
    A load below the elastic pull-off force is held for ever; one above the glassy pull-off force
    not at all. Between them the edge is a slow crack, and the time depends strongly on the load.

    Examples
    --------
    >>> from viscotack import AtForce, Groups, StandardSolid, solve
    >>> from viscotack.model.protocol import Dwell, LoadTo
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> hang = (LoadTo(force=-1.5, duration=1e-3), Dwell(duration=1e4, hold="force"))
    >>> groups = Groups(
    ...     tabor=2.0, material=solid.reduced(), start=AtForce(0.0), rate=None, moves=hang
    ... )
    >>> f"{time_to_detachment(solve(groups, estimate_error=False)):.1f} tau0"
    '11.6 tau0'
    """
    scales = result.scales
    return time_held(result) * (1.0 if scales is None else scales.time)


def time_held(result: Result) -> float:
    """Return the dimensionless time, in the time unit of the groups."""
    moves, number = moves_of(result), move_numbers(result)
    last, gone = int(number[-1]), result.outcome in (Outcome.JUMPED, Outcome.DETACHED)
    if not waits(moves[last], "force"):
        if gone and any(waits(move, "force") for move in moves[last:]):
            raise InputError(
                "the contact detached before the hold; reduce the force, or load more slowly"
            )
        raise InputError(
            "the test must end with a dwell at constant force: Dwell(duration, hold='force') as "
            "the last move, and no speed"
        )
    if not gone:
        raise InputError(
            f"the contact did not detach, and the run ended: {result.status}; dwell longer, or "
            "increase the tension above the elastic pull-off force"
        )
    if result.move is None:
        held = float(result.force[-1])
        before = np.flatnonzero(np.abs(result.force - held) > _HELD * (abs(held) + 1))
        begin = int(before[-1]) + 1 if before.size else 0
    else:
        begin = max(int(np.searchsorted(number, last)) - 1, 0)
    return float(result.time[-1] - result.time[begin])
