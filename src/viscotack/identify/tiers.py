"""Forces of tests by the better of two tiers: theory of a steady crack, or simulation.

Tables of forces (:mod:`.interpolated_forces`) are for relaxed contacts and rigid machines, by
theory. For tests at which the theory does not hold, the ratio of the true force to that of the
table is computed at interfaces spread over the likely ones, each by simulation or, where the theory
holds, by theory, and interpolated (:mod:`.smooth_ratio`).
"""

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.problem import Problem
from viscotack.protocol import Move
from viscotack.units import readable

from .covariances import ModelError
from .forward import Changed, Forward
from .machine_compliance import Yielding
from .search import Search
from .simulations import ACCURACY, Simulations
from .smooth_ratio import LENGTHS, Mixed, SmoothRatio, scaled

GOOD_TABOR = 5.0  # effective: from it the theory is within its stated error
LEAST_TABOR = 0.2  # effective: smallest of the table
# Largest Tabor numbers that are simulated, from rest and after an approach.
_MOST_TABOR, _MOVED_TABOR = 100.0, 30.0
# Up to it a test whose force is simulated for some interfaces is simulated for all.
_CHEAP_TABOR = 40.0
_BAND = 0.033  # largest band of a good theory: 1.645 times its stated error
_UNKNOWN = 0.15  # relative error of the theory where it does not hold
_LIKELY = 10.0  # misfit above the least of the interfaces at which simulations are
_ROUNDS = 6
# Distance between interfaces, factor by which it falls while the error is above the wanted one, and
# most interfaces at a time.
_APART, _CLOSER, _WANTED, _MOST_POINTS = 0.6, 0.6, 0.01, 10
_RADII = 40  # points of a curve for Tabor numbers
_NAMED = 4  # largest number of speeds named one by one
_NODES = 8  # largest number of speeds of a forecast that are simulated each
_THINNED = 4  # one of this many samples of a posterior serves for Tabor numbers
_NEAR = 1.0  # distance of an interface from the likely ones up to which its error counts

# Error common to all measured forces, whose zero is separated from attraction out of contact by a
# model: at a Tabor number of 1, and the largest one.
_BENT, _MOST_BENT = 0.02, 0.004

_NO_TIER = "the theory does not hold, and the Tabor number is too large to simulate"


class Conditions(NamedTuple):
    """Conditions of tests.

    Attributes
    ----------
    speed, load : ndarray, shape (S,)
        Speed of the drive [m/s] and preload [N].
    stiffness : float or None
        Stiffness of the machine [N/m]; None for a rigid one.
    moves : tuple of tuple of Move
        Moves of each test before the retraction; empty if all contacts are relaxed.
    """

    speed: Array
    load: Array
    stiffness: float | None
    moves: tuple[tuple[Move, ...], ...] = ()

    def some(self, at: npt.NDArray[Any]) -> "Conditions":
        """Select tests."""
        moves = tuple(self.moves[i] for i in np.arange(self.speed.size)[at]) if self.moves else ()
        return self._replace(speed=self.speed[at], load=self.load[at], moves=moves)

    def at(self, speed: Array) -> "Conditions":
        """Return tests at other speeds, with load and moves of the first."""
        load = np.full(speed.size, self.load[0])
        return self._replace(speed=speed, load=load, moves=self.moves[:1] * speed.size)

    def moved(self, test: int) -> tuple[Move, ...]:
        """Return the moves of a test."""
        return self.moves[test] if self.moves else ()


def beyond(changed: Changed) -> npt.NDArray[np.bool_]:
    """Whether the theory does not hold for a test within its stated error, shape (S,)."""
    found = changed.band > _BAND
    found[list(changed.refused)] = True
    return found


