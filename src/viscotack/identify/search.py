r"""Search for the interface in tables of pull-offs.

Without growth one table covers all unknowns. With growth a coarse table locates the likely
interfaces, and a fine table covers only these.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
import numpy.typing as npt
from scipy.optimize import root_scalar

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Passport
from viscotack.simulate.crack_contact.by_crack import LEAST_TABOR
from viscotack.theory.crack.contact.growing import LARGEST_ENERGY, lattice_spline

from .contact_time import PER_DECADE, FoundAgeing
from .covariances import TREND, ModelError, SphereTests, trend_covariance
from .force_ratios import ForceRatios
from .forward import EXPONENT, UNKNOWNS, Forward, Interface, Opening
from .likelihood import Best, Interval, Objective, Parameter, Posterior, posterior
from .pull_off import PullOff
from .rate_series import RateSeries

_AT_ONCE = 20_000  # points interpolated per batch


class Table:
    """Forces over the unknowns of an interface: splines in logarithms.

    Parameters
    ----------
    axes : mapping
        Unknown -> ascending values, at least four; the first is the work of adhesion.
    logs : ndarray, shape (values of each unknown, S, columns)
        ln of the force of each test, and of what else is interpolated.
    """

    def __init__(self, axes: Mapping[str, Array], logs: Array) -> None:
        self.axes = dict(axes)
        self._spline = lattice_spline([_inner(name, x) for name, x in self.axes.items()], logs)

    @classmethod
    def of_cracks(
        cls,
        forward: Forward,
        speed: Array,
        preload: Array,
        axes: Mapping[str, Array],
        *,
        opening: Opening | None = None,
        travels: bool = False,
        radii: int = 160,
    ) -> "Table":
        """Return the pull-off forces of a steady crack at the edge.

        Parameters
        ----------
        forward : Forward
            Forward model of the material.
        speed, preload : ndarray, shape (S,)
            Speeds [m/s] and preloads [N] of the series.
        axes : mapping
            Values of "work_of_adhesion" and "equilibrium_gap", with growth also of "strengthening"
            and "exponent".
        opening : Opening, optional
            Opening speed at which the strengthening is defined.
        travels : bool
            Whether to interpolate the travels between forces as well.
        radii : int
            Number of points of a curve.
        """
        values = lattice(axes)
        growth = None if opening is None else opening.growth(values)
        work, gap = values["work_of_adhesion"], values["equilibrium_gap"]
        found = forward.pulled(work, gap, speed, preload, radii, growth)
        columns = [np.log(found.force)[..., None], np.log(found.effective_tabor)[..., None]]
        if travels:
            # travels exist only for starts in compression
            columns.append(np.log(found.travels))
        return cls(axes, np.concatenate(columns, axis=-1))

    def at(self, values: Mapping[str, float], grown: Array | None = None) -> Array:
        """Return columns of force [N], effective Tabor number and travels [m], a row for each test.

        The work of adhesion of each test is `grown` times as large.
        """
        point = np.array([_inner(name, values[name]) for name in self.axes])
        if grown is None:
            return np.exp(self._spline(point))
        factors, at = np.unique(grown, return_inverse=True)
        works = point[0] + np.log(factors)
        points = np.tile(point, (factors.size, 1))
        points[:, 0] = np.clip(works, *np.log(self.axes["work_of_adhesion"][[0, -1]]))
        found = self._spline(points)
        # beyond the table forces are proportional to the work
        found[..., 0] += (works - points[:, 0])[:, None]
        return np.exp(found[at, np.arange(at.size)])

    def forces(self, points: Array) -> Array:
        """Return forces of many interfaces, shape (N, S), at points of :meth:`dense`."""
        parts = [
            self._spline(points[i : i + _AT_ONCE])[..., 0] for i in range(0, len(points), _AT_ONCE)
        ]
        return np.exp(np.concatenate(parts))

    def dense(self, times: int) -> Array:
        """Return points of a finer lattice, in search coordinates."""
        axes = []
        for name, x in self.axes.items():
            place = np.linspace(0, x.size - 1, times * (x.size - 1) + 1)
            axes.append(np.interp(place, np.arange(x.size), _inner(name, x)))
        return np.stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")], axis=1)


def lattice(axes: Mapping[str, Array]) -> dict[str, Array]:
    """Return the values of each unknown at all points of a lattice, with a last axis of one."""
    points = np.meshgrid(*axes.values(), indexing="ij")
    return {name: x[..., None] for name, x in zip(axes, points, strict=True)}


def _inner(name: str, value: Any) -> Any:
    """Return the search coordinate of an unknown: its logarithm if positive."""
    return np.asarray(value, dtype=float) if name == EXPONENT else np.log(value)


_APART = 3.0  # standard deviations from the force that the other tests give
_LOUD = 2.0  # residuals over their uncertainty above which no such interface fits the forces
_WORKS, _GAPS = 8, 21  # works per decade, and number of ranges, of the table without growth
# Steps of work, range, strengthening and exponent of the coarse table, in search
# coordinates; points of a curve, and number of pull-offs used.
_COARSE, _COARSE_RADII, _COARSE_SPEEDS = (0.57, 0.57, 0.5, 0.2), 40, 6
# The same for the fine table, with all pull-offs.
_FINE, _FINE_RADII = (0.29, 0.46, 0.4, 0.15), 80
_BETWEEN, _CLOSE = (1e-3, 1.0), 0.05  # searched scatters between speeds, relative accuracy
# Smallest number of speeds that show a trend, and -2 ln(likelihood) by which it must be better.
_TREND_SPEEDS, _PREFERRED = 3, 2.0
_FEWEST = 5  # smallest number of values of an unknown
# Parts of the range at which a search without growth starts.
_STARTS = (0.1, 0.3, 0.5, 0.7, 0.9)
# With growth: number of starts, their distance over the span of the table, and points looked at.
_SEPARATE, _SHARE, _LOOKED = 4, 0.2, 2000
# Refinement of the coarse table for the search, and misfits above the minimum that are kept
# at first, and where an interval needs more.
_DENSE, _KEPT = 3, (30.0, 150.0)
# Largest change of the work with the time in contact, over that after the middle time.
_MOST_GROWN = 0.9
# Refinement of the table without growth for a list of likely interfaces, and its longest length.
_LIKELY, _MOST_LIKELY = 4, 300


@dataclass(frozen=True, eq=False)
class Search:
    """A table of pull-offs and the series it is compared with.

    Parameters
    ----------
    series : RateSeries
        Measured pull-offs.
    forward : Forward
        Forward model, with cracks that grow if growth is fitted.
    table : Table
        Forces of relaxed contacts with a rigid machine, by theory.
    spread : ndarray, shape (S, S)
        Covariance of the relative forces.
    ratio : ForceRatios
        Ratios of the forces to those of the table.
    model : ModelError
        Error of the forces, included in the covariance.
    opening : Opening, optional
        Opening speed at which a strengthening is defined.
    some : ndarray of int, optional
        Pull-offs in the table; by default all.
    """

    series: RateSeries
    forward: Forward
    table: Table
    spread: Array
    ratio: ForceRatios
    model: ModelError
    opening: Opening | None = None
    some: npt.NDArray[np.intp] | None = None

    @classmethod
    def begun(cls, forward: Forward, series: RateSeries, least: float = LEAST_TABOR) -> Self:
        """Return a search without growth or machine, down to an effective Tabor number."""
        works = _works(series, 1 / forward.material.modulus_ratio, _WORKS)
        ranges = np.geomspace(*series.gaps, _GAPS)
        # ranges valid for the largest work of adhesion; smaller ones are checked after the fit
        at = forward.pulled(works[-1], ranges[:, None], series.speed, series.load).effective_tabor
        holds = np.all(at >= least, axis=-1)
        count = int(np.argmin(holds)) if not holds.all() else holds.size
        if count < _FEWEST:
            raise InputError(
                f"the cohesive zone is as large as the contact at ranges from {series.gaps[0]:.3g} "
                f"to {series.gaps[1]:.3g} m: search smaller ones, or simulate"
            )
        axes = {"work_of_adhesion": works, "equilibrium_gap": ranges[:count]}
        table = Table.of_cracks(forward, series.speed, series.load, axes, travels=series.curves)
        return cls.of(series, forward, table)

    @classmethod
    def of(cls, series: RateSeries, forward: Forward, table: Table) -> Self:
        """Return a search in a table by theory for the machine of the table."""
        model = ModelError.of_theory(series.theory_error, series.speed.size)
        spread = series.noise + model.covariance(series.speed)
        # of a rigid machine
        rigid = ForceRatios(np.zeros(series.speed.size), np.zeros((2, series.speed.size)))
        return cls(series, forward, table, spread, rigid, model)

    @property
    def white(self) -> Array:
        """Matrix that makes the residuals independent with unit variance."""
        at = slice(None) if self.some is None else np.ix_(self.some, self.some)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(self.spread[at])), dtype=np.float64)

    @property
    def objective(self) -> Objective:
        """Objective function over the parameters of the table."""
        table, white = self.table, self.white
        shapes = _shapes(self.series) if self.series.curves and self.some is None else None

        def residuals(values: Mapping[str, float]) -> Array:
            found = table.at(values, self.grown(values))
            rest = white @ self._relative(found[:, 0], values)
            return rest if shapes is None else np.concatenate([rest, shapes(found[:, 2:])])

        return Objective(residuals, self.parameters)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The unknowns, bounded by the ends of the table."""
        found = []
        for name, axis in self.table.axes.items():
            low, high = float(axis[0]), float(axis[-1])
            if name == EXPONENT:
                found.append(Parameter(name, low, high, (low + high) / 2, logarithmic=False))
                continue
            prior = self.series.prior if name == "work_of_adhesion" else None
            found.append(Parameter(name, low, high, float(np.sqrt(low * high)), prior=prior))
        if self.series.decades is not None:
            most = _MOST_GROWN / float(np.abs(self.series.decades).max())
            found.append(Parameter(PER_DECADE, -most, most, 0.0, logarithmic=False))
        return tuple(found)

    def grown(self, values: Mapping[str, Any]) -> Array | None:
        """Return the work of adhesion after each time in contact over that after the middle one."""
        if self.decades is None:
            return None
        return 1 + np.asarray(values[PER_DECADE]) * self.decades

    @property
    def decades(self) -> Array | None:
        """Decades from the middle time in contact to that of each pull-off in the table."""
        known = self.series.decades
        return known if known is None or self.some is None else known[self.some]

    @property
    def tests(self) -> SphereTests:
        """The measured tests."""
        one = self.series
        return SphereTests(
            self.forward, one.passport, one.speed, one.load, one.stiffness, one.moves
        )

    def interface(self, values: Mapping[str, Any]) -> Interface:
        """Return the interface of some parameters, or interfaces of arrays."""
        growth = None if self.opening is None else self.opening.growth(values)
        return Interface(values["work_of_adhesion"], values["equilibrium_gap"], growth)

    def best(self) -> Best:
        """Return the best fit from several starts."""
        objective = self.objective
        if self.opening is None:
            return objective.best_along(self.parameters[1], _STARTS)
        # from the most likely points that are separate from each other
        points, misfits = self.scanned(1)
        span = np.ptp(points, axis=0)
        found: list[Array] = []
        for x in points[np.argsort(misfits)[:_LOOKED]]:
            if all(np.max(np.abs(x - other) / span) > _SHARE for other in found):
                found.append(x)
            if len(found) == _SEPARATE:
                break
        fits = (objective.best(near=Best(self._values(x), 0.0, 0)) for x in found)
        return min(fits, key=lambda best: best.misfit)

    def intervals(self, best: Best, level: float) -> dict[str, Interval]:
        """Return the intervals of all unknowns."""
        objective = self.objective
        return {one.name: objective.interval(one.name, best, level) for one in self.parameters}

    def likely(self, above: float) -> Array:
        """Return interfaces with a misfit up to `above` the least, as ln of work and range.

        The most likely is first, and their number is limited.
        """
        points, misfits = self.scanned(_LIKELY)
        order = np.argsort(misfits)
        near = order[: np.count_nonzero(misfits <= misfits[order[0]] + above)]
        return points[near[np.unique(np.linspace(0, near.size - 1, _MOST_LIKELY).astype(int))]]

    def scanned(self, times: int) -> tuple[Array, Array]:
        """Return points of a refined lattice, in search coordinates, and their misfits."""
        points, white, decades = self.table.dense(times), self.white, self.decades
        rest = self._relative(self.table.forces(points), self._values(points.T)) @ white.T
        if decades is not None and decades.any():
            # with the growth in time that fits each best, forces being proportional to the work
            along = white @ decades / np.linalg.norm(white @ decades)
            rest = rest - np.outer(rest @ along, along)
        misfits = np.sum(rest**2, axis=1)
        if self.series.prior is not None:
            value, relative = self.series.prior
            misfits += ((points[:, 0] - np.log(value)) / relative) ** 2
        return points, misfits

    def _values(self, inner: Array) -> dict[str, Any]:
        """Return the parameters by name from search coordinates."""
        # a point of the table has no growth in time, which is the last parameter
        rows = zip(self.parameters, inner, strict=False)
        return {PER_DECADE: 0.0} | {one.name: one.outer(x) for one, x in rows}

    def _relative(self, forces: Array, values: Mapping[str, Any]) -> Array:
        """Return relative residuals of forces by theory, corrected to those of the tests."""
        some = slice(None) if self.some is None else self.some
        return forces * self.ratio(values)[..., some] / self.series.force[some] - 1


