r"""The interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack (:mod:`.forward`). All works of
adhesion and ranges that are looked at are computed at once, on a grid, and interpolated in their
logarithms (:mod:`.table`); the search and its intervals then cost nothing. Noise of the forces, the
error of the theory and the doubt about the material (:mod:`.doubt`) are one covariance of the
relative forces.

Where the interface grows with speed (:mod:`.growth`) there are two unknowns more. A coarse table of
all that is looked at says where the likely ones are, a fine one is made of those alone.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError, OutOfRange
from viscotack.lab.tack import Cycle, Measured
from viscotack.materials import Material, Passport

from .doubt import allowed, covariance, log_forces, theory_covariance
from .forward import Forward
from .growth import FoundGrowth, Opening, found_growth, growing, growth_parameters
from .objective import Best, Interval, Objective, Parameter
from .table import Table
from .travel import travels
from .yielding import Yielding, yielding_near

Array = npt.NDArray[np.float64]

_WORKS, _GAPS = 8, 21  # works a decade, and ranges, of the table
LEAST_TABOR = 2.0  # effective: below it the theory does not hold
# Relative standard uncertainty of the forward model, and where the interface grows.
_THEORY, _GROWING_THEORY = 0.02, 0.03
# Of the coarse table: works and ranges a decade, ln of strengthenings apart, exponents apart; radii
# of a curve, and pull-offs that are taken. And those of the fine one, of all pull-offs.
_COARSE, _COARSE_RADII, _COARSE_SPEEDS = (4.0, 4.0, 0.5, 0.2), 40, 6
_FINE, _FINE_RADII = (8.0, 5.0, 0.4, 0.15), 80
_FEWEST = 5  # values of an unknown
_ROUNDS = 6  # in which speeds are left out
# How many times as dense the coarse table is searched, and which misfits beyond the least are kept
# at first, and where an interval wants more.
_DENSE, _KEPT = 3, (30.0, 150.0)
_LOUD = 2.0  # residuals over their uncertainty: no such interface gives the forces
_SAME = 0.03  # speeds within this part are one
_MOST = 40  # speeds


@dataclass(frozen=True)
class PullOff:
    """One pull-off, or the mean of several at one speed.

    Parameters
    ----------
    speed : float
        True one of the retraction [m/s].
    force : Measured
        A positive number [N].
    preload : float, optional
        Under which the contact relaxed [N].
    travels : tuple of Measured, optional
        What the whole curve says beside it [m], as :func:`.travel.travels` has it.
    """

    speed: float
    force: Measured
    preload: float | None = None
    travels: tuple[Measured, ...] | None = None


@dataclass(frozen=True, eq=False)
class RateSeriesFit:
    """What a rate series says of the interface.

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Most likely [J/m2] and [m], of Lennard-Jones forces.
    tabor : float
        Tabor number of both with the material.
    intervals : dict of str to Interval
        Of "work_of_adhesion" and "equilibrium_gap", by profile likelihood; with growth of
        "strengthening" and "exponent" too.
    forces : tuple of float
        Pull-off forces of the most likely interface at the speeds of the series [N].
    scatter : float
        Root of the mean square of the residuals over their uncertainty.
    words : tuple of str
        What the data say and what they cannot tell.
    series : tuple of PullOff
        What was fitted, each with its preload.
    passport : Passport
        Of the material.
    forward : Forward
        The pull-offs of the material.
    covariance : ndarray, shape (S, S)
        Of the relative forces: noise, theory and material.
    objective : Objective
        To ask more of: its profiles, its density.
    theory : float
        Relative standard uncertainty of the forward model, which is in the covariance.
    level : float
        Confidence level of the intervals.
    stiffness : float or None
        Of the machine [N/m].
    yielding : ndarray, shape (S,)
        Forces through that over those of a rigid machine.
    growth : FoundGrowth, optional
        How the interface grows with speed, where that was asked.
    """

    work_of_adhesion: float
    equilibrium_gap: float
    tabor: float
    intervals: dict[str, Interval]
    forces: tuple[float, ...]
    scatter: float
    words: tuple[str, ...]
    series: tuple[PullOff, ...]
    passport: Passport
    forward: Forward
    covariance: Array
    objective: Objective
    theory: float
    level: float
    stiffness: float | None
    yielding: Array
    growth: FoundGrowth | None = None

    @property
    def best(self) -> Best:
        """The most likely interface."""
        values = {
            "work_of_adhesion": self.work_of_adhesion,
            "equilibrium_gap": self.equilibrium_gap,
        }
        return self.objective.best(values | ({} if self.growth is None else self.growth.values))


def identify_rates(
    series: Sequence[PullOff],
    *,
    material: Material | Passport,
    radius: float,
    preload: float | None = None,
    gaps: tuple[float, float] = (0.3e-9, 3e-6),
    work_of_adhesion: tuple[float, float] | None = None,
    stiffness: float | None = None,
    curves: bool = False,
    growth: bool = False,
    scatter: float = 0.0,
    theory: float | None = None,
    level: float = 0.9,
) -> RateSeriesFit:
    """Return work of adhesion and range of attraction from pull-off forces at several speeds.

    Parameters
    ----------
    series : sequence of PullOff
        Two speeds and more, of one sphere relaxed under its preload.
    material : Passport or Material
        Of the solid, at the temperature of the tests. Of a passport the solids that its
        measurement allows as well widen the answer; a bare material is taken as exact.
    radius : float
        Of the sphere [m].
    preload : float, optional
        The force under which all of them relaxed [N]; else that of each pull-off.
    gaps : (float, float)
        Ranges of attraction h0 that are looked at [m]; cut where the theory ends.
    work_of_adhesion : (float, float), optional
        Known from a slow test, with its standard uncertainty [J/m2].
    stiffness : float, optional
        Of the machine between drive and sphere [N/m], one over its compliance; None if it is
        rigid. While the tension grows the sphere goes more slowly than the drive.
    curves : bool
        Take the whole curves too, by the travels between forces that each pull-off has; one
        speed is enough then, and a test that is not slow is not taken for one.
    growth : bool
        Look for an interface that grows with the opening speed, after Gent and Schultz: how much
        and with which power, and whether the data need it. Four unknowns want four speeds and more.
    scatter : float
        Relative standard deviation from test to test, where the tests do not show it themselves.
    theory : float, optional
        Relative standard uncertainty of the forward model itself, shared by near speeds; else 2 %,
        of an interface that grows 3 %.
    level : float
        Confidence level of the intervals.

    Raises
    ------
    OutOfRange
        If the most likely interface leaves the range of the theory.
    ValueError
        If there are fewer than two speeds without curves, a pull-off has none, or the theory
        holds for no range looked at.

    Notes
    -----
    The bulk is linear and the interface elastic, but for growth: where forces rise more steeply
    than any range gives, residuals say so. 1 to 20 s, most of it the cracks of the material; with
    growth 1 to 2 minutes, most of it those of the lattice.
    """
    passport = material if isinstance(material, Passport) else Passport(name="", material=material)
    series = [_loaded(one, preload) for one in series]
    if theory is None:
        theory = _GROWING_THEORY if growth else _THEORY
    _check(series, radius, gaps, stiffness, curves, scatter, theory, level)
    forward, opening = Forward(passport.material, radius), None
    asked, dropped = series, {}
    for _ in range(_ROUNDS):
        data = _Data(asked, work_of_adhesion, curves, scatter, theory)
        plain = _plain_table(forward, data, gaps)
        search = _Search(data, plain, data.spread, Yielding.of_a_rigid_machine(data.speed.size))
        best = search.best()
        if growth:
            if opening is None:
                forward, opening = _growing(forward, search, best)
                # the lattice has no larger ranges, which slower speeds alone would allow
                gaps = gaps[0], float(plain.axes["equilibrium_gap"][-1])
            search = _widely(forward, search, opening)
            best = search.best()
        search, refused = _disturbed(search, best, forward, passport, stiffness)
        if not refused:
            break
        dropped |= {asked[i].speed: why for i, why in refused.items()}
        asked = [one for i, one in enumerate(asked) if i not in refused]
        _check_left(asked, curves, dropped)
    if growth:
        search, best, intervals = _closely(forward, search, level)
    else:
        best = search.best()
        intervals = search.intervals(best, level)
    _check_place(forward, search, best, stiffness)
    found = _growth(forward, search, replace(search, table=plain, opening=None), best)
    objective = search.objective
    rest = objective.residuals(best.values)
    noisy = float(np.sqrt(np.sum(rest**2) / max(rest.size - len(best.values), 1)))
    doubted = bool(allowed(passport))
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    words = [*_words(best, intervals, noisy, level, doubted, found), *_left_out(dropped)]
    return RateSeriesFit(
        work_of_adhesion=w,
        equilibrium_gap=gap,
        tabor=forward.problem(w, gap, float(data.load[0])).groups().tabor,
        intervals=intervals,
        forces=tuple((search.table(best.values) * search.yielding(best.values)).tolist()),
        scatter=noisy,
        words=tuple(words),
        series=tuple(asked),
        passport=passport,
        forward=forward,
        covariance=search.spread,
        objective=objective,
        theory=theory,
        level=level,
        stiffness=stiffness,
        yielding=search.yielding(best.values),
        growth=found,
    )


class _Data:
    """What was measured, as arrays, and how well it is known."""

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
        own = np.diag(np.maximum(noise, 1e-9) ** 2 + scatter**2)
        self.spread = own + theory_covariance(self.speed, theory)

    def some(self, count: int) -> npt.NDArray[np.intp]:
        """Return so many of the pull-offs, evenly from the slowest to the fastest."""
        order, size = np.argsort(self.speed, kind="stable"), self.speed.size
        return order[np.unique(np.linspace(0, size - 1, min(count, size)).round().astype(int))]


@dataclass(frozen=True, eq=False)
class _Search:
    """A table, and what its forces are compared with."""

    data: _Data
    table: Table
    spread: Array
    yielding: Yielding
    opening: Opening | None = None
    some: npt.NDArray[np.intp] | None = None

    @property
    def white(self) -> Array:
        """What makes residuals independent, of one standard deviation each."""
        at = slice(None) if self.some is None else np.ix_(self.some, self.some)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(self.spread[at])))

    def _relative(self, forces: Array, values: Mapping[str, Any]) -> Array:
        """Return residuals of forces of a rigid machine, relative ones."""
        some = slice(None) if self.some is None else self.some
        return forces * self.yielding(values)[..., some] / self.data.force[some] - 1

    @property
    def objective(self) -> Objective:
        """Residuals over the parameters of the table."""
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
        """The unknowns, between the ends of the table."""
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
        """Return the best of several starts."""
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

    def scanned(self, times: int) -> tuple[Array, Array]:
        """Return points of a dense lattice, in the numbers that are searched, and their misfits."""
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


def _plain_table(forward: Forward, data: _Data, gaps: tuple[float, float]) -> Table:
    """Return the table of interfaces that do not grow, of the ranges for which the theory holds."""
    works, ranges = _works(forward, data, 1.0, _WORKS), np.geomspace(*gaps, _GAPS)
    # where the most work of adhesion still gives a crack; less is checked where it is found
    at = forward.pulled(works[-1], ranges[:, None], data.speed, data.load).effective_tabor
    holds = np.all(at >= LEAST_TABOR, axis=-1)
    count = int(np.argmin(holds)) if not holds.all() else holds.size
    if count < _FEWEST:
        raise InputError(
            f"the theory of a crack holds for no range looked at ({gaps[0]:.3g} to "
            f"{gaps[1]:.3g} m): the zone at the edge is as large as the contact; look at "
            "smaller ranges, or simulate"
        )
    axes = {"work_of_adhesion": works, "equilibrium_gap": ranges[:count]}
    return Table(forward, data.speed, data.load, axes, travels=data.curves)


def _works(forward: Forward, data: _Data, grown: float, per_decade: float) -> Array:
    """Return works of adhesion of a table, where interfaces grow by so much at most."""
    # no energy at an opening edge is less than the work of adhesion, and none larger than 1/k
    most = 1.2 * float(data.force.min()) / (1.5 * np.pi * forward.radius)
    span = 2.0 * grown / forward.material.modulus_ratio
    return np.geomspace(most / span, most, 3 + round(per_decade * float(np.log10(span))))


def _growing(forward: Forward, plain: _Search, best: Best) -> tuple[Forward, Opening]:
    """Return pull-offs with growth, and where strengthening is read."""
    data, ranges = plain.data, plain.table.axes["equilibrium_gap"]
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    # edges go about as fast whatever the interface is: the drive moves them
    edge = forward.pulled(w, gap, data.speed, data.load).crack_speed
    middle = float(np.exp(np.mean(np.log(np.maximum(edge, data.speed)))))
    opening = Opening(middle * w / forward.material.contact_modulus)
    return growing(forward, opening, (float(ranges[0]), float(ranges[-1]))), opening


def _widely(forward: Forward, plain: _Search, opening: Opening) -> _Search:
    """Return a coarse search of all that is looked at."""
    data, ranges = plain.data, plain.table.axes["equilibrium_gap"]
    some = data.some(_COARSE_SPEEDS)
    strengthening, exponent = growth_parameters()
    works, gaps, apart, steps = _COARSE
    axes = {
        "work_of_adhesion": _works(forward, data, strengthening.high, works),
        "equilibrium_gap": _spaced(ranges[0], ranges[-1], np.log(10) / gaps, True),
        strengthening.name: _spaced(strengthening.low, strengthening.high, apart, True),
        exponent.name: _spaced(exponent.low, exponent.high, steps, False),
    }
    table = Table(
        forward, data.speed[some], data.load[some], axes, opening=opening, radii=_COARSE_RADII
    )
    return replace(plain, table=table, opening=opening, some=some)


def _closely(
    forward: Forward, coarse: _Search, level: float
) -> tuple[_Search, Best, dict[str, Interval]]:
    """Return a fine search of what the coarse one leaves, its best and the intervals."""
    data, widest = coarse.data, {one.name: one for one in coarse.parameters}
    points, misfits = coarse.scanned(_DENSE)
    least = misfits.min()
    for kept in _KEPT:
        near = points[misfits < least + kept]
        axes = {}
        for i, (name, asked) in enumerate(zip(coarse.table.axes, _FINE, strict=True)):
            one, step = widest[name], np.diff(np.unique(points[:, i])).max()
            low = max(near[:, i].min() - step, one.inner(one.low))
            high = min(near[:, i].max() + step, one.inner(one.high))
            apart = np.log(10) / asked if asked > 1 else asked
            inner = _spaced(low, high, apart, False)
            axes[name] = np.exp(inner) if one.logarithmic else inner
        table = Table(
            forward,
            data.speed,
            data.load,
            axes,
            opening=coarse.opening,
            travels=data.curves,
            radii=_FINE_RADII,
        )
        search = replace(coarse, table=table, some=None)
        best = search.best()
        intervals = search.intervals(best, level)
        if not any(_cut(intervals[name], axes[name], widest[name]) for name in axes):
            break
    return search, best, intervals


def _cut(interval: Interval, axis: Array, widest: Parameter) -> bool:
    """Return whether an interval ends at that of a table, short of all that is looked at."""
    below = not interval.closed_below and axis[0] > widest.low * (1 + 1e-9)
    return below or (not interval.closed_above and axis[-1] < widest.high * (1 - 1e-9))


def _spaced(low: float, high: float, apart: float, logarithmic: bool) -> Array:
    """Return values at most so far apart, five at least."""
    a, b = (np.log(low), np.log(high)) if logarithmic else (low, high)
    count = max(_FEWEST, 1 + int(np.ceil((b - a) / apart - 1e-9)))
    values = np.linspace(a, b, count)
    return np.exp(values) if logarithmic else values


def _apart(points: Array, misfits: Array, count: int = 4, share: float = 0.2) -> list[int]:
    """Return the likeliest points that lie apart from each other."""
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


def _disturbed(
    search: _Search, best: Best, forward: Forward, passport: Passport, stiffness: float | None
) -> tuple[_Search, dict[int, str]]:
    """Return a search that knows of the doubt about the material and of a soft machine.

    And for which of the speeds the theory does not hold, with the reason.
    """
    solids, data = allowed(passport), search.data
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    grown = None if search.opening is None else search.opening.of(best.values)
    yielding, refused = yielding_near(forward, w, gap, data.speed, data.load, stiffness, grown)
    if refused:
        return search, refused
    spread = search.spread
    if solids:
        # hardly changes with the interface
        rows = log_forces(forward, solids, w, gap, data.speed, data.load, grown)
        spread = spread + covariance(rows)
    return replace(search, spread=spread, yielding=yielding), {}


def _check_left(left: Sequence[PullOff], curves: bool, dropped: Mapping[float, str]) -> None:
    """Refuse a series of which too little is left."""
    if len({one.speed for one in left}) < (1 if curves else 2):
        speed, why = max(dropped.items())
        raise OutOfRange(
            f"the theory holds for too few of the speeds; of {speed:.3g} m/s it says: {why}"
        )


def _left_out(dropped: Mapping[float, str]) -> list[str]:
    """Return what is said of speeds that were not used."""
    if not dropped:
        return []
    speeds = ", ".join(f"{speed:.3g}" for speed in sorted(dropped))
    why = dropped[max(dropped)]
    return [f"left out, because the theory does not hold there: {speeds} m/s ({why})"]


def _check_place(forward: Forward, search: _Search, best: Best, stiffness: float | None) -> None:
    """Refuse an interface for which the theory does not hold."""
    if search.table.effective(best.values) < LEAST_TABOR:
        raise InputError(
            f"the most likely range, {best.values['equilibrium_gap']:.3g} m, lies where the zone "
            "at the edge is as large as the contact and the theory does not hold: simulate"
        )
    # speeds were left out for an interface near this one; of it the fastest is asked again
    fastest = [int(np.argmax(search.data.speed))]
    grown = None if search.opening is None else search.opening.of(best.values)
    found = forward.changed(
        best.values["work_of_adhesion"],
        best.values["equilibrium_gap"],
        search.data.speed[fastest],
        search.data.load[fastest],
        stiffness=stiffness,
        growth=grown,
    )
    for why in found.refused.values():
        raise OutOfRange(f"at {search.data.speed[fastest][0]:.3g} m/s: {why}")


def _growth(forward: Forward, search: _Search, plain: _Search, best: Best) -> FoundGrowth | None:
    """Return how the interface grows, beside the best one that does not."""
    if search.opening is None:
        return None
    data, grown = search.data, search.opening.of(best.values)
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    pulled = forward.pulled(w, gap, data.speed, data.load, growth=grown)
    better = plain.best().misfit - best.misfit
    return found_growth(best.values, search.opening, better, data.speed, pulled)


def _loaded(one: PullOff, preload: float | None) -> PullOff:
    load = one.preload if preload is None else preload
    if load is None:
        raise InputError(
            f"the pull-off at {one.speed:.3g} m/s has no preload; say the force [N] under which "
            "the contact relaxed"
        )
    return replace(one, preload=load)


def _between(name: str, values: Array, prior: tuple[float, float] | None) -> Parameter:
    low, high = float(values[0]), float(values[-1])
    return Parameter(name, low, high, float(np.sqrt(low * high)), prior=prior)


def _check(
    series: Sequence[PullOff],
    radius: float,
    gaps: tuple[float, float],
    stiffness: float | None,
    curves: bool,
    scatter: float,
    theory: float,
    level: float,
) -> None:
    speeds = {one.speed for one in series}
    if curves and any(one.travels is None for one in series):
        raise InputError(
            "whole curves begin in compression and have points between zero force and the "
            "pull-off; one of these has not: leave out curves, or that test"
        )
    if not curves and len(speeds) < 2 or not 0 < len(series) <= _MOST:
        raise InputError(
            f"a rate series has pull-offs at two speeds and more, up to {_MOST} in all; got "
            f"{len(series)} at {len(speeds)}"
        )
    if not all(one.speed > 0 and one.force.value > 0 for one in series):
        raise InputError("speeds and pull-off forces must be positive")
    loads = [one.preload or 0.0 for one in series]
    if stiffness is not None and not 0 < stiffness < np.inf:
        raise InputError(f"the stiffness of a machine must be positive, got {stiffness} N/m")
    if not (radius > 0 and min(loads) > 0 and 0 < level < 1):
        raise InputError(
            f"radius and preload must be positive, the level a part of one; got {radius} m, "
            f"{min(loads)} N, {level}"
        )
    if not (0 <= scatter < 1 and 0 <= theory < 1):
        raise InputError(
            f"scatter and error of the theory must be parts of one, got {scatter}, {theory}"
        )
    if not 0 < gaps[0] < gaps[1]:
        raise InputError(f"gaps must be two ranges, the smaller first [m], got {gaps!r}")


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off for each speed: repeated cycles are averaged.

    Speeds within 3 % are one. The uncertainty of a mean holds the scatter of its cycles; the
    preload is the force where retractions begin, none where one of them begins in tension.
    """
    found: list[PullOff] = []
    rest = sorted(cycles, key=lambda cycle: cycle.speed.value)
    while rest:
        first = rest[0].speed.value
        same = [cycle for cycle in rest if cycle.speed.value <= (1 + _SAME) * first]
        rest = rest[len(same) :]
        forces = np.array([cycle.pull_off_force.value for cycle in same])
        own = float(np.mean([cycle.pull_off_force.uncertainty for cycle in same]))
        spread = float(np.std(forces, ddof=1) / np.sqrt(forces.size)) if forces.size > 1 else 0.0
        speed = float(np.mean([cycle.speed.value for cycle in same]))
        begins = [float(cycle.force[cycle.segments.retract]) for cycle in same]
        force = Measured(float(forces.mean()), float(np.hypot(own, spread)))
        preload = float(np.mean(begins)) if min(begins) > 0 else None
        found.append(PullOff(speed, force, preload, _mean([travels(cycle) for cycle in same])))
    return found