@dataclass(frozen=True, eq=False)
class Tiers:
    """Ratios of forces at some interfaces.

    Parameters
    ----------
    forward : Forward
        Theory.
    tests : Conditions
        Tests, S in number.
    runs : Simulations
        Simulations.
    points : ndarray, shape (N, 2)
        Interfaces, as of :func:`.smooth_ratio.scaled`.
    log_ratio : ndarray, shape (N, S)
        ln of the force over that of a relaxed contact and a rigid machine by theory; nan where no
        tier has an answer.
    simulated : ndarray of bool, shape (N, S)
        Whether it is simulated.
    """

    forward: Forward
    tests: Conditions
    runs: Simulations
    points: Array
    log_ratio: Array
    simulated: npt.NDArray[np.bool_]

    @classmethod
    def none(cls, forward: Forward, tests: Conditions, runs: Simulations) -> "Tiers":
        """Return tiers that were evaluated at no interface."""
        empty = np.empty((0, tests.speed.size))
        return cls(forward, tests, runs, np.empty((0, 2)), empty, empty.astype(bool))

    def over(self, likely: Array, apart: float) -> "Tiers":
        """Ask the tiers at more interfaces, until all likely ones (points) have one nearby."""
        return self.at(_spread(likely, self.points, apart))

    def at(self, new: Array) -> "Tiers":
        """Ask the tiers at more interfaces (points)."""
        if not len(new):
            return self
        works, gaps = np.exp(new * LENGTHS).T
        tests = self.tests
        rigid = self.forward.pulled(works[:, None], gaps[:, None], tests.speed, tests.load)
        length = (self.forward.radius * (works / self.forward.material.contact_modulus) ** 2) ** (
            1 / 3
        )
        low = rigid.effective_tabor < GOOD_TABOR
        low |= (length / gaps < _CHEAP_TABOR)[:, None] | bool(tests.moves)
        rows = [self._asked(*row) for row in zip(works, gaps, low, strict=True)]
        log_ratio = np.array([row for row, _ in rows])
        simulated = np.zeros(log_ratio.shape, dtype=bool)
        places = [(n, test) for n, (_, problems) in enumerate(rows) for test in problems]
        if places:
            at = tuple(np.array(places).T)
            problems = [problem for _, row in rows for problem in row.values()]
            log_ratio[at] = np.log(self.runs.forces(problems) / rigid.force[at])
            simulated[at] = True
        return replace(
            self,
            points=np.concatenate([self.points, new]),
            log_ratio=np.concatenate([self.log_ratio, log_ratio]),
            simulated=np.concatenate([self.simulated, simulated]),
        )

    def _asked(
        self, work: float, gap: float, low: npt.NDArray[np.bool_]
    ) -> tuple[Array, dict[int, Problem]]:
        """Return ln(ratio) of each test by theory, and the problems of those to be simulated.

        These are tests whose Tabor number is `low`, or for which the theory does not hold. The
        ratio is nan where theory has no answer.
        """
        problems = self._problems(work, gap, np.flatnonzero(low))
        others = np.setdiff1d(np.arange(low.size), list(problems))
        log_ratio = np.full(low.size, np.nan)
        log_ratio[others], poor = self._by_theory(work, gap, others)
        return log_ratio, problems | self._problems(work, gap, poor[~low[poor]])

    def _by_theory(
        self, work: float, gap: float, which: npt.NDArray[np.intp]
    ) -> tuple[Array, npt.NDArray[np.intp]]:
        """Return ln(ratio) of some tests by theory, and those for which it does not hold."""
        tests, none = self.tests, np.full(which.size, np.nan)
        if not which.size:
            return none, which
        try:
            changed = self.forward.changed(
                work,
                gap,
                tests.speed[which],
                tests.load[which],
                stiffness=tests.stiffness,
                moves=tests.some(which).moves,
            )
        except InputError:  # strains too large
            return none, which
        log_ratio = np.log(changed.ratio)
        log_ratio[list(changed.refused)] = np.nan
        return log_ratio, which[beyond(changed)]

    def _problems(self, work: float, gap: float, which: npt.NDArray[np.intp]) -> dict[int, Problem]:
        """Return the problems of some tests, without those that cannot be simulated."""
        tests = self.tests
        most = _MOVED_TABOR if tests.moves else _MOST_TABOR
        found = {}
        with suppress(InputError):  # strains too large
            for test in map(int, which):
                load, speed = float(tests.load[test]), float(tests.speed[test])
                problem = self.forward.problem(
                    work, gap, load, speed, stiffness=tests.stiffness, moves=tests.moved(test)
                )
                if problem.groups().tabor <= most:
                    found[test] = problem
        return found

    @property
    def unanswered(self) -> npt.NDArray[np.bool_]:
        """Tests for which less than half of the interfaces have an answer, shape (S,)."""
        return np.mean(np.isfinite(self.log_ratio), axis=0) < 0.5

    def ratio(self) -> SmoothRatio:
        """Interpolate the ratios."""
        return SmoothRatio.through(self.points, self.log_ratio)

    def error(self, likely: Array) -> Array:
        """Return the relative standard error of the interpolation of each test, shape (S,).

        It is the root mean square over the likely interfaces, with the error of the simulation.
        """
        left_out = self.ratio().left_out
        near = _distance(self.points, likely) < _NEAR
        with np.errstate(invalid="ignore"):
            size = np.sqrt(np.nanmean(np.atleast_2d(left_out[near]) ** 2, axis=0))
        return np.hypot(size, ACCURACY)

    def by_simulation(self, work: float, gap: float) -> npt.NDArray[np.bool_]:
        """Whether the force of each test is simulated near an interface, shape (S,)."""
        away = _distance(self.points, scaled(work, gap)[None])
        return self.simulated[int(np.argmin(away))]


