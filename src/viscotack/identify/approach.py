r"""Identify the range of attraction from the approach: before the contact, behind the rig's spring.

A sphere that approaches is attracted before it touches. Where the attraction grows faster than the
spring and the solid resist, it jumps in. Both the attraction up to there and its distance depend on
the range h0, and hardly on rates: no crack runs yet. Far apart only :math:`\Delta\gamma_0 h_0^2`
counts, Hamaker's constant :math:`16\pi\,\Delta\gamma_0 h_0^2` of a Lennard-Jones law.

The states before the jump are those of an elastic half-space with a given gap at the axis, which is
monotonic where the drive turns back. A rigid solid far apart jumps at :math:`P = K h/2`,
:math:`h^3 = 16\pi\,\Delta\gamma_0 h_0^2 R/(3K)`; a soft one earlier, at a smaller force. So the
relaxed modulus gives the largest range for a force, and the modulus at once the smallest.

The work of adhesion lies between that which the tension after the jump-in needs, where adhesion
closes the contact and the solid takes a part of it, and that of the pull-off. The baseline of the
force is a straight line: a curved one is read as attraction.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.lab.tack import Cycle
from viscotack.model.geometry.half_space import influence
from viscotack.model.traction import LennardJones
from viscotack.theory import lennard_jones
from viscotack.units import readable

from .likelihood import Interval

_Fit = TypeVar("_Fit")

_INNER, _OUTER = 36, 24  # nodes in the attracted area, and outside it
_REACH = 15.0  # radius of the mesh over that of the attracted area
_FAR = 20.0  # largest gap at the axis over that at the jump
_STATES = 66
_LEAST, _MOST_RANGE = 1e-4, 3.0  # searched ranges over the length at which the Tabor number is 1
_RANGES, _FINER = 40, 12  # number of ranges, and again between the neighbours of the best
_ERROR = 0.02  # relative error of a range, of computed attractions
_HOPELESS = 100.0  # excess of chi2 above which larger ranges are not tried
_SHARP = 9.0  # difference of chi2 above which an attraction is seen
_POOR = 1e-3  # probability of the samples below which the last one was taken during the jump
_DURING = 4  # largest number of such samples
_PLACES = 16  # places of the jump between two samples
_FEWEST = 20  # samples before the contact
_MOST = 600
_JUMP = 8.0  # fall of the force over the noise that is a jump
_QUIET = 1e-4  # smallest noise over the tension after the jump
_APPROACHES = 3  # number of cycles whose approach bounds the range
_AS_LARGE = 0.3  # falls that belong to the jump, over the largest one


@dataclass(frozen=True, eq=False)
class Attraction:
    """Attraction of a sphere before its contact, by the travel that is left to the jump.

    Parameters
    ----------
    travel : ndarray, shape (N,)
        Travel of the drive to the jump [m], from 0 up.
    force : ndarray, shape (N,)
        Attraction there [N], positive.
    """

    travel: Array
    force: Array

    def at(self, travel: Array) -> Array:
        """Return the attraction [N]; beyond the last travel it falls with the square."""
        inside = np.interp(travel, self.travel, self.force)
        return inside * (self.travel[-1] / np.maximum(travel, self.travel[-1])) ** 2


@lru_cache(maxsize=400)
def attraction(
    law: LennardJones, *, radius: float, contact_modulus: float, stiffness: float | None = None
) -> Attraction:
    """Compute the attraction of a sphere that approaches an elastic half-space, up to its jump-in.

    Parameters
    ----------
    law : LennardJones
        Interface.
    radius, contact_modulus : float
        R of the sphere [m] and E* of the solid [Pa].
    stiffness : float, optional
        Stiffness of the machine [N/m]; rigid when left out.

    Raises
    ------
    OutOfRange
        If the surfaces touch without a jump.

    Examples
    --------
    >>> law = LennardJones(work_of_adhesion=0.058, equilibrium_gap=1e-9)
    >>> case = dict(radius=7.5e-6, contact_modulus=1.9e6, stiffness=3.0)
    >>> f"{attraction(law, **case).force[0] * 1e9:.1f} nN at the jump"
    '8.8 nN at the jump'
    """
    work, range_ = law.work_of_adhesion, law.equilibrium_gap
    of_solid = (8 * work * range_**2 * radius**0.5 / contact_modulus) ** (2 / 7)
    of_spring = 0.0
    if stiffness is not None:
        of_spring = (16 / 3 * np.pi * radius * work * range_**2 / stiffness) ** (1 / 3)
    size = max(of_solid, of_spring, range_)
    width = np.sqrt(2 * radius * size)
    r = width * np.append(
        np.linspace(0, 3, _INNER, endpoint=False), np.geomspace(3, _REACH, _OUTER)
    )
    soft = influence(r) / contact_modulus
    rigid = r**2 / (2 * radius)
    area = np.pi * np.append(np.diff(r**2), 0) / 2 + np.pi * np.append(0, np.diff(r**2)) / 2
    drives, forces = [], []
    gap, depth = _FAR * size + rigid, -_FAR * size
    for centre in np.geomspace(_FAR * size, max(0.2 * size, 0.9 * range_), _STATES):
        gap, depth = _state(law, gap + (centre - gap[0]), depth, rigid, soft)
        # beyond the mesh the flank of the sphere (Derjaguin)
        pull = area @ law.traction(gap) - 2 * np.pi * radius * float(law.energy(gap[-1]))
        drives.append(depth - (0.0 if stiffness is None else pull / stiffness))
        forces.append(pull)
        if len(drives) > 4 and drives[-1] < drives[-2] < drives[-3]:
            # the drive has turned back: a polynomial through the last states has the jump
            log = np.log(forces[-5:])
            curve = np.polynomial.Polynomial.fit(log, drives[-5:], 4)
            fine = np.linspace(log[0], log[-1], 400)
            jump = int(np.argmax(curve(fine)))
            before = np.array(forces) < np.exp(fine[jump])
            travel = float(curve(fine[jump])) - np.array(drives)[before][::-1]
            force = np.array(forces)[before][::-1]
            return Attraction(np.append(0.0, travel), np.append(np.exp(fine[jump]), force))
    raise OutOfRange("the surfaces touch without a jump: the range of attraction is too large")


def _state(
    law: LennardJones, gap: Array, depth: float, rigid: Array, soft: Array
) -> tuple[Array, float]:
    """Return gaps and depth in equilibrium with a given gap at the axis, by Newton's method."""
    for _ in range(60):
        left = gap + depth - rigid + soft @ law.traction(gap)
        tangent = np.eye(len(gap)) + soft * law.stiffness(gap)
        tangent[:, 0] = 1.0  # the depth takes the place of the gap at the axis
        step = -np.linalg.solve(tangent, left)
        change = np.append(0.0, step[1:])
        # gaps stay positive
        part = min(1.0, 0.3 / float(np.max(np.append(-change / gap, 0.3))))
        gap, depth = gap + part * change, depth + part * float(step[0])
        if np.max(np.abs(step)) < 1e-7 * gap[0]:
            return gap, depth
    raise OutOfRange("no equilibrium before the contact")


