"""Forces of tests for which the theory of a steady crack does not hold, by simulation.

Tables of forces (:mod:`.search`) are by theory. For tests at which it does not hold,
interfaces spread over the likely ones are simulated (:class:`.force_ratios.KnownRatios`), until
all likely ones have one nearby and the interpolation between them is good.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from viscotack.arrays import Array
from viscotack.errors import OutOfRange
from viscotack.units import readable

from .covariances import ModelError, SphereTests
from .force_ratios import GOOD_TABOR, LENGTHS, KnownRatios, Simulations, beyond, length_of
from .forward import Changed
from .search import Search

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