def _distance(points: Array, others: Array) -> Array:
    """Return the distance of each point from the nearest other, shape (N,)."""
    if not len(others):
        return np.full(len(points), np.inf)
    return np.linalg.norm(points[:, None] - others, axis=-1).min(axis=1)


def _spread(likely: Array, known: Array, apart: float) -> Array:
    """Return likely points that are farthest from those known and from each other.

    The first likely point is taken first; the others are more than `apart` from any.
    """
    away = _distance(likely, known)
    found = [0] if away[0] > apart / 2 else []
    while len(found) < _MOST_POINTS:
        nearer = np.minimum(away, _distance(likely, likely[found]))
        farthest = int(np.argmax(nearer))
        if nearer[farthest] <= apart:
            break
        found.append(farthest)
    return likely[found]


class Answered(NamedTuple):
    """A search with forces by the better tier of each test.

    Attributes
    ----------
    search : Search
        Search over all tests.
    refused : dict
        Index of a test that no tier answers -> reason.
    words : list of str
        Sentences on simulated forces.
    """

    search: Search
    refused: dict[int, str]
    words: list[str]


def answered(
    search: Search, changed: Changed, forward: Forward, tests: Conditions, runs: Simulations
) -> Answered:
    """Simulate the tests at which the theory does not hold, for the likely interfaces.

    The likely interfaces are found with a large error for these tests, then with that of the
    interpolated simulations, until all of them have a simulated interface nearby.

    Parameters
    ----------
    search : Search
        Search by theory.
    changed : Changed
        Ratios of the tests by theory for the most likely interface.
    forward : Forward
        Theory.
    tests : Conditions
        Their conditions.
    runs : Simulations
        Simulations.
    """
    data, theory = search.data, search.yielding
    assert isinstance(theory, Yielding), "nothing is simulated yet"
    simulated = beyond(changed)
    tiers, material = Tiers.none(forward, tests, runs), search.spread - data.spread
    error, apart, bent = np.full(data.speed.size, _UNKNOWN), _APART, 0.0
    for _ in range(_ROUNDS):
        points = search.likely(_LIKELY)
        more = simulated | _low(forward, tests, points)
        if not more.any():
            return Answered(search, {}, [])
        begins = bool(np.any(more != simulated)) or not len(tiers.points)
        if begins:
            simulated = more
            model = _model(simulated, data.theory, error)
            spread = data.own + model.covariance(data.speed) + material
            search = replace(search, spread=spread + bent**2)
            points = search.likely(_LIKELY)
            known, tiers = tiers.points, Tiers.none(forward, tests.some(simulated), runs)
            tiers = tiers.at(known)
        likely, count = points / LENGTHS, len(tiers.points)
        tiers = tiers.over(likely, apart)
        if len(tiers.points) == count and not begins:
            break
        if tiers.unanswered.any():
            lost = np.flatnonzero(simulated)[tiers.unanswered].tolist()
            return Answered(search, {i: changed.refused.get(i, _NO_TIER) for i in lost}, [])
        error[simulated] = tiers.error(likely)
        bent = _bent(forward, *np.exp(points[0]))
        near = simulated.copy()
        near[simulated] = tiers.by_simulation(*np.exp(points[0]))
        model = _model(near, data.theory, error)
        search = replace(
            search,
            model=model,
            yielding=Mixed(theory, np.flatnonzero(simulated), tiers.ratio()),
            spread=data.own + model.covariance(data.speed) + material + bent**2,
        )
        apart *= _CLOSER if model.simulation.max() > _WANTED else 1.0
    return Answered(search, {}, words(tests, search.model.simulation, runs.count))


def _bent(forward: Forward, work: float, gap: float) -> float:
    """Return the relative error, common to all tests, of measured forces by their zero."""
    stiffness = forward.material.contact_modulus
    tabor = (forward.radius * (work / stiffness) ** 2) ** (1 / 3) / gap
    return min(_BENT / tabor**2, _MOST_BENT)


def _model(simulated: npt.NDArray[np.bool_], theory: float, error: Array) -> ModelError:
    """Return the errors of tests, some of them simulated."""
    return ModelError(np.where(simulated, 0.0, theory), np.where(simulated, error, 0.0))