def _works(series: RateSeries, energy: float, per_decade: float) -> Array:
    """Return the works of adhesion of a table, for edges of at most an energy [works of it]."""
    most, span = series.largest_work, 2.0 * energy
    return np.geomspace(most / span, most, 3 + round(per_decade * float(np.log10(span))))


def widely(forward: Forward, plain: Search, opening: Opening) -> Search:
    """Return a coarse search over all unknowns, with evenly chosen pull-offs."""
    series, ranges = plain.series, plain.table.axes["equilibrium_gap"]
    order, size = np.argsort(series.speed, kind="stable"), series.speed.size
    chosen = np.linspace(0, size - 1, min(_COARSE_SPEEDS, size)).round().astype(int)
    some = order[np.unique(chosen)]
    works, gaps, *steps = _COARSE
    ends = np.log(ranges[[0, -1]])
    energy = min(UNKNOWNS[0].high / forward.material.modulus_ratio, LARGEST_ENERGY)
    axes = {
        "work_of_adhesion": _works(series, energy, np.log(10) / works),
        "equilibrium_gap": np.exp(_spaced(float(ends[0]), float(ends[1]), gaps)),
    }
    for one, step in zip(UNKNOWNS, steps, strict=True):
        axes[one.name] = one.outer(_spaced(one.inner(one.low), one.inner(one.high), step))
    case = series.speed[some], series.load[some], axes
    table = Table.of_cracks(forward, *case, opening=opening, radii=_COARSE_RADII)
    return replace(plain, forward=forward, table=table, opening=opening, some=some)


