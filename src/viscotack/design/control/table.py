r"""Force of a contact by depth and speed of a retraction, for controllers, made by simulations.

A row of the table is the retraction from one start at one speed. Rows have the same shares u of the
way: u = 0 at the start, 1 at the largest tension, 2 where the tension has fallen to half of it, and
3 where the surfaces are apart. With the travels d0 = 0, d1, d2, d3 to these,

.. math:: \delta = \delta_0 - d_j - (d_{j+1} - d_j)(u - j), \quad j \le u \le j + 1.

Between two speeds, forces at equal shares and the travels are linear in the logarithm of the speed,
so that peaks of neighbouring rows are joined with each other, and so are their falls. Beyond the
end the force is 0, before the start it has no value. Speeds are added until the interpolation
misses no simulation between them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, log, nan

import numpy as np

from viscotack.arrays import Array
from viscotack.clock import limited
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.result import Outcome
from viscotack.result.observables import pull_off
from viscotack.simulate import solve
from viscotack.units import readable


@dataclass(frozen=True, eq=False)
class ForceTable:
    """Force of a contact by depth and speed of its retraction, in SI.

    Attributes
    ----------
    start_depth : float
        Depth at which every retraction starts [m], positive into the solid.
    speed : ndarray, shape (m,)
        Speeds of retraction of the contact [m/s], positive, ascending.
    travel : ndarray, shape (m, 3)
        Travels from the start to the pull-off, to half of its force and to the end [m], ascending.
    share : ndarray, shape (n,)
        Shares of the way, ascending from 0 to 3; 1 and 2 are among them.
    force : ndarray, shape (m, n)
        Forces [N], positive in compression.
    error : float
        Largest error of a force over the pull-off force, until half of that is left, and of the
        travels to both: of the interpolation, as measured at speeds between, and as estimated for
        the simulations.
    of : str
        The contact in words.

    Examples
    --------
    >>> import numpy as np
    >>> table = ForceTable(
    ...     start_depth=1e-6,
    ...     speed=np.array([1e-6, 1e-4]),
    ...     travel=np.array([[2e-6, 3e-6, 4e-6], [4e-6, 5e-6, 6e-6]]),
    ...     share=np.array([0.0, 1.0, 2.0, 3.0]),
    ...     force=np.array([[1e-3, -1e-3, -5e-4, 0.0], [1e-3, -3e-3, -1.5e-3, 0.0]]),
    ...     error=0.01,
    ...     of="an example",
    ... )
    >>> f"{table.force_at(-2e-6, 1e-5):.4f} {table.speed_for(2e-3):.1e}"
    '-0.0020 1.0e-05'
    """

    start_depth: float
    speed: Array
    travel: Array
    share: Array
    force: Array
    error: float
    of: str

    @property
    def pull_off_force(self) -> Array:
        """Pull-off forces at the speeds of the table [N], positive; shape (m,)."""
        return -self.force[:, self._peak]

    @property
    def _peak(self) -> int:
        return int(np.searchsorted(self.share, 1.0))

    def force_at(self, depth: float, speed: float) -> float:
        """Return the force at a depth in a retraction at a speed.

        Parameters
        ----------
        depth : float
            [m], positive into the solid.
        speed : float
            Of the contact [m/s], positive.

        Returns
        -------
        float
            Force [N], positive in compression; 0 beyond the end, nan before the start and at
            speeds outside the table.
        """
        return self._at(depth, speed)[0]

    def slope_at(self, depth: float, speed: float) -> float:
        """Return the derivative of the force by the depth [N/m]; other arguments as `force_at`."""
        return self._at(depth, speed)[1]

    def pull_off_force_at(self, speed: float) -> float:
        """Return the pull-off force at a speed [N], positive; nan outside the table."""
        i, part = self._between(speed)
        if i < 0:
            return nan
        P = self.pull_off_force
        return float(P[i] + part * (P[i + 1] - P[i]))

    def speed_for(self, wanted: float) -> float:
        """Return the slowest speed at which the pull-off force is a wanted one.

        Parameters
        ----------
        wanted : float
            Pull-off force [N], positive.

        Returns
        -------
        float
            Speed of the contact [m/s].

        Raises
        ------
        OutOfRange
            If no speed of the table has this force; the message states the range.
        """
        P = self.pull_off_force
        for i in range(len(P) - 1):
            low, high = sorted((float(P[i]), float(P[i + 1])))
            if low <= wanted <= high:
                part = 0.0 if low == high else (wanted - P[i]) / (P[i + 1] - P[i])
                return float(self.speed[i] * (self.speed[i + 1] / self.speed[i]) ** part)
        ends = readable(float(P.min()), "N"), readable(float(P.max()), "N")
        speeds = (readable(float(self.speed[i]), "m/s") for i in (0, -1))
        raise OutOfRange(
            f"a pull-off force of {readable(wanted, 'N')} is out of reach: between {ends[0]} and "
            f"{ends[1]} at speeds from {' to '.join(speeds)}"
        )

    def _between(self, speed: float) -> tuple[int, float]:
        """Return the row below a speed and the part of the way to the next; -1 if outside."""
        v = self.speed
        if not v[0] <= speed <= v[-1]:
            return -1, nan
        i = min(int(np.searchsorted(v, speed, side="right")) - 1, len(v) - 2)
        return i, log(speed / v[i]) / log(v[i + 1] / v[i])

    def _at(self, depth: float, speed: float) -> tuple[float, float]:
        """Return the force at a depth and its derivative by the depth."""
        i, part = self._between(speed)
        gone = self.start_depth - depth
        if i < 0 or not gone >= 0:
            return nan, nan
        travel = self.travel[i] + part * (self.travel[i + 1] - self.travel[i])
        if gone >= travel[2]:
            return 0.0, 0.0
        leg = int(gone > travel[0]) + int(gone > travel[1])
        before = 0.0 if leg == 0 else travel[leg - 1]
        way = travel[leg] - before
        u = leg + (gone - before) / way
        # at the peak, the part before it
        j = int(np.searchsorted(self.share, u, side="left")) - 1
        j = min(max(j, 0), len(self.share) - 2)
        row = self.force[i] + part * (self.force[i + 1] - self.force[i])
        width = self.share[j + 1] - self.share[j]
        rise = (row[j + 1] - row[j]) / width
        return float(row[j] + (u - self.share[j]) * rise), float(-rise / way)


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
