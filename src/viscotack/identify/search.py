r"""Search for the interface in tables of pull-offs.

Without growth one table covers all unknowns. With growth a coarse table locates the likely
interfaces, and a fine table covers only these.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import root_scalar

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.methods.by_crack import LEAST_TABOR

from .covariances import TREND, ModelError, trend_covariance
from .forward import Forward
from .growth import Opening, growing, growth_parameters
from .interpolated_forces import Table
from .machine_compliance import Yielding
from .objective import Best, Interval, Objective, Parameter
from .pull_off import PullOff
from .smooth_ratio import Mixed

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
# Refinement of the coarse table for the search, and misfits above the minimum that are kept
# at first, and where an interval needs more.
_DENSE, _KEPT = 3, (30.0, 150.0)
# Refinement of the table without growth for a list of likely interfaces.
_LIKELY = 4


class Data:
    """Measured pull-offs as arrays, with their uncertainties."""

    def __init__(
        self,
        series: Sequence[PullOff],
        work: tuple[float, float] | None,
        curves: bool,
        scatter: float,
        theory: float,
    ) -> None:
        self.series, self.curves, self.theory = series, curves, theory
        self.prior = None if work is None else (work[0], work[1] / work[0])
        self.speed = np.array([one.speed for one in series])
        self.load = np.array([one.preload for one in series], dtype=float)
        self.force = np.array([one.force.value for one in series])
        noise = np.array([one.force.uncertainty for one in series]) / self.force
        self.own = np.diag(np.maximum(noise, 1e-9) ** 2 + scatter**2)
        self.model = ModelError(np.full(self.speed.size, theory), np.zeros(self.speed.size))
        self.spread = self.own + self.model.covariance(self.speed)

    def some(self, count: int) -> npt.NDArray[np.intp]:
        """Select evenly a number of pull-offs from the slowest to the fastest."""
        order, size = np.argsort(self.speed, kind="stable"), self.speed.size
        return order[np.unique(np.linspace(0, size - 1, min(count, size)).round().astype(int))]


@dataclass(frozen=True, eq=False)
class Search:
    """A table of pull-offs and the data it is compared with.

    Parameters
    ----------
    data : Data
        Measured pull-offs.
    table : Table
        Forces of relaxed contacts with a rigid machine, by theory.
    spread : ndarray, shape (S, S)
        Covariance of the relative forces.
    yielding : Yielding or Mixed
        Ratios of the forces to those of the table.
    model : ModelError
        Error of the forces, included in the covariance.
    opening : Opening, optional
        Opening speed at which a strengthening is defined.
    some : ndarray of int, optional
        Pull-offs in the table; by default all.
    """

    data: Data
    table: Table
    spread: Array
    yielding: Yielding | Mixed
    model: ModelError
    opening: Opening | None = None
    some: npt.NDArray[np.intp] | None = None

    @property
    def white(self) -> Array:
        """Matrix that makes the residuals independent with unit variance."""
        at = slice(None) if self.some is None else np.ix_(self.some, self.some)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(self.spread[at])), dtype=np.float64)

    def scattered(self, between: float, trend: bool) -> "Search":
        """Return this search with a relative scatter between speeds added to its covariance.

        With a trend, most of its variance is an error that follows a power of the speed.
        """
        speed = self.data.speed
        more = between**2 * np.eye(speed.size)
        if trend:
            more = (1 - TREND) * more + trend_covariance(speed, speed, between)
        return replace(self, spread=self.spread + more)

    def _relative(self, forces: Array, values: Mapping[str, Any]) -> Array:
        """Return relative residuals of the forces, corrected for the machine's stiffness."""
        some = slice(None) if self.some is None else self.some
        return forces * self.yielding(values)[..., some] / self.data.force[some] - 1

    @property
    def objective(self) -> Objective:
        """Objective function over the parameters of the table."""
        table, white = self.table, self.white
        shapes = None
        if self.data.curves and self.some is None:
            shapes = _Shapes(self.data.series, table, self.data.theory)

        def residuals(values: Mapping[str, float]) -> Array:
            rest = white @ self._relative(table(values), values)
            return rest if shapes is None else np.concatenate([rest, shapes(values)])

        return Objective(residuals, self.parameters)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The unknowns, bounded by the ends of the table."""
        axes = self.table.axes
        found = [
            _between("work_of_adhesion", axes["work_of_adhesion"], self.data.prior),
            _between("equilibrium_gap", axes["equilibrium_gap"], None),
        ]
        if self.opening is not None:
            for one in growth_parameters():
                low, high = float(axes[one.name][0]), float(axes[one.name][-1])
                middle = one.outer((one.inner(low) + one.inner(high)) / 2)
                found.append(replace(one, low=low, high=high, start=middle))
        return tuple(found)

    def best(self) -> Best:
        """Return the best fit from several starts."""
        objective = self.objective
        if self.opening is None:
            return _best(objective)
        points, misfits = self.scanned(1)
        names = list(self.table.axes)
        starts = [
            dict(zip(names, _outer(self.parameters, points[i]), strict=True))
            for i in _apart(points, misfits)
        ]
        found = [objective.best(near=Best(start, 0.0, 0)) for start in starts]
        return min(found, key=lambda best: best.misfit)

    def intervals(self, best: Best, level: float) -> dict[str, Interval]:
        """Return the intervals of all unknowns."""
        objective = self.objective
        return {one.name: objective.interval(one.name, best, level) for one in self.parameters}

    def likely(self, above: float, most: int = 300) -> Array:
        """Return interfaces with a misfit up to `above` the least, as ln of work and range.

        The most likely is first, and there are `most` at most.
        """
        points, misfits = self.scanned(_LIKELY)
        order = np.argsort(misfits)
        near = order[: np.count_nonzero(misfits <= misfits[order[0]] + above)]
        return points[near[np.unique(np.linspace(0, near.size - 1, most).astype(int))]]

    def scanned(self, times: int) -> tuple[Array, Array]:
        """Return points of a refined lattice, in search coordinates, and their misfits."""
        points = self.table.dense(times)
        values = {
            one.name: one.outer_of(x) for one, x in zip(self.parameters, points.T, strict=True)
        }
        rest = self._relative(self.table.forces(points), values) @ self.white.T
        misfits = np.sum(rest**2, axis=1)
        if self.data.prior is not None:
            value, relative = self.data.prior
            misfits += ((points[:, 0] - np.log(value)) / relative) ** 2
        return points, misfits


def plain_table(
    forward: Forward, data: Data, gaps: tuple[float, float], least: float = LEAST_TABOR
) -> Table:
    """Return the table of interfaces without growth, down to an effective Tabor number."""
    works, ranges = _works(forward, data, 1.0, _WORKS), np.geomspace(*gaps, _GAPS)
    # ranges valid for the largest work of adhesion; smaller ones are checked after the fit
    at = forward.pulled(works[-1], ranges[:, None], data.speed, data.load).effective_tabor
    holds = np.all(at >= least, axis=-1)
    count = int(np.argmin(holds)) if not holds.all() else holds.size
    if count < _FEWEST:
        raise InputError(
            f"the theory of a crack holds for none of the searched ranges ({gaps[0]:.3g} to "
            f"{gaps[1]:.3g} m), because the cohesive zone is as large as the contact; search "
            "smaller ranges, or simulate"
        )
    axes = {"work_of_adhesion": works, "equilibrium_gap": ranges[:count]}
    return Table(forward, data.speed, data.load, axes, travels=data.curves)


def _works(forward: Forward, data: Data, grown: float, per_decade: float) -> Array:
    """Return the works of adhesion of a table, for a largest growth factor."""
    # the energy of an opening edge is 1 to 1/k works of adhesion
    most = 1.2 * float(data.force.min()) / (1.5 * np.pi * forward.radius)
    span = 2.0 * grown / forward.material.modulus_ratio
    return np.geomspace(most / span, most, 3 + round(per_decade * float(np.log10(span))))


def pulled_with_growth(forward: Forward, plain: Search, best: Best) -> tuple[Forward, Opening]:
    """Return the forward model with growth, and the opening speed of its strengthening."""
    data, ranges = plain.data, plain.table.axes["equilibrium_gap"]
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    # the crack speed hardly depends on the interface, because the drive sets it
    edge = forward.pulled(w, gap, data.speed, data.load).crack_speed
    middle = float(np.exp(np.mean(np.log(np.maximum(edge, data.speed)))))
    opening = Opening(middle * w / forward.material.contact_modulus)
    return growing(forward, opening, (float(ranges[0]), float(ranges[-1]))), opening


def widely(forward: Forward, plain: Search, opening: Opening) -> Search:
    """Return a coarse search over all unknowns."""
    data, ranges = plain.data, plain.table.axes["equilibrium_gap"]
    some = data.some(_COARSE_SPEEDS)
    works, gaps, *steps = _COARSE
    growths = growth_parameters()
    ends = np.log(ranges[[0, -1]])
    axes = {
        "work_of_adhesion": _works(forward, data, growths[0].high, np.log(10) / works),
        "equilibrium_gap": np.exp(_spaced(float(ends[0]), float(ends[1]), gaps)),
    }
    for one, step in zip(growths, steps, strict=True):
        axes[one.name] = one.outer_of(_spaced(one.inner(one.low), one.inner(one.high), step))
    table = Table(
        forward, data.speed[some], data.load[some], axes, opening=opening, radii=_COARSE_RADII
    )
    return replace(plain, table=table, opening=opening, some=some)


class Settled(NamedTuple):
    """A search with the scatter between speeds that its residuals need.

    Attributes
    ----------
    search : Search
        Search with that scatter in its covariance.
    best : Best
        Its best fit.
    scatter : float
        Root mean square of the residuals over their uncertainty, without that scatter.
    between : float
        Relative scatter between speeds.
    trend : bool
        Whether most of its variance is an error that follows a power of the speed.
    """

    search: Search
    best: Best
    scatter: float
    between: float
    trend: bool


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
    plain = _widened(search, best, scatter, trend=False)
    if not plain.between or np.unique(search.data.speed).size < _TREND_SPEEDS:
        return plain
    trend = _widened(search, best, scatter, trend=True)
    return trend if _surprise(trend) + _PREFERRED < _surprise(plain) else plain


def _widened(search: Search, best: Best, scatter: float, *, trend: bool) -> Settled:
    """Return a search with the scatter that its residuals need, with or without a trend."""
    count = search.data.speed.size
    freedom = count + (search.data.prior is not None) - len(best.values)
    if not search.data.curves:
        # forces alone at two speeds leave none, but a range at its bound may not fit them
        freedom = max(freedom, 1)

    def excess(log_scatter: float) -> float:
        wider = search.scattered(float(np.exp(log_scatter)), trend).objective
        forces = wider.residuals(wider.best(near=best).values)[:count]
        return float(forces @ forces) - freedom

    low, high = (float(np.log(x)) for x in _BETWEEN)
    if freedom <= 0 or excess(low) <= 0:
        return Settled(search, best, scatter, 0.0, False)
    root = high if excess(high) >= 0 else root_scalar(excess, bracket=(low, high), xtol=_CLOSE).root
    between = float(np.exp(root))
    wider = search.scattered(between, trend)
    return Settled(wider, wider.best(), scatter, between, trend)


def _surprise(found: Settled) -> float:
    """Return -2 ln(likelihood) of a search at its best fit, up to a constant."""
    return found.best.misfit + float(np.linalg.slogdet(found.search.spread)[1])


def closely(forward: Forward, coarse: Search, level: float) -> tuple[Settled, dict[str, Interval]]:
    """Return a fine search near the likely interfaces, settled, and the intervals."""
    data, widest = coarse.data, {one.name: one for one in coarse.parameters}
    points, misfits = coarse.scanned(_DENSE)
    least = misfits.min()
    for kept in _KEPT:
        near = points[misfits < least + kept]
        axes = {}
        for i, (name, apart) in enumerate(zip(coarse.table.axes, _FINE, strict=True)):
            one, step = widest[name], np.diff(np.unique(points[:, i])).max()
            low = max(near[:, i].min() - step, one.inner(one.low))
            high = min(near[:, i].max() + step, one.inner(one.high))
            axes[name] = one.outer_of(_spaced(low, high, apart))
        table = Table(
            forward,
            data.speed,
            data.load,
            axes,
            opening=coarse.opening,
            travels=data.curves,
            radii=_FINE_RADII,
        )
        found = settled(replace(coarse, table=table, some=None))
        intervals = found.search.intervals(found.best, level)
        if not any(_cut(intervals[name], axes[name], widest[name]) for name in axes):
            break
    return found, intervals


def _cut(interval: Interval, axis: Array, widest: Parameter) -> bool:
    """Return whether an interval ends at the edge of a table inside the search range."""
    below = not interval.closed_below and axis[0] > widest.low * (1 + 1e-9)
    return below or (not interval.closed_above and axis[-1] < widest.high * (1 - 1e-9))


def _spaced(low: float, high: float, apart: float) -> Array:
    """Return evenly spaced values with a largest distance, at least five."""
    return np.linspace(low, high, max(_FEWEST, 1 + int(np.ceil((high - low) / apart - 1e-9))))


def _apart(points: Array, misfits: Array, count: int = 4, share: float = 0.2) -> list[int]:
    """Return the most likely points that are separate from each other."""
    span = np.ptp(points, axis=0)
    found: list[int] = []
    for i in np.argsort(misfits)[:2000]:
        if all(np.max(np.abs(points[i] - points[j]) / span) > share for j in found):
            found.append(int(i))
        if len(found) == count:
            break
    return found


def _outer(parameters: Sequence[Parameter], point: Array) -> list[float]:
    return [one.outer(float(x)) for one, x in zip(parameters, point, strict=True)]


def _between(name: str, values: Array, prior: tuple[float, float] | None) -> Parameter:
    low, high = float(values[0]), float(values[-1])
    return Parameter(name, low, high, float(np.sqrt(low * high)), prior=prior)


class _Shapes:
    """Residuals of travels, normalised by their uncertainty."""

    def __init__(self, series: Sequence[PullOff], model: Table, theory: float):
        self._model = model
        self._log, self._white = [], []
        for one in series:
            assert one.travels is not None, "checked by the caller"
            value = np.array([x.value for x in one.travels])
            noise = np.array([x.uncertainty for x in one.travels]) / value
            # the theory's error is fully correlated within a curve, at half its size
            own = noise**2 + theory**2 / 2
            spread = np.diag(own) + np.full((value.size, value.size), theory**2 / 2)
            self._log.append(np.log(value))
            self._white.append(np.linalg.inv(np.linalg.cholesky(spread)))

    def __call__(self, values: Mapping[str, float]) -> Array:
        found = np.log(self._model.travels(values))
        rows = zip(self._white, found, self._log, strict=True)
        return np.concatenate([white @ (one - measured) for white, one, measured in rows])


def _best(objective: Objective) -> Best:
    """Return the best fit from several starts along the range."""
    (gap,) = (one for one in objective.parameters if one.name == "equilibrium_gap")
    low, high = gap.inner(gap.low), gap.inner(gap.high)
    found = []
    for part in (0.1, 0.3, 0.5, 0.7, 0.9):
        held = objective.best({"equilibrium_gap": gap.outer(low + part * (high - low))})
        found.append(objective.best(near=held))
    return min(found, key=lambda best: best.misfit)
