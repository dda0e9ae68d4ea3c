"""A force table by simulations, at as many speeds as its interpolation needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, log

import numpy as np

from viscotack.arrays import Array
from viscotack.clock import limited
from viscotack.errors import InputError
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.result import Outcome
from viscotack.result.observables import pull_off
from viscotack.simulate import solve
from viscotack.units import readable

from .table import ForceTable

# Parts of the way to the pull-off, from there to half of it, and to the end.
_PARTS = 64, 16, 32
_TO_PEAK = _PARTS[0]
# Speeds that are simulated in any case, per decade, and the most of them in all.
_PER_DECADE, _MOST = 1, 129
# Least length of a later part of the way, over that to the pull-off; a jump has none.
_JUMP = 1e-6


@dataclass(frozen=True, eq=False)
class _Pull:
    """A retraction at one speed: start, travels, forces at the shares, and its error."""

    speed: float
    start: float
    travel: Array
    force: Array
    error: float

    @property
    def peak(self) -> float:
        return -float(self.force[_TO_PEAK])


def force_table(
    problem: Problem,
    slowest: float,
    fastest: float,
    *,
    tolerance: float = 0.01,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> ForceTable:
    """Simulate the retraction of a contact at speeds between two, and return its force table.

    One speed a decade is simulated, and the middle of each two neighbours in the logarithm. Where
    the interpolation between the neighbours misses the middle by more than the tolerance, both
    halves are divided again.

    Parameters
    ----------
    problem : Problem
        An indenter on a rigid machine: the spring of the machine belongs to the controller. Moves
        before the retraction are made; its own speed does not matter.
    slowest, fastest : float
        Speeds of the retraction [m/s], positive.
    tolerance : float
        Largest miss of the interpolation, over the pull-off force: of forces at equal shares of the
        way until half of it is left, and of the travels to both, each over itself.
    accuracy : float
        Of each simulation, as for :func:`viscotack.solve`.
    time_limit : float, optional
        Longest wall time of all simulations [s].
    progress : callable
        Called with the finished fraction, from 0 to 1.

    Returns
    -------
    ForceTable
        The table; `error` is the largest miss, plus the largest error of a simulation.

    Raises
    ------
    ValueError
        If the problem is a punch, has a spring, the speeds are not positive and ascending, a
        simulation fails or has no pull-off after its start, or 129 speeds are not enough.

    Examples
    --------
    >>> from viscotack import AtForce, LennardJones, Problem, Retraction, Sphere, StandardSolid
    >>> pad = Problem(
    ...     material=StandardSolid(
    ...         rubbery_modulus=1.5e6, glassy_modulus=6e6, tau0=0.1, poisson_ratio=0.5
    ...     ),
    ...     traction=LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-6),
    ...     geometry=Sphere(radius=2e-3),
    ...     protocol=Retraction(start=AtForce(force=1e-3), speed=1e-5),
    ... )
    >>> table = force_table(pad, 1e-6, 1e-5, tolerance=0.1, accuracy=0.02)
    >>> bool(np.all(np.diff(table.pull_off_force) > 0))
    True
    """
    _check(problem, slowest, fastest, tolerance)
    whole = log(fastest / slowest)
    done = 0.0
    with limited(time_limit):
        count = max(int(np.ceil(_PER_DECADE * whole / log(10) - 1e-9)), 1) + 1
        found = [_pulled(problem, v, accuracy) for v in np.geomspace(slowest, fastest, count)]
        left, pulls, missed = list(zip(found, found[1:], strict=False))[::-1], found[:1], 0.0
        while left:
            low, high = left.pop()
            middle = _pulled(problem, float(np.sqrt(low.speed * high.speed)), accuracy)
            miss = _miss(low, middle, high)
            if miss <= tolerance:
                pulls += [middle, high]
                missed, done = max(missed, miss), done + log(high.speed / low.speed) / whole
                progress(min(done, 1.0))
                continue
            left += [(middle, high), (low, middle)]
            if len(pulls) + len(left) + 1 > _MOST:
                raise InputError(
                    f"between {readable(low.speed, 'm/s')} and {readable(high.speed, 'm/s')} the "
                    f"force changes too much for a table of {_MOST} speeds: the interpolation "
                    f"misses it by {100 * miss:.2g} %; take a coarser tolerance or fewer decades"
                )
    return ForceTable(
        start_depth=pulls[0].start,
        speed=np.array([x.speed for x in pulls]),
        travel=np.array([x.travel for x in pulls]),
        share=_shares(),
        force=np.array([x.force for x in pulls]),
        error=missed + max(x.error for x in pulls),
        of=f"{problem.geometry} on {problem.material}, {problem.traction}",
    )


def _check(problem: Problem, slowest: float, fastest: float, tolerance: float) -> None:
    """Raise an error for problems that a force table cannot describe."""
    if not isinstance(problem, Problem):
        raise InputError(
            "a force table is in SI and needs a Problem, got "
            f"{type(problem).__name__}; give the contact as a case file"
        )
    if problem.groups().in_plane_strain:
        raise InputError(
            "a force table needs a contact with a force in N; a punch in plane strain has a mean "
            "stress"
        )
    if problem.protocol.stiffness is not None:
        raise InputError(
            "the table is that of the contact alone: leave out the stiffness of the machine, "
            f"{readable(problem.protocol.stiffness, 'N/m')}, and give it to the controller"
        )
    if not 0 < slowest < fastest < inf:
        raise InputError(
            "speeds of a force table must be positive, the slowest first, got "
            f"{readable(slowest, 'm/s')} and {readable(fastest, 'm/s')}"
        )
    if not 0 < tolerance <= 0.2:
        raise InputError(f"the tolerance must be above 0 and at most 0.2, got {tolerance:g}")


def _shares() -> Array:
    parts = (j + np.arange(count) / count for j, count in enumerate(_PARTS))
    return np.concatenate([*parts, [len(_PARTS)]])


def _pulled(problem: Problem, speed: float, accuracy: float) -> _Pull:
    """Simulate the retraction at a speed."""
    test = replace(problem, protocol=replace(problem.protocol, speed=float(speed)))
    found = solve(test, accuracy=accuracy, until="detached", whole=True, throw=False)
    if found.outcome is Outcome.STOPPED:
        raise InputError(f"at {readable(speed, 'm/s')}: {found.status}")
    unit, peak = problem.scales(), pull_off(found)
    last = np.ones(len(found.depth), bool)
    if problem.protocol.moves and found.move is not None:
        last = found.move == len(problem.protocol.moves)
        last[np.flatnonzero(last)[0] - 1] = True  # the state in which the last move ended
    depth, force = found.depth[last], found.force[last]
    start, gone = float(depth[0]), depth[0] - depth
    first = start - peak.depth
    if not first > 0:
        raise InputError(
            f"at {readable(speed, 'm/s')} the tension is largest at the start of the retraction, "
            "so that no speed changes it; press more"
        )
    fallen = int(np.flatnonzero((gone > first) & (force > -peak.force / 2))[0])
    half = np.interp(-peak.force / 2, force[fallen - 1 : fallen + 1], gone[fallen - 1 : fallen + 1])
    travel = np.maximum.accumulate([first, half, gone.max()]) + first * _JUMP * np.arange(3)
    share = _shares()
    shown = np.interp(np.interp(share, [0, 1, 2, 3], [0.0, *travel]), gone, force)
    shown[share == 1], shown[share == 2], shown[-1] = -peak.force, -peak.force / 2, 0.0
    error = (found.error_estimate or {}).get("force", accuracy)
    return _Pull(float(speed), start * unit.length, travel * unit.length, shown * unit.force, error)


def _miss(low: _Pull, middle: _Pull, high: _Pull) -> float:
    """Return by how much the mean of two neighbours misses the middle, relative.

    Below half of the pull-off force the contact opens by itself, mostly in a jump at some depth.
    """
    held = _shares() <= 2
    missed = np.abs((low.force + high.force) / 2 - middle.force)
    force = np.max(missed[held]) / middle.peak
    travel = np.max(np.abs((low.travel + high.travel) / 2 / middle.travel - 1)[:2])
    return float(max(force, travel))