@dataclass(frozen=True, eq=False)
class Settled:
    """A search with the scatter between speeds that its residuals need.

    Parameters
    ----------
    search : Search
        Search with that scatter in its covariance.
    best : Best
        Its best fit.
    scatter : float
        Root mean square of the residuals over their uncertainty, without that scatter.
    between_speeds : float
        Relative scatter from speed to speed beyond that of repeated tests and theory.
    trend : bool
        Whether most of its variance is an error that follows a power of the speed.
    unexplained : tuple of int
        Tests whose force differs by more than three standard deviations from that which a fit to
        the others gives, without that scatter.
    """

    search: Search
    best: Best
    scatter: float
    between_speeds: float
    trend: bool
    unexplained: tuple[int, ...]

    @property
    def surprise(self) -> float:
        """-2 ln(likelihood) at the best fit, up to a constant."""
        return self.best.misfit + float(np.linalg.slogdet(self.search.spread)[1])


@dataclass(frozen=True, eq=False)
class SeriesFit(Settled):
    """Unknowns fitted to a rate series.

    Parameters
    ----------
    solutions : tuple of Best
        Separate solutions that fit the forces, the most likely first; mostly one.
    intervals : dict of str to Interval
        Profile likelihood intervals of the unknowns.
    """

    solutions: tuple[Best, ...]
    intervals: dict[str, Interval]

    @classmethod
    def of(cls, found: Settled, intervals: dict[str, Interval] | None = None, **more: Any) -> Self:
        """Return a fit with all its solutions; intervals are those of the most likely one."""
        search, level = found.search, found.search.series.level
        intervals = intervals or search.intervals(found.best, level)
        several = search.objective.solutions(found.best, intervals, level)
        if several[0].misfit < found.best.misfit:
            found = replace(found, best=several[0])
            intervals = search.intervals(found.best, level)
        return cls(**vars(found), solutions=several, intervals=intervals, **more)

    @property
    def given(self) -> RateSeries:
        """The fitted tests, with material, machine and assumptions."""
        return self.search.series

    @property
    def series(self) -> tuple[PullOff, ...]:
        """The fitted tests."""
        return tuple(self.given.tests)

    @property
    def passport(self) -> Passport:
        """Passport of the material."""
        return self.given.passport

    @property
    def level(self) -> float:
        """Confidence level of the intervals."""
        return self.given.level

    @property
    def work_of_adhesion(self) -> float:
        """Most likely work of adhesion [J/m2]."""
        return self.best.values["work_of_adhesion"]

    @cached_property
    def forces(self) -> tuple[float, ...]:
        """Pull-off forces of the most likely parameters at the measured speeds [N]."""
        search, values = self.search, self.best.values
        found = search.table.at(values, search.grown(values))[:, 0] * search.ratio(values)
        return tuple(found.tolist())

    @property
    def objective(self) -> Objective:
        """Objective function, for profiles and sampling."""
        return self.search.objective

    @cached_property
    def ageing(self) -> FoundAgeing | None:
        """Growth with the time in contact, if the tests determine it."""
        objective = self.objective
        if self.given.decades is None:
            return None
        without = objective.best({PER_DECADE: 0.0}, self.best)
        covariance = objective.covariance(self.best)
        deviation = np.sqrt(np.diag(covariance))
        correlation = covariance[-1] / (deviation * deviation[-1])
        names = [one.name for one in objective.parameters[:-1]]
        better = max(without.misfit - self.best.misfit, 0.0)
        return FoundAgeing(better, dict(zip(names, correlation[:-1].tolist(), strict=True)))

    def sampled(self, seed: int = 0) -> Posterior:
        """Sample the unknowns from the posterior, of all solutions."""
        return posterior(self.objective, self.best, others=self.solutions[1:], seed=seed)

    @property
    def criterion(self) -> float:
        """Bayesian information criterion, -2 ln L + k ln n; smaller is better."""
        unknowns = len(self.best.values) + (self.between_speeds > 0)
        return self.surprise + unknowns * float(np.log(len(self.series)))

    @property
    def describes_tests(self) -> bool:
        """Whether residuals are as large as noise and theory let them be."""
        return self.scatter <= _LOUD