class Tested(NamedTuple):
    """Ratios of forces of tests that were not measured, with interfaces that are known.

    Attributes
    ----------
    ratio : ndarray, shape (M, n)
        Ratio of the force to that of a relaxed contact and a rigid machine by theory, for each
        interface but the first; shape (n,) if it is the same for all.
    model : ModelError
        Relative errors of the forces.
    refused : dict
        Index of a test that no tier answers -> reason.
    words : list of str
        Sentences on simulated forces.
    """

    ratio: Array
    model: ModelError
    refused: dict[int, str]
    words: list[str]


def by_theory(changed: Changed, theory: float) -> Tested:
    """Return ratios by theory alone."""
    none = np.zeros(changed.ratio.size)
    return Tested(changed.ratio, ModelError(none + theory, none), changed.refused, [])


def tested(
    interfaces: Array,
    changed: Changed,
    forward: Forward,
    tests: Conditions,
    theory: float,
) -> Tested:
    """Simulate tests at which the theory does not hold, for interfaces of a posterior.

    Tests at many speeds are simulated at some and interpolated between.

    Parameters
    ----------
    interfaces : ndarray, shape (M, 2)
        ln of work and range, the most likely first.
    changed : Changed
        Ratios by theory for the most likely.
    forward : Forward
        Theory.
    tests : Conditions
        Their conditions.
    theory : float
        Relative error of the theory.
    """
    simulated = beyond(changed) | _low(forward, tests, interfaces[::_THINNED])
    if not simulated.any():
        return by_theory(changed, theory)
    with Simulations() as runs:
        return _simulated(interfaces, simulated, changed, forward, tests, theory, runs)


def _simulated(
    interfaces: Array,
    which: npt.NDArray[np.bool_],
    changed: Changed,
    forward: Forward,
    tests: Conditions,
    theory: float,
    runs: Simulations,
) -> Tested:
    """Return the ratios of tests, some of them (`which`) simulated."""
    likely, some = interfaces / LENGTHS, tests.some(which)
    nodes = some
    if some.speed.size > _NODES:
        nodes = some.at(np.geomspace(some.speed.min(), some.speed.max(), _NODES))
    tiers, apart = Tiers.none(forward, nodes, runs).over(likely, _APART), _APART
    for _ in range(_ROUNDS):
        if tiers.unanswered.any():
            lost = int(np.argmax(which))
            return by_theory(changed, theory)._replace(refused=changed.refused or {lost: _NO_TIER})
        if tiers.error(likely).max() <= _WANTED:
            break
        apart *= _CLOSER
        tiers = tiers.over(likely, apart)
    known, error = tiers.ratio().at(likely), tiers.error(likely)
    simulated = tiers.by_simulation(*np.exp(interfaces[0])).astype(float)
    if nodes is not some:
        x, at = np.log(some.speed), np.log(nodes.speed)
        # held out: the most likely interface between the nodes
        middle = nodes.at(np.sqrt(nodes.speed[1:] * nodes.speed[:-1]))
        held = Tiers.none(forward, middle, runs).at(likely[:1]).log_ratio[0]
        away = held - CubicSpline(at, np.log(known[0]))(np.log(middle.speed))
        known = np.exp(CubicSpline(at, np.log(known), axis=1)(x))
        error = np.hypot(np.interp(x, at, error), np.sqrt(np.nanmean(away**2)))
        simulated = np.interp(x, at, simulated)
    ratio = np.tile(changed.ratio, (len(known) - 1, 1))
    ratio[:, which] = known[1:]
    errors, by_simulation = np.zeros(which.size), which.copy()
    errors[which], by_simulation[which] = error, simulated > 0
    model = _model(by_simulation, theory, errors)
    return Tested(ratio, model, {}, words(tests, model.simulation, runs.count))


def _low(forward: Forward, tests: Conditions, points: Array) -> npt.NDArray[np.bool_]:
    """Whether the effective Tabor number of each test is low at one of the points, shape (S,)."""
    work, gap = np.exp(points).T
    pulled = forward.pulled(work[:, None], gap[:, None], tests.speed, tests.load, _RADII)
    return np.any(pulled.effective_tabor < GOOD_TABOR, axis=0) | bool(tests.moves)


def words(tests: Conditions, error: Array, count: int) -> list[str]:
    """Return a sentence on the tests whose forces are simulated, with their errors above 0."""
    speeds = np.sort(tests.speed[error > 0])
    if not speeds.size:
        return []
    at = ", ".join(readable(float(speed), "m/s", digits=3) for speed in speeds)
    if speeds.size > _NAMED:
        at = readable(float(speeds[0]), "m/s", digits=3, to=float(speeds[-1]))
        at = f"{speeds.size} speeds, {at}"
    return [
        f"forces by simulation at {at}, where the theory does not hold: {count} simulations, "
        f"error of the interpolated force {error.max():.1%}"
    ]