def _mean(rows: Sequence[tuple[Measured, ...] | None]) -> tuple[Measured, ...] | None:
    """Return the means of travels; None where a curve has none."""
    told = [row for row in rows if row is not None]
    if len(told) < len(rows):
        return None
    columns = list(zip(*told, strict=True))
    return tuple(
        Measured(
            float(np.mean([one.value for one in column])),
            float(np.mean([one.uncertainty for one in column])),
        )
        for column in columns
    )


class _Shapes:
    """Residuals of travels, in standard deviations."""

    def __init__(self, series: Sequence[PullOff], model: Table, theory: float):
        self._model = model
        self._log, self._white = [], []
        for one in series:
            assert one.travels is not None, "checked before"
            value = np.array([x.value for x in one.travels])
            noise = np.array([x.uncertainty for x in one.travels]) / value
            # what the theory errs in one curve it errs in all of it, half of it
            own = noise**2 + theory**2 / 2
            spread = np.diag(own) + np.full((value.size, value.size), theory**2 / 2)
            self._log.append(np.log(value))
            self._white.append(np.linalg.inv(np.linalg.cholesky(spread)))

    def __call__(self, values: Mapping[str, float]) -> Array:
        found = np.log(self._model.travels(values))
        rows = zip(self._white, found, self._log, strict=True)
        return np.concatenate([white @ (one - measured) for white, one, measured in rows])