def settled(search: Search) -> Settled:
    """Add the scatter between speeds with which residuals are as large as expected.

    This is the estimate of Paule and Mandel (1982), doi:10.6028/jres.087.022: at the best fit for
    that scatter, the sum of squares of the residuals equals the degrees of freedom. Forces may
    also depart from the model systematically, so a scatter with a trend is used where the data
    clearly prefer it.
    """
    best = search.best()
    rest = search.objective.residuals(best.values)
    scatter = float(np.sqrt(np.sum(rest**2) / max(rest.size - len(best.values), 1)))
    first = Settled(search, best, scatter, 0.0, False, _unexplained(search, best))
    plain = _widened(first, trend=False)
    if not plain.between_speeds or np.unique(search.series.speed).size < _TREND_SPEEDS:
        return plain
    trend = _widened(first, trend=True)
    return trend if trend.surprise + _PREFERRED < plain.surprise else plain


def _unexplained(search: Search, best: Best) -> tuple[int, ...]:
    """Return the tests that those left do not explain, excluding the farthest one by one."""
    count, root = len(search.spread), np.linalg.cholesky(search.spread)
    off = root @ search.objective.residuals(best.values)[:count]
    slopes = root @ search.objective.slopes(best)[:count]
    left = list(range(count))
    while len(left) > slopes.shape[1] + 1:
        inverse, along = np.linalg.inv(search.spread[np.ix_(left, left)]), slopes[left]
        gain = inverse @ along
        # weights of the residuals that no change of the unknowns makes smaller
        weights = inverse - gain @ np.linalg.pinv(along.T @ gain) @ gain.T
        size = np.sqrt(np.maximum(np.diag(weights), 1e-6 * np.diag(inverse)))
        apart = np.abs(weights @ off[left]) / size
        if apart.max() < _APART:
            break
        del left[int(np.argmax(apart))]
    return tuple(sorted(set(range(count)) - set(left)))


