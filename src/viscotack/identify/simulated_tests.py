"""Forces of tests for which the theory of a steady crack does not hold, by simulation.

Tables of forces (:mod:`.interpolated_forces`) are for relaxed contacts and rigid machines, by
theory. For tests at which the theory does not hold, the ratio of the true force to that of the
table is computed at interfaces spread over the likely ones, each by simulation or, where the theory
holds, by theory, and interpolated (:class:`.force_ratios.SmoothRatio`).
"""

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.units import readable

from .covariances import ModelError, SphereTests
from .force_ratios import LENGTHS, Mixed, SmoothRatio, Yielding, scaled
from .forward import Changed, Forward, Interface
from .search import Search
from .simulations import ACCURACY, Simulations

GOOD_TABOR = 5.0  # effective: from it the theory is within its stated error
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
_NODES = 8  # largest number of speeds of a forecast that are simulated each
_THINNED = 4  # one of this many samples of a posterior serves for Tabor numbers
_NEAR = 1.0  # distance of an interface from the likely ones up to which its error counts

# Error common to all measured forces, whose zero is separated from attraction out of contact by a
# model: at a Tabor number of 1, and the largest one.
_BENT, _MOST_BENT = 0.02, 0.004

_TOO_LARGE = "the theory does not hold, and the Tabor number is too large to simulate"