def _best(objective: Objective) -> Best:
    """Return the best of several starts along the range."""
    (gap,) = (one for one in objective.parameters if one.name == "equilibrium_gap")
    low, high = gap.inner(gap.low), gap.inner(gap.high)
    found = []
    for part in (0.1, 0.3, 0.5, 0.7, 0.9):
        held = objective.best({"equilibrium_gap": gap.outer(low + part * (high - low))})
        found.append(objective.best(near=held))
    return min(found, key=lambda best: best.misfit)


_LABELS = {
    "work_of_adhesion": ("work of adhesion", " J/m2"),
    "equilibrium_gap": ("range of attraction h0", " m"),
    "strengthening": ("strength over that at rest", ""),
    "exponent": ("exponent of growth", ""),
}


def _words(
    best: Best,
    intervals: dict[str, Interval],
    scatter: float,
    level: float,
    doubted: bool,
    growth: FoundGrowth | None,
) -> list[str]:
    said = []
    for name, ends in intervals.items():
        label, unit = _LABELS[name]
        if name == "strengthening" and growth is not None:
            label += f" where the gap opens with {growth.opening_speed:.3g} m/s"
        said += _of_one(label, unit, best.values[name], ends, level)
    if growth is not None:
        said += growth.words()
    if scatter > _LOUD:
        cause = "the interface may grow with speed, or the material be another one"
        if growth is not None:
            cause = "the material may be another one, or no longer linear"
        kind = "an elastic interface" if growth is None else "a growing interface"
        said.append(
            f"residuals are {scatter:.2g} times their uncertainty: no work of adhesion and range "
            f"of a linear solid with {kind} give these forces; {cause}"
        )
    if not doubted:
        said.append("the material is taken as exact: nothing says how well it is known")
    return said


def _of_one(label: str, unit: str, value: float, ends: Interval, level: float) -> list[str]:
    """Return what is said of one parameter."""
    if ends.told:
        said = [f"{label} {value:.3g}{unit} ({ends.low:.3g} to {ends.high:.3g}, {level:.0%})"]
    elif ends.closed_below:
        said = [f"{label} above {ends.low:.3g}{unit} ({level:.0%}); not identifiable above"]
    elif ends.closed_above:
        said = [f"{label} below {ends.high:.3g}{unit} ({level:.0%}); not identifiable below"]
    else:
        said = [f"{label}: not identifiable from these speeds"]
    if ends.split:
        said.append(
            f"of the {label} there are two ranges in that interval which give these forces, "
            "with a gap between: another speed, whole curves or a slow test would tell"
        )
    return said