def _widened(first: Settled, *, trend: bool) -> Settled:
    """Return a search with the scatter that its residuals need, with or without a trend."""
    search, best, speed = first.search, first.best, first.search.series.speed
    freedom = speed.size + (search.series.prior is not None) - len(best.values)
    if not search.series.curves:
        # forces alone at two speeds leave none, but a range at its bound may not fit them
        freedom = max(freedom, 1)

    def with_scatter(between: float) -> Search:
        # half of the variance is one departure of all tests at a speed, after several times
        more = between**2 * (np.eye(speed.size) + np.equal.outer(speed, speed)) / 2
        if trend:
            more = (1 - TREND) * more + trend_covariance(speed, speed, between)
        return replace(search, spread=search.spread + more)

    def excess(log_scatter: float) -> float:
        wider = with_scatter(float(np.exp(log_scatter))).objective
        forces = wider.residuals(wider.best(near=best).values)[: speed.size]
        return float(forces @ forces) - freedom

    low, high = (float(np.log(x)) for x in _BETWEEN)
    if freedom <= 0 or excess(low) <= 0:
        return first
    root = high if excess(high) >= 0 else root_scalar(excess, bracket=(low, high), xtol=_CLOSE).root
    between = float(np.exp(root))
    wider = with_scatter(between)
    found = wider.best()
    return replace(first, search=wider, best=found, between_speeds=between, trend=trend)