@dataclass(frozen=True, eq=False)
class KnownRatios:
    """Ratios of forces at some interfaces.

    Parameters
    ----------
    tests : SphereTests
        Tests, S in number.
    runs : Simulations
        Simulations.
    points : ndarray, shape (N, 2)
        Interfaces, as of :func:`.force_ratios.scaled`.
    log_ratio : ndarray, shape (N, S)
        ln of the force over that of a relaxed contact and a rigid machine by theory; nan where
        neither theory nor simulation has an answer.
    simulated : ndarray of bool, shape (N, S)
        Whether it is simulated.
    """

    tests: SphereTests
    runs: Simulations
    points: Array
    log_ratio: Array
    simulated: npt.NDArray[np.bool_]

    @classmethod
    def none(cls, tests: SphereTests, runs: Simulations) -> "KnownRatios":
        """Return the ratios at no interface."""
        empty = np.empty((0, tests.speed.size))
        return cls(tests, runs, np.empty((0, 2)), empty, empty.astype(bool))

    def over(self, likely: Array, apart: float) -> "KnownRatios":
        """Add interfaces, until all likely ones (points) have one nearby.

        They are the farthest from those known and from each other, the first likely one first.
        """
        away = _distance(likely, self.points)
        found = [0] if away[0] > apart / 2 else []
        while len(found) < _MOST_POINTS:
            nearer = np.minimum(away, _distance(likely, likely[found]))
            farthest = int(np.argmax(nearer))
            if nearer[farthest] <= apart:
                break
            found.append(farthest)
        return self.at(likely[found])

    def at(self, new: Array) -> "KnownRatios":
        """Add interfaces (points)."""
        if not len(new):
            return self
        works, gaps = np.exp(new * LENGTHS).T
        tests = self.tests
        rigid = tests.forward.pulled(works[:, None], gaps[:, None], tests.speed, tests.load)
        low = rigid.effective_tabor < GOOD_TABOR
        low |= (_length(tests.forward, works) / gaps < _CHEAP_TABOR)[:, None] | bool(tests.moves)
        log_ratio = np.full(low.shape, np.nan)
        simulated = np.zeros(low.shape, dtype=bool)
        problems: dict[tuple[int, int], Problem] = {}
        for n, (work, gap) in enumerate(zip(works, gaps, strict=True)):
            # of a low Tabor number, or where the theory does not hold
            some = self._problems(work, gap, np.flatnonzero(low[n]))
            others = np.setdiff1d(np.arange(low.shape[1]), list(some))
            log_ratio[n, others], poor = self._by_theory(work, gap, others)
            some |= self._problems(work, gap, poor[~low[n, poor]])
            problems |= {(n, test): problem for test, problem in some.items()}
        if problems:
            at = tuple(np.array(list(problems)).T)
            log_ratio[at] = np.log(self.runs.forces(list(problems.values())) / rigid.force[at])
            simulated[at] = True
        return replace(
            self,
            points=np.concatenate([self.points, new]),
            log_ratio=np.concatenate([self.log_ratio, log_ratio]),
            simulated=np.concatenate([self.simulated, simulated]),
        )

    def _by_theory(
        self, work: float, gap: float, which: npt.NDArray[np.intp]
    ) -> tuple[Array, npt.NDArray[np.intp]]:
        """Return ln(ratio) of some tests by theory, and those for which it does not hold."""
        some, none = self.tests.some(which), np.full(which.size, np.nan)
        if not which.size:
            return none, which
        try:
            changed = some.changed(Interface(work, gap))
        except InputError:  # strains too large
            return none, which
        return np.where(changed.holds, np.log(changed.ratio), np.nan), which[_beyond(changed)]

    def _problems(self, work: float, gap: float, which: npt.NDArray[np.intp]) -> dict[int, Problem]:
        """Return the problems of some tests, without those that cannot be simulated."""
        tests = self.tests
        most = _MOVED_TABOR if tests.moves else _MOST_TABOR
        found = {}
        with suppress(InputError):  # strains too large
            for test in map(int, which):
                load, speed = float(tests.load[test]), float(tests.speed[test])
                moves = tests.moves[test] if tests.moves else ()
                problem = tests.forward.problem(
                    work, gap, load, speed, stiffness=tests.stiffness, moves=moves
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


def with_simulations(
    search: Search, changed: Changed, runs: Simulations
) -> tuple[Search, npt.NDArray[np.str_]]:
    """Simulate the tests at which the theory does not hold, for the likely interfaces.

    The likely interfaces are found with a large error for these tests, then with that of the
    interpolated simulations, until all of them have a simulated interface nearby.

    Parameters
    ----------
    search : Search
        Search by theory.
    changed : Changed
        Ratios of the tests by theory for the most likely interface.
    runs : Simulations
        Simulations.

    Returns
    -------
    search : Search
        Search over all tests.
    refused : ndarray of str
        Reason why a test has no force; empty where it has one.
    """
    series, tests, theory = search.series, search.tests, search.ratio
    assert isinstance(theory, Yielding), "nothing is simulated yet"
    answered = np.full(series.speed.size, "")
    simulated = _beyond(changed)
    by_theory = ModelError.of_theory(series.theory_error, series.speed.size)
    material = search.spread - (series.noise + by_theory.covariance(series.speed))
    known = KnownRatios.none(tests, runs)
    error, apart, bent = np.full(series.speed.size, _UNKNOWN), _APART, 0.0
    for _ in range(_ROUNDS):
        points = search.likely(_LIKELY)
        more = simulated | _low(tests, points)
        if not more.any():
            return search, answered
        begins = bool(np.any(more != simulated)) or not len(known.points)
        if begins:
            simulated = more
            model = _model(simulated, series.theory_error, error)
            spread = series.noise + model.covariance(series.speed) + material
            search = replace(search, spread=spread + bent**2)
            points = search.likely(_LIKELY)
            earlier = known.points
            known = KnownRatios.none(tests.some(simulated), runs).at(earlier)
        likely, count = points / LENGTHS, len(known.points)
        known = known.over(likely, apart)
        if len(known.points) == count and not begins:
            break
        if known.unanswered.any():
            lost = np.zeros(simulated.size, dtype=bool)
            lost[simulated] = known.unanswered
            reasons = np.where(changed.holds, _TOO_LARGE, changed.refused)
            return search, np.where(lost, reasons, "")
        error[simulated] = known.error(likely)
        work, gap = np.exp(points[0])
        # zero of measured forces
        bent = min(_BENT / (_length(search.forward, work) / gap) ** 2, _MOST_BENT)
        near = simulated.copy()
        near[simulated] = known.by_simulation(work, gap)
        model = _model(near, series.theory_error, error)
        search = replace(
            search,
            model=model,
            ratio=Mixed(theory, np.flatnonzero(simulated), known.ratio()),
            spread=series.noise + model.covariance(series.speed) + material + bent**2,
        )
        apart *= _CLOSER if model.simulation.max() > _WANTED else 1.0
    return search, answered


class Tested(NamedTuple):
    """Ratios of forces of tests that were not measured, with interfaces that are known.

    Attributes
    ----------
    ratio : ndarray, shape (M, n)
        Ratio of the force to that of a relaxed contact and a rigid machine by theory, for each
        interface but the first; shape (n,) if it is the same for all.
    model : ModelError
        Relative errors of the forces.
    simulations : int
        Number of simulations.
    """

    ratio: Array
    model: ModelError
    simulations: int = 0


def by_theory(changed: Changed, speed: Array, theory: float) -> Tested:
    """Return ratios by theory alone.

    Raises
    ------
    OutOfRange
        If the theory does not hold for a test.
    """
    for i in np.flatnonzero(~changed.holds):
        raise _refusal(speed[i], changed.refused[i])
    return Tested(changed.ratio, ModelError.of_theory(theory, speed.size))


def _refusal(speed: float, reason: str) -> OutOfRange:
    return OutOfRange(f"at {readable(speed, 'm/s', digits=3)}: {reason}")


def tested(interfaces: Array, changed: Changed, tests: SphereTests, theory: float) -> Tested:
    """Simulate tests at which the theory does not hold, for interfaces of a posterior.

    Tests at many speeds are simulated at some and interpolated between.

    Parameters
    ----------
    interfaces : ndarray, shape (M, 2)
        ln of work and range, the most likely first.
    changed : Changed
        Ratios by theory for the most likely.
    tests : SphereTests
        The tests.
    theory : float
        Relative error of the theory.

    Raises
    ------
    OutOfRange
        If neither theory nor simulation has the force of a test.
    """
    which = _beyond(changed) | _low(tests, interfaces[::_THINNED])
    if not which.any():
        return by_theory(changed, tests.speed, theory)
    likely, some = interfaces / LENGTHS, tests.some(which)
    nodes = some
    if some.speed.size > _NODES:
        nodes = some.at(np.geomspace(some.speed.min(), some.speed.max(), _NODES))
    with Simulations() as runs:
        found, apart = KnownRatios.none(nodes, runs).over(likely, _APART), _APART
        for _ in range(_ROUNDS):
            if found.unanswered.any():
                by_theory(changed, tests.speed, theory)
                raise _refusal(some.speed[0], _TOO_LARGE)
            if found.error(likely).max() <= _WANTED:
                break
            apart *= _CLOSER
            found = found.over(likely, apart)
        known, error = found.ratio().at(likely), found.error(likely)
        simulated = found.by_simulation(*np.exp(interfaces[0])).astype(float)
        if nodes is not some:
            x, at = np.log(some.speed), np.log(nodes.speed)
            # held out: the most likely interface between the nodes
            middle = nodes.at(np.sqrt(nodes.speed[1:] * nodes.speed[:-1]))
            held = KnownRatios.none(middle, runs).at(likely[:1]).log_ratio[0]
            away = held - CubicSpline(at, np.log(known[0]))(np.log(middle.speed))
            known = np.exp(CubicSpline(at, np.log(known), axis=1)(x))
            error = np.hypot(np.interp(x, at, error), np.sqrt(np.nanmean(away**2)))
            simulated = np.interp(x, at, simulated)
    ratio = np.tile(changed.ratio, (len(known) - 1, 1))
    ratio[:, which] = known[1:]
    errors, by_simulation = np.zeros(which.size), which.copy()
    errors[which], by_simulation[which] = error, simulated > 0
    return Tested(ratio, _model(by_simulation, theory, errors), runs.count)


def _beyond(changed: Changed) -> npt.NDArray[np.bool_]:
    """Whether the theory does not hold for a test within its stated error, shape (S,)."""
    return (changed.band > _BAND) | ~changed.holds


def _low(tests: SphereTests, points: Array) -> npt.NDArray[np.bool_]:
    """Whether the effective Tabor number of each test is low at one of the points, shape (S,)."""
    work, gap = np.exp(points).T
    pulled = tests.forward.pulled(work[:, None], gap[:, None], tests.speed, tests.load, _RADII)
    return np.any(pulled.effective_tabor < GOOD_TABOR, axis=0) | bool(tests.moves)


def _length(forward: Forward, work: Any) -> Any:
    """Return the range of attraction at a Tabor number of 1 [m]."""
    return (forward.radius * (work / forward.material.contact_modulus) ** 2) ** (1 / 3)


def _model(simulated: npt.NDArray[np.bool_], theory: float, error: Array) -> ModelError:
    """Return the errors of tests, some of them simulated."""
    return ModelError(np.where(simulated, 0.0, theory), np.where(simulated, error, 0.0))


def _distance(points: Array, others: Array) -> Array:
    """Return the distance of each point from the nearest other, shape (N,)."""
    if not len(others):
        return np.full(len(points), np.inf)
    return np.linalg.norm(points[:, None] - others, axis=-1).min(axis=1)
