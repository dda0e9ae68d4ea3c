"""Key points and trajectory of a retraction from its start to the pull-off, for rows of tables.

**Sampling of a trajectory: 24 points from the start of a retraction to the pull-off.** From a deep
start, the travel to zero force is long and the travel in tension short, so each part has its own
points: the last 16 lie between zero force and pull-off. A start in tension has only the second
part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array

if TYPE_CHECKING:
    from .observables import PullOff
    from .result import Result

POINTS, TENSILE = 24, 16
PRESSED = POINTS - TENSILE


def gathered(count: int) -> npt.NDArray[np.float64]:
    """Return fractions of a travel from 0 to 1, denser at its end.

    Examples
    --------
    >>> gathered(3).tolist()
    [0.0, 0.75, 1.0]
    """
    return 1 - (1 - np.linspace(0.0, 1.0, count)) ** 2


def shares(zero: float) -> npt.NDArray[np.float64]:
    """Return the fractions of the travel to the pull-off at which a trajectory is sampled, (24,).

    Parameters
    ----------
    zero : float
        Fraction at which the force is zero for the last time; 0 for a start in tension.

    Returns
    -------
    ndarray
        Eight points from the start to zero force and sixteen from there to the pull-off, or all 24
        in tension; denser at the end of each part, :math:`1 - (1 - i/n)^2` of it.

    Examples
    --------
    >>> shares(0.9)[[0, 7, 8, 9, 23]].round(4).tolist()
    [0.0, 0.8859, 0.9, 0.9129, 1.0]
    """
    if zero <= 0:
        return gathered(POINTS)
    pressing = gathered(PRESSED + 1)[:-1]
    return np.append(zero * pressing, zero + (1 - zero) * gathered(TENSILE))


# Shares of the travel from the start to the pull-off at which the force is a key point.
KEY_SHARES = {"25": 0.25, "50": 0.5, "75": 0.75, "87_5": 0.875}


def curve(result: Result, found: PullOff) -> dict[str, Any]:
    """Return key points and trajectory of the retraction from its start to the pull-off.

    Returns
    -------
    dict
        ``travel_to_pull_off`` [h0]; ``force_at_25``, ... at 25, 50, 75 and 87.5 % of that travel;
        ``trajectory_depth``, ``trajectory_force`` and ``trajectory_contact_radius`` at the places
        of :func:`shares`. Names, units and signs are those of the
        columns of the geometry: of a punch ``stress``, tension positive, and ``ligament``. Forces
        follow a monotone cubic between the steps of the run, radii a straight line; None without an
        edge. A problem in SI has each in SI as well, ``trajectory_force_N``.
    """
    depths, steps, edge = retraction(result)
    start = float(depths[0])
    travel = start - found.depth
    # a retraction that begins at its force minimum has no travel, and its curve is one point
    x, whole = (start - depths) / (travel or 1.0), float(travel > 0)
    force = scipy.interpolate.PchipInterpolator(x, steps)
    outputs, groups = result.problem.outputs, result.groups
    pull, width = outputs.of("force"), outputs.of("contact_radius")
    sign, scale = pull.factor(groups), width.factor(groups)
    load, edge_name = outputs.name_of("force"), outputs.name_of("contact_radius")
    row: dict[str, Any] = {"travel_to_pull_off": travel}
    row |= {
        f"{load}_at_{name}": sign * float(force(whole * share))
        for name, share in KEY_SHARES.items()
    }
    pressing = np.flatnonzero((steps > 0) & (x < 1))
    zero = 0.0
    if pressing.size:  # between its last positive step and the next one
        last = pressing[-1]
        zero = cast(float, scipy.optimize.brentq(force, x[last], x[last + 1], xtol=1e-14))
    places = shares(zero)
    forces = force(whole * places)
    # The force minimum is located between steps; the last point is that very number.
    forces[-1] = -found.force
    row["trajectory_depth"] = (start - places * travel).tolist()
    row[f"trajectory_{load}"] = (sign * forces).tolist()
    radii = np.interp(whole * places, x, edge)
    radii[-1] = found.contact_radius
    radii = scale * radii
    row[f"trajectory_{edge_name}"] = [a if np.isfinite(a) else None for a in radii.tolist()]
    return row | _in_si(row, result)


def _in_si(row: dict[str, Any], result: Result) -> dict[str, Any]:
    """Return the columns of a curve in SI, by their names with the unit; none without scales."""
    outputs, scales = result.problem.outputs, result.scales
    if scales is None:
        return {}
    found: dict[str, Any] = {}
    for name, value in row.items():
        word = name.removeprefix("trajectory_").partition("_at_")[0]
        unit = outputs.series["depth" if word == "travel_to_pull_off" else word].unit
        factor = getattr(scales, unit.scale)
        many = isinstance(value, list)
        scaled = [None if x is None else x * factor for x in (value if many else [value])]
        found[f"{name}_{unit.tail}"] = scaled if many else scaled[0]
    return found


def retraction(result: Result) -> tuple[Array, Array, Array]:
    """Return depth [h0], force and contact radius at the steps of the last opening of a run.

    From its deepest step on; the depth falls from step to step. Where the curve jumps it stands
    still, and the state after the jump is kept. Force and radius are dimensionless as in `Result`.
    """
    from .parts import spans

    turn = spans(result)[-1].turn
    depth = result.depth[turn:]
    first = int(np.flatnonzero(depth == depth.max())[-1])
    later = np.maximum.accumulate(depth[::-1])[::-1]
    falls = np.append(depth[:-1] > later[1:], True)
    moved = turn + first + np.flatnonzero(falls[first:])
    return result.depth[moved], result.force[moved], result.contact_radius[moved]