def work_of_jump_in(
    force: float, *, radius: float, contact_modulus: float, stiffness: float | None = None
) -> float:
    """Compute the work of adhesion [J/m2] for a tension after the jump-in [N], positive (JKR).

    The drive stands where the surfaces first touch, so that the indenter is drawn into the solid by
    the extension of the spring. A rigid machine keeps it at the depth 0.
    """
    depth = 0.0 if stiffness is None else force / stiffness
    # without the work, JKR's force and depth are a cubic for the contact radius
    cubic = [2 * contact_modulus / (3 * radius), 0.0, -2 * contact_modulus * depth, -force]
    a = float(np.max(np.roots(cubic).real))
    drawn = a**2 / radius - depth
    return contact_modulus * drawn**2 / (2 * np.pi * a)


@dataclass(frozen=True, eq=False)
class ApproachFit:
    """Range of attraction from an approach.

    Parameters
    ----------
    bound : float
        Upper bound of h0 at the level, one-sided [m].
    equilibrium_gap : Interval or None
        Interval of h0 at the level [m], where an attraction is seen before the jump.
    likely : float or None
        Most likely h0 [m], where one is seen.
    attraction : float
        Largest attraction before the jump [N], over the baseline.
    noise : float
        Standard deviation of the force out of contact [N].
    jump_in_force : float
        Largest tension after the jump, before the first compression [N].
    works : (float, float)
        Works of adhesion by the jump-in and by the pull-off [J/m2], or the given one twice.
    step : float
        Travel of the drive between samples at the jump [m].
    during : int
        Samples taken during the jump, which say nothing about equilibrium.
    level : float
        Confidence level.
    """

    bound: float
    equilibrium_gap: Interval | None
    likely: float | None
    attraction: float
    noise: float
    jump_in_force: float
    works: tuple[float, float]
    step: float
    during: int
    level: float

    @property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result."""
        low, high = (readable(work, "J/m2", digits=3) for work in self.works)
        jump, noise, level = readable(self.jump_in_force, "N"), self.noise, f"{self.level:.0%}"
        said = [f"range of attraction h0 at most {_length(self.bound)} ({level}, one-sided)"]
        if self.equilibrium_gap is None or self.likely is None:
            said.append(f"no attraction above the noise, {readable(noise, 'N', digits=2)}, is seen")
        else:
            seen = f"attraction of {readable(self.attraction, 'N', digits=2)} seen"
            ends = _length(self.equilibrium_gap.low, self.equilibrium_gap.high)
            said.append(f"{seen}: h0 {_length(self.likely)} ({ends}, {level})")
        said.append(f"tension after the jump-in {jump}: {low} by JKR, {high} by the pull-off")
        if self.during:
            said.append(f"samples taken during the jump, and left out: {self.during}")
        return (*said, f"samples at the jump are {_length(self.step)} apart; finer ones tell more")


def _length(value: float, to: float | None = None) -> str:
    return readable(value, "m", digits=2, to=to)


@dataclass(frozen=True, eq=False)
class _Before:
    """Samples before the contact: drive [m], force [N] with their noise, and the next drive."""

    drive: Array
    force: Array
    next_drive: float
    noise: float

    def chi2(self, curve: Attraction | None) -> float:
        """Return the least chi2 over zero, tilt and the place of the jump between two samples."""
        u = (self.drive - self.drive[-1]) / np.ptp(self.drive)
        line = np.column_stack([np.ones_like(u), u])
        project = line @ np.linalg.pinv(line)

        def misfit(force: Array) -> float:
            return float(np.sum((force - project @ force) ** 2)) / self.noise**2

        if curve is None:
            return misfit(self.force)
        places = np.linspace(self.drive[-1], self.next_drive, _PLACES)
        return min(misfit(self.force + curve.at(place - self.drive)) for place in places)


@dataclass(frozen=True, eq=False)
class _Scan:
    """chi2 by range, and without attraction; the chance of the best of them."""

    gaps: Array
    chi2: Array
    none: float
    samples: int

    @property
    def chance(self) -> float:
        return float(chi2.sf(min(*self.chi2, self.none), self.samples - 4))

    def ends(self, allowed: float) -> tuple[float, float]:
        """Return the ranges between which chi2 is less than the least plus what is allowed."""
        left = self.chi2 - min(*self.chi2, self.none) - allowed
        inside = np.flatnonzero(left <= 0)
        if not inside.size:
            return 0.0, float(self.gaps[0])
        log, first, last = np.log(self.gaps), int(inside[0]), int(inside[-1])
        below, above = slice(max(first - 1, 0), first + 1), slice(last, last + 2)
        low = np.interp(0, -left[below], log[below])
        high = np.interp(0, left[above], log[above])
        return float(np.exp(low)) * (1 - _ERROR), float(np.exp(high)) * (1 + _ERROR)


def _scan(before: _Before, work: float, pull_off: float | None, **rig: Any) -> _Scan:
    """Try ranges from small ones up, until they are hopeless or do not jump.

    The work is at most that of the pull-off force [N] with forces of this range, if one is given;
    `rig` are the sphere, solid and machine of :func:`attraction`.
    """
    R, modulus, none = rig["radius"], rig["contact_modulus"], before.chi2(None)
    found: dict[float, float] = {}

    def attempt(gap: float) -> bool:
        most = work
        if pull_off is not None:
            by_jkr = pull_off / (1.5 * np.pi * R)
            tabor = (R * (by_jkr / modulus) ** 2) ** (1 / 3) / gap
            most = min(work, by_jkr / float(lennard_jones.pull_off_ratio(tabor)))
        try:
            found[gap] = before.chi2(attraction(LennardJones(most, gap), **rig))
        except OutOfRange:
            return False
        return found[gap] < min(*found.values(), none) + _HOPELESS

    gaps = (R * (work / modulus) ** 2) ** (1 / 3) * np.geomspace(_LEAST, _MOST_RANGE, _RANGES)
    for gap in gaps:
        if not attempt(float(gap)):
            break
    # again between the neighbours of the best
    best = min(found, key=lambda gap: found[gap])
    for gap in best * np.geomspace(gaps[0] / gaps[1], gaps[1] / gaps[0], _FINER):
        attempt(float(gap))
    every = np.array(sorted(found))
    return _Scan(every, np.array([found[gap] for gap in every]), none, before.drive.size)


def _before(cycle: Cycle) -> tuple[_Before, float]:
    """Return the samples before the contact of a cycle, and the tension after the jump [N]."""
    end = cycle.segments.dwell
    force, drive = cycle.force[:end], (cycle.depth + cycle.compliance * cycle.force)[:end]
    if end < _FEWEST:
        raise InputError("a cycle without an approach has no jump-in", field="files")
    falls = -np.diff(force)
    largest = float(falls.max())
    if largest < _JUMP * cycle.noise:
        noise = readable(cycle.noise, "N", digits=2)
        raise OutOfRange(f"no jump-in above the noise of {noise}, or its samples are too close")
    # a jump may take several samples
    jump = int(np.flatnonzero(falls >= _AS_LARGE * largest)[0])
    if jump + 1 < _FEWEST:
        raise InputError(
            f"{jump + 1} samples before the jump-in, at least {_FEWEST} are needed", field="files"
        )
    later = force[jump + 1 :]
    pressed = np.flatnonzero(later > 0)
    tension = -float(np.min(later[: pressed[0] if pressed.size else None], initial=0.0))
    if tension <= _JUMP * cycle.noise:
        raise OutOfRange("no tension follows the jump of the force: it is no jump into contact")
    first = max(jump + 1 - _MOST, 0)
    part = slice(first, jump + 1)
    # the noise of the outer half, where nothing is attracted
    outer = force[first : first + (jump + 1 - first) // 2]
    index = np.arange(outer.size)
    noise = float(np.std(outer - np.polyval(np.polyfit(index, outer, 1), index), ddof=2))
    noise = max(noise, cycle.noise, _QUIET * tension)
    return _Before(drive[part], force[part], float(drive[jump + 1]), noise), tension


def identify_approach(
    cycle: Cycle,
    *,
    radius: float,
    contact_modulus: float,
    instantaneous: float | None = None,
    work_of_adhesion: float | None = None,
    level: float = 0.9,
) -> ApproachFit:
    """Bound the range of attraction by the approach of a test, and give it where it is resolved.

    Parameters
    ----------
    cycle : Cycle
        Test with an approach that begins free of contact, and the compliance of its rig.
    radius, contact_modulus : float
        R of the sphere [m] and E0* of the relaxed solid [Pa].
    instantaneous : float, optional
        Contact modulus at once [Pa], at most; by default the solid is elastic.
    work_of_adhesion : float, optional
        Known work [J/m2]; by default between that of the jump-in and that of the pull-off.
    level : float
        Confidence level: two-sided of the interval, one-sided of the bound.

    Raises
    ------
    OutOfRange
        If no jump is seen, or attraction of no searched range fits the samples.
    """
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level!r}", field="level")
    before, tension = _before(cycle)
    rig: dict[str, Any] = {"radius": radius, "contact_modulus": contact_modulus}
    rig["stiffness"] = 1 / cycle.compliance if cycle.compliance > 0 else None
    if work_of_adhesion is not None:
        works = (work_of_adhesion, work_of_adhesion)
    else:
        by_jump = work_of_jump_in(tension, **rig)
        by_pull = cycle.pull_off_force.value / (1.5 * np.pi * radius)
        works = (min(by_jump, by_pull), by_pull)
    pull_off = None if work_of_adhesion is not None else cycle.pull_off_force.value
    during, soft = 0, _scan(before, works[0], pull_off, **rig)
    while during < _DURING and soft.chance < _POOR:
        # without the last sample, with the jump anywhere behind the others
        before = replace(before, drive=before.drive[:-1], force=before.force[:-1])
        during, soft = during + 1, _scan(before, works[0], pull_off, **rig)
    if soft.chance < _POOR:
        raise OutOfRange(
            "no range fits the forces before the jump-in: their baseline is not straight, or the "
            "attraction is another"
        )
    interval, likely = None, None
    if soft.none - min(soft.chi2) > _SHARP:
        allowed = float(chi2.ppf(level, 1))
        hard = rig | {"contact_modulus": instantaneous or contact_modulus}
        low = _scan(before, works[1], pull_off, **hard).ends(allowed)[0]
        interval = Interval(low, soft.ends(allowed)[1], True, True)
        likely = float(soft.gaps[int(np.argmin(soft.chi2))])
    baseline = np.polyfit(before.drive[: -_FEWEST // 2], before.force[: -_FEWEST // 2], 1)
    last = float(np.polyval(baseline, before.drive[-1])) - float(before.force[-1])
    return ApproachFit(
        bound=soft.ends(float(chi2.ppf(2 * level - 1, 1)))[1],
        equilibrium_gap=interval,
        likely=likely,
        attraction=max(last, 0.0),
        noise=before.noise,
        jump_in_force=tension,
        works=works,
        step=float(np.median(np.diff(before.drive[-_FEWEST:]))),
        during=during,
        level=level,
    )


def of_every(
    cycles: Sequence[Cycle], fitted: Callable[[Cycle], _Fit]
) -> tuple[tuple[_Fit, ...], tuple[str, ...]]:
    """Return the fits of the cycles that can be fitted, and the reasons for the others."""
    fits, refused = [], []
    for cycle in cycles:
        try:
            fits.append(fitted(cycle))
        except InputError as error:
            refused.append(f"{Path(cycle.source.path).name}: cycle {cycle.number}: {error}")
    return tuple(fits), tuple(refused)


def range_bound(
    cycles: Sequence[Cycle], radius: float, contact_modulus: float, level: float
) -> float | None:
    """Return the upper bound of h0 by a few of the approaches [m], their median; None without."""
    some = cycles[:: max(len(cycles) // _APPROACHES, 1)][:_APPROACHES]
    case = {"radius": radius, "contact_modulus": contact_modulus, "level": level}
    fits, _ = of_every(some, lambda cycle: identify_approach(cycle, **case))
    return float(np.median([fit.bound for fit in fits])) if fits else None
