r"""Ratios of pull-off forces to those of a relaxed contact and a rigid machine by theory.

Tables of forces (:mod:`.search`) are for relaxed contacts and rigid machines. While
the tension grows, a compliant machine stretches, so the sphere moves more slowly than the drive.
The logarithm of this ratio is nearly proportional to the compliance, so its product with the
relative uncertainty of the compliance is an error common to all forces.

Where the theory does not hold for a test, its ratio is computed at interfaces spread over the
likely ones, each by simulation or, where the theory holds, by theory (:class:`KnownRatios`), and
interpolated by a Gaussian process in :math:`x = (\ln w, \ln h_0)`, scaled, with the covariance

.. math:: k(x, y) = a^2 + b^2\, x\cdot y + c^2 e^{-|x - y|^2/2} ,

a plane with a smooth deviation from it. Its error is that of each point when it is left out
(Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), Eq. 5.12).

The interfaces are added until all likely ones have one nearby and the interpolation between them is
good (:func:`with_simulations`). A forecast does the same for tests that were not measured
(:func:`tested`), with the interfaces of the posterior.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.arrays import Array
from viscotack.clock import limited, met
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Problem
from viscotack.result.observables import pull_off_force
from viscotack.system import Processes, begin_worker
from viscotack.units import readable

from .computed import Computed, packaged
from .covariances import ModelError, SphereTests
from .forward import Changed, Forward, Interface

if TYPE_CHECKING:
    from .search import Search

ACCURACY = 5e-3
_WORKERS = 2
_FEW = 40  # cases up to which no process is started, because that takes longer
_LONGEST = 60.0  # time of a simulation [s]


class Simulations:
    """Pull-off forces of problems by simulation; no problem is simulated twice.

    A context manager: worker processes begin with the first large batch and end with the block.
    """

    def __init__(self, computed: Computed | None = None) -> None:
        self._pool: Processes | None = None
        self._computed = Computed() if computed is None else computed
        self._known: dict[Problem, float] = {}

    def __enter__(self) -> Simulations:
        return self

    def __exit__(self, kind: Any, *_: object) -> None:
        if self._pool is not None:
            self._pool.kill() if kind is not None else self._pool.shutdown()

    @property
    def count(self) -> int:
        """Number of simulated problems."""
        return len(self._known)

    def forces(self, problems: Sequence[Problem]) -> Array:
        """Return the pull-off forces [N], nan where a simulation ends without one."""
        if new := [one for one in dict.fromkeys(problems) if one not in self._known]:
            kept = packaged(new[0].material)
            compute = partial(self._simulated, new, known_to_workers=kept)
            found = self._computed.of((ACCURACY, new), compute) if kept else compute()
            self._known |= dict(zip(new, found["force"].tolist(), strict=True))
        return np.array([self._known[one] for one in problems])

    def _simulated(self, problems: Sequence[Problem], known_to_workers: bool) -> dict[str, Array]:
        forces = map(_force, problems)
        if len(problems) > _FEW and known_to_workers:
            self._pool = self._pool or Processes(_WORKERS, begin_worker, ())
            forces = self._pool.map(_force, problems)
        found = []
        for force in forces:
            if limit := met():  # that of the caller
                raise InputError(f"{limit} while tests were simulated; give more time")
            found.append(force)
        return {"force": np.array(found)}


def _force(problem: Problem) -> float:
    # imported on first use, because most series need no simulation
    from viscotack.simulate import SimulationError, solve

    with suppress(InputError, SimulationError), limited(_LONGEST):
        found = solve(problem, until="pull-off", accuracy=ACCURACY, estimate_error=False)
        return pull_off_force(found) * problem.scales().force
    return np.nan


GOOD_TABOR = 5.0  # effective: from it the theory is within its stated error
# Largest Tabor numbers that are simulated, from rest and after an approach.
_MOST_TABOR, _MOVED_TABOR = 100.0, 30.0
# Up to it a test whose force is simulated for some interfaces is simulated for all.
_CHEAP_TABOR = 40.0
_BAND = 0.033  # largest band of a good theory: 1.645 times its stated error
_MOST_POINTS = 10  # most interfaces that are added at a time
_NEAR = 1.0  # distance of an interface from the likely ones up to which its error counts
# |ln ratio| above which derivatives are computed, and steps in ln of work and range.
_FAR, _WORK, _GAP = 0.1, 0.1, -0.3
# Lengths in ln of work and range over which the deviation from a plane changes.
LENGTHS = np.array([0.5, 1.2])
# Standard deviations of ln(ratio): constant, slopes, deviation, and scatter of single values.
_CONSTANT, _SLOPE, _DEVIATION, _SCATTER = 0.5, 0.3, 0.1, 1e-3


@dataclass(frozen=True, eq=False)
class ForceRatios:
    """Ratios of the forces of all tests, with a compliant machine and by simulation.

    Parameters
    ----------
    log_ratio : ndarray, shape (S,)
        ln of the ratio at the reference interface; of tests without an answer by theory that of the
        nearest speeds with one.
    slopes : ndarray, shape (2, S)
        Derivatives with respect to ln of the work of adhesion and of the range.
    work, gap : float
        Reference interface [J/m2] and [m].
    known : KnownRatios, optional
        Ratios that are interpolated between interfaces.
    which : tuple of int
        Indices of these tests.
    """

    log_ratio: Array
    slopes: Array
    work: float = 1.0
    gap: float = 1.0
    known: KnownRatios | None = None
    which: tuple[int, ...] = ()

    def __call__(self, values: Mapping[str, Any]) -> Array:
        """Return the ratios of one interface, shape (S,), or of many, shape (N, S)."""
        if self.known is None and not self.slopes.any():
            shape = (*np.shape(values["work_of_adhesion"]), self.log_ratio.size)
            return np.broadcast_to(np.exp(self.log_ratio), shape)
        work, gap = (np.asarray(values[x]) for x in ("work_of_adhesion", "equilibrium_gap"))
        away = np.stack([np.log(work / self.work), np.log(gap / self.gap)], axis=-1)
        found = np.exp(self.log_ratio + away @ self.slopes)
        if self.known is not None:
            x = scaled(work, gap)
            ratio = self.known.at(x.reshape(-1, 2))
            found[..., list(self.which)] = ratio.reshape(*x.shape[:-1], -1)
        return found


def yielding_near(tests: SphereTests, interface: Interface) -> tuple[ForceRatios, Changed]:
    """Compute the effect of the machine near an interface, and at the interface."""
    tests = tests._replace(moves=())
    speed, (work, gap, growth) = tests.speed, interface

    def log_ratio(w: float, h0: float) -> tuple[Array, Changed]:
        found = tests.changed(Interface(w, h0, growth))
        return np.log(found.ratio), found

    middle, changed = log_ratio(work, gap)
    slopes = np.zeros((2, speed.size))
    if np.max(np.abs(middle)) > _FAR:
        beside = (work * np.exp(_WORK), gap), (work, gap * np.exp(_GAP))
        for row, at, step in zip(slopes, beside, (_WORK, _GAP), strict=True):
            other, there = log_ratio(*at)
            row[there.holds] = (other - middle)[there.holds] / step
    told = [i for i in np.argsort(speed) if changed.holds[i]]
    if told:
        middle = np.interp(np.log(speed), np.log(speed[told]), middle[told])
    return ForceRatios(middle, slopes, work, gap), changed


def scaled(work: Any, gap: Any) -> Array:
    """Return interfaces as points, shape (..., 2), from work [J/m2] and range [m]."""
    return np.stack([np.log(work), np.log(gap)], axis=-1) / LENGTHS


def _kernel(x: Array, y: Array) -> Array:
    square = np.sum((x[..., :, None, :] - y) ** 2, axis=-1)
    return _CONSTANT**2 + _SLOPE**2 * x @ y.T + _DEVIATION**2 * np.exp(-square / 2)


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
        Interfaces, as of :func:`scaled`.
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
    def none(cls, tests: SphereTests, runs: Simulations) -> KnownRatios:
        """Return the ratios at no interface."""
        empty = np.empty((0, tests.speed.size))
        return cls(tests, runs, np.empty((0, 2)), empty, empty.astype(bool))

    def over(self, likely: Array, apart: float) -> KnownRatios:
        """Add interfaces, until all likely ones (points) have one nearby.

        They are the farthest from those known and from each other, the first likely one first.
        """
        away = distance(likely, self.points)
        found = [0] if away[0] > apart / 2 else []
        while len(found) < _MOST_POINTS:
            nearer = np.minimum(away, distance(likely, likely[found]))
            farthest = int(np.argmax(nearer))
            if nearer[farthest] <= apart:
                break
            found.append(farthest)
        return self.adding(likely[found])

    def adding(self, new: Array) -> KnownRatios:
        """Add interfaces (points)."""
        if not len(new):
            return self
        works, gaps = np.exp(new * LENGTHS).T
        tests = self.tests
        rigid = tests.forward.pulled(works[:, None], gaps[:, None], tests.speed, tests.load)
        low = rigid.effective_tabor < GOOD_TABOR
        low |= (length_of(tests.forward, works) / gaps < _CHEAP_TABOR)[:, None] | bool(tests.moves)
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
        return np.where(changed.holds, np.log(changed.ratio), np.nan), which[beyond(changed)]

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

    @cached_property
    def _weights(self) -> tuple[Array, Array]:
        """Weights of the points, and errors of ln(ratio) when each is left out, or nan."""
        near = self.points - self.points.mean(axis=0)
        weights = np.zeros(self.log_ratio.shape)
        left_out = np.full(self.log_ratio.shape, np.nan)
        for test, column in enumerate(self.log_ratio.T):
            at = np.flatnonzero(np.isfinite(column))
            inverse = np.linalg.inv(_kernel(near[at], near[at]) + _SCATTER**2 * np.eye(at.size))
            weights[at, test] = inverse @ column[at]
            left_out[at, test] = weights[at, test] / np.diag(inverse)
        return weights, left_out

    def at(self, points: Array) -> Array:
        """Return the interpolated ratios at points, shape (M, S)."""
        middle = self.points.mean(axis=0)
        return np.exp(_kernel(points - middle, self.points - middle) @ self._weights[0])

    def error(self, likely: Array) -> Array:
        """Return the relative standard error of the interpolation of each test, shape (S,).

        It is the root mean square over the likely interfaces, with the error of the simulation.
        """
        left_out = self._weights[1][distance(self.points, likely) < _NEAR]
        with np.errstate(invalid="ignore"):
            size = np.sqrt(np.nanmean(np.atleast_2d(left_out) ** 2, axis=0))
        return np.hypot(size, ACCURACY)

    def by_simulation(self, work: float, gap: float) -> npt.NDArray[np.bool_]:
        """Whether the force of each test is simulated near an interface, shape (S,)."""
        away = distance(self.points, scaled(work, gap)[None])
        return self.simulated[int(np.argmin(away))]


def beyond(changed: Changed) -> npt.NDArray[np.bool_]:
    """Whether the theory does not hold for a test within its stated error, shape (S,)."""
    return (changed.band > _BAND) | ~changed.holds


def length_of(forward: Forward, work: Any) -> Any:
    """Return the range of attraction at a Tabor number of 1 [m]."""
    return (forward.radius * (work / forward.material.contact_modulus) ** 2) ** (1 / 3)


def distance(points: Array, others: Array) -> Array:
    """Return the distance of each point from the nearest other, shape (N,)."""
    if not len(others):
        return np.full(len(points), np.inf)
    return np.linalg.norm(points[:, None] - others, axis=-1).min(axis=1)


_UNKNOWN = 0.15  # relative error of the theory where it does not hold
_LIKELY = 10.0  # misfit above the least of the interfaces at which simulations are
_ROUNDS = 6
# Distance between interfaces, and factor by which it falls while the error is above the wanted one.
_APART, _CLOSER, _WANTED = 0.6, 0.6, 0.01
_RADII = 40  # points of a curve for Tabor numbers
_NODES = 8  # largest number of speeds of a forecast that are simulated each
_THINNED = 4  # one of this many samples of a posterior serves for Tabor numbers
# Error common to all measured forces, whose zero is separated from attraction out of contact by a
# model: at a Tabor number of 1, and the largest one.
_BENT, _MOST_BENT = 0.02, 0.004

_TOO_LARGE = "the theory does not hold, and the Tabor number is too large to simulate"


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
    series, tests = search.series, search.tests
    answered = np.full(series.speed.size, "")
    simulated = beyond(changed)
    by_theory = ModelError.of_theory(series.theory_error, series.speed.size)
    material = search.spread - (series.noise + by_theory.covariance(series.speed))
    known = KnownRatios.none(tests, runs)
    error, apart, bent = np.full(series.speed.size, _UNKNOWN), _APART, 0.0

    def weighed(search: Search, simulated: npt.NDArray[np.bool_]) -> Search:
        """Return a search with the errors of its tests, some of them simulated."""
        model = _model(simulated, series.theory_error, error)
        spread = series.noise + model.covariance(series.speed) + material
        return replace(search, model=model, spread=spread + bent**2)

    for _ in range(_ROUNDS):
        points = search.likely(_LIKELY)
        more = simulated | _low(tests, points)
        if not more.any():
            return search, answered
        begins = bool(np.any(more != simulated)) or not len(known.points)
        if begins:
            simulated = more
            search = weighed(search, simulated)
            points = search.likely(_LIKELY)
            known = KnownRatios.none(tests.some(simulated), runs).adding(known.points)
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
        bent = min(_BENT / (length_of(search.forward, work) / gap) ** 2, _MOST_BENT)
        near = simulated.copy()
        near[simulated] = known.by_simulation(work, gap)
        ratio = replace(search.ratio, known=known, which=tuple(np.flatnonzero(simulated)))
        search = replace(weighed(search, near), ratio=ratio)
        apart *= _CLOSER if search.model.simulation.max() > _WANTED else 1.0
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
    which = beyond(changed) | _low(tests, interfaces[::_THINNED])
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
        known, error = found.at(likely), found.error(likely)
        simulated = found.by_simulation(*np.exp(interfaces[0])).astype(float)
        if nodes is not some:
            x, at = np.log(some.speed), np.log(nodes.speed)
            # held out: the most likely interface between the nodes
            middle = nodes.at(np.sqrt(nodes.speed[1:] * nodes.speed[:-1]))
            held = KnownRatios.none(middle, runs).adding(likely[:1]).log_ratio[0]
            away = held - CubicSpline(at, np.log(known[0]))(np.log(middle.speed))
            known = np.exp(CubicSpline(at, np.log(known), axis=1)(x))
            error = np.hypot(np.interp(x, at, error), np.sqrt(np.nanmean(away**2)))
            simulated = np.interp(x, at, simulated)
    ratio = np.tile(changed.ratio, (len(known) - 1, 1))
    ratio[:, which] = known[1:]
    errors, by_simulation = np.zeros(which.size), which.copy()
    errors[which], by_simulation[which] = error, simulated > 0
    return Tested(ratio, _model(by_simulation, theory, errors), runs.count)


def _low(tests: SphereTests, points: Array) -> npt.NDArray[np.bool_]:
    """Whether the effective Tabor number of each test is low at one of the points, shape (S,)."""
    work, gap = np.exp(points).T
    pulled = tests.forward.pulled(work[:, None], gap[:, None], tests.speed, tests.load, _RADII)
    return np.any(pulled.effective_tabor < GOOD_TABOR, axis=0) | bool(tests.moves)


def _model(simulated: npt.NDArray[np.bool_], theory: float, error: Array) -> ModelError:
    """Return the errors of tests, some of them simulated."""
    return ModelError(np.where(simulated, 0.0, theory), np.where(simulated, error, 0.0))