def closely(coarse: Search, level: float) -> tuple[Settled, dict[str, Interval]]:
    """Return a fine search near the likely interfaces, settled, and the intervals."""
    series, widest = coarse.series, {one.name: one for one in coarse.parameters}
    points, misfits = coarse.scanned(_DENSE)
    least = misfits.min()
    for kept in _KEPT:
        near = points[misfits < least + kept]
        axes = {}
        for i, (name, apart) in enumerate(zip(coarse.table.axes, _FINE, strict=True)):
            one, step = widest[name], np.diff(np.unique(points[:, i])).max()
            low = max(near[:, i].min() - step, one.inner(one.low))
            high = min(near[:, i].max() + step, one.inner(one.high))
            axes[name] = one.outer(_spaced(low, high, apart))
        case = coarse.forward, series.speed, series.load, axes
        how: dict[str, Any] = {"opening": coarse.opening, "travels": series.curves}
        table = Table.of_cracks(*case, **how, radii=_FINE_RADII)
        found = settled(replace(coarse, table=table, some=None))
        intervals = found.search.intervals(found.best, level)
        # an interval that ends at the edge of the table inside the search range is cut
        if not any(
            (not ends.closed_below and axes[name][0] > widest[name].low * (1 + 1e-9))
            or (not ends.closed_above and axes[name][-1] < widest[name].high * (1 - 1e-9))
            for name, ends in intervals.items()
            if name in axes
        ):
            break
    return found, intervals


def _spaced(low: float, high: float, apart: float) -> Array:
    """Return evenly spaced values with a largest distance, at least five."""
    return np.linspace(low, high, max(_FEWEST, 1 + int(np.ceil((high - low) / apart - 1e-9))))


def _shapes(series: RateSeries) -> Callable[[Array], Array]:
    """Return a function for the residuals of travels, normalised by their uncertainty."""
    known = []
    # the theory's error is fully correlated within a curve, at half its size
    error = series.theory_error**2 / 2
    for one in series.tests:
        assert one.travels is not None, "checked by the series"
        value, noise = np.array([(x.value, x.uncertainty / x.value) for x in one.travels]).T
        spread = np.diag(noise**2 + error) + np.full((value.size, value.size), error)
        known.append((np.log(value), np.linalg.inv(np.linalg.cholesky(spread))))

    def residuals(travels: Array) -> Array:
        rows = zip(np.log(travels), known, strict=True)
        return np.concatenate([white @ (one - measured) for one, (measured, white) in rows])

    return residuals
