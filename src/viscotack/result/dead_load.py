"""How long a contact bears a dead load."""

import numpy as np

from viscotack.errors import InputError
from viscotack.protocol import Dwell

from . import Outcome, Result

# The hold begins where the force is this near to the one held, beside it and the unit of force.
_HELD = 1e-3


def time_to_detachment(result: Result) -> float:
    """Return how long the last move, a dwell at constant force, held until the contact let go.

    Parameters
    ----------
    result : Result
        Of a test whose last move is ``Dwell(duration, hold="force")``, without a retraction.

    Returns
    -------
    float
        Time from the beginning of the hold to the jump out of contact: in seconds for a problem in
        SI, in its time unit for groups.

    Raises
    ------
    ValueError
        If the test ends otherwise, or the contact still bore the load at the end of the dwell.

    Notes
    -----
    A load below the elastic pull-off force is borne for ever; one above the glassy one not at all.
    Between them the edge creeps as a slow crack, and the time depends steeply on the load.

    Examples
    --------
    >>> from viscotack import AtForce, Groups, StandardSolid, solve
    >>> from viscotack.protocol import Dwell, LoadTo
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
    problem = result.groups
    last = problem.moves[-1] if problem.moves else None
    if problem.rate is not None or not isinstance(last, Dwell) or last.hold != "force":
        raise InputError(
            "the test must end with a dwell at constant force: Dwell(duration, hold='force') as "
            "the last move, and no speed"
        )
    if result.outcome not in (Outcome.JUMPED, Outcome.DETACHED):
        raise InputError(
            f"the contact has not let go, the run ended: {result.status}; dwell longer, or pull "
            "harder than the elastic pull-off force"
        )
    held = float(result.force[-1])
    other = np.flatnonzero(np.abs(result.force - held) > _HELD * (abs(held) + 1))
    begin = int(other[-1]) + 1 if other.size else 0
    scales = result.scales
    unit = 1.0 if scales is None else scales.time
    return float(result.time[-1] - result.time[begin]) * unit
