r"""The interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack (:mod:`.forward`). All works of
adhesion and ranges that are looked at are computed at once, on a grid, and interpolated in their
logarithms (:mod:`.table`); the search (:mod:`.search`) and its intervals then cost nothing. Noise
of the forces, the error of the theory and the doubt about the material (:mod:`.doubt`) are one
covariance of the relative forces.

Where the interface grows with speed (:mod:`.growth`) there are two unknowns more.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import Material, Passport
from viscotack.units import readable

from .doubt import allowed, covariance, log_forces
from .forward import Forward
from .growth import FoundGrowth, found_growth
from .interpolated_forces import Table
from .objective import Best, Interval, Objective
from .pull_off import PullOff
from .search import LEAST_TABOR, Data, Search, closely, plain_table, pulled_with_growth, widely
from .yielding import Yielding, yielding_near

# Relative standard uncertainty of the forward model, and where the interface grows.
_THEORY, _GROWING_THEORY = 0.02, 0.03
_LOUD = 2.0  # residuals over their uncertainty: no such interface gives the forces
_MOST = 40  # speeds
_ROUNDS = 6  # in which speeds are left out


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

    def data_of(some: Sequence[PullOff]) -> Data:
        return Data(some, work_of_adhesion, curves, scatter, theory)

    forward, plain, search, dropped = _near(
        Forward(passport.material, radius), data_of, series, passport, gaps, stiffness, growth
    )
    if growth:
        search, best, intervals = closely(forward, search, level)
    else:
        best = search.best()
        intervals = search.intervals(best, level)
    _check_place(forward, search, best, stiffness)
    found = _growth(forward, search, replace(search, table=plain, opening=None), best)
    objective, data = search.objective, search.data
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
        series=tuple(data.series),
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


def _near(
    forward: Forward,
    data_of: Callable[[Sequence[PullOff]], Data],
    series: Sequence[PullOff],
    passport: Passport,
    gaps: tuple[float, float],
    stiffness: float | None,
    growth: bool,
) -> tuple[Forward, Table, Search, dict[float, str]]:
    """Return the search of the speeds for which the theory holds near the likely interface.

    With the table of interfaces that do not grow, and the speeds left out, each with the reason.
    """
    opening, dropped = None, {}
    for _ in range(_ROUNDS):
        data = data_of(series)
        plain = plain_table(forward, data, gaps)
        search = Search(data, plain, data.spread, Yielding.of_a_rigid_machine(data.speed.size))
        best = search.best()
        if growth:
            if opening is None:
                forward, opening = pulled_with_growth(forward, search, best)
                # the lattice has no larger ranges, which slower speeds alone would allow
                gaps = gaps[0], float(plain.axes["equilibrium_gap"][-1])
            search = widely(forward, search, opening)
            best = search.best()
        known, refused = _disturbed(search, best, forward, passport, stiffness)
        if known.yielding.much:
            # the interface was one for a rigid machine; once more for this one
            known, refused = _disturbed(search, known.best(), forward, passport, stiffness)
        if not refused:
            return forward, plain, known, dropped
        dropped |= {series[i].speed: why for i, why in refused.items()}
        series = [one for i, one in enumerate(series) if i not in refused]
        _check_left(series, data.curves, dropped)
    raise OutOfRange(
        f"the theory does not hold for {len(dropped)} of the speeds, and for more without them; "
        "leave out the fastest"
    )


def _disturbed(
    search: Search, best: Best, forward: Forward, passport: Passport, stiffness: float | None
) -> tuple[Search, dict[int, str]]:
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
            f"the theory holds for too few of the speeds; of {_speed(speed)} it says: {why}"
        )


def _left_out(dropped: Mapping[float, str]) -> list[str]:
    """Return what is said of speeds that were not used."""
    if not dropped:
        return []
    speeds = ", ".join(_speed(speed) for speed in sorted(dropped))
    why = dropped[max(dropped)]
    return [f"left out, because the theory does not hold there: {speeds} ({why})"]


def _check_place(forward: Forward, search: Search, best: Best, stiffness: float | None) -> None:
    """Refuse an interface for which the theory does not hold."""
    if search.table.effective(best.values) < LEAST_TABOR:
        raise InputError(
            f"the most likely range, {readable(best.values['equilibrium_gap'], 'm', digits=3)}, "
            "lies where the zone at the edge is as large as the contact and the theory "
            "does not hold: simulate"
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
        raise OutOfRange(f"at {_speed(search.data.speed[fastest][0])}: {why}")


def _growth(forward: Forward, search: Search, plain: Search, best: Best) -> FoundGrowth | None:
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
            f"the pull-off at {_speed(one.speed)} has no preload; say the force [N] under which "
            "the contact relaxed"
        )
    return replace(one, preload=load)


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


_LABELS = {
    "work_of_adhesion": ("work of adhesion", "J/m2"),
    "equilibrium_gap": ("range of attraction h0", "m"),
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
            label += f" where the gap opens with {_speed(growth.opening_speed)}"
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


def _speed(value: float) -> str:
    return readable(value, "m/s", digits=3)


def _of_one(label: str, unit: str, value: float, ends: Interval, level: float) -> list[str]:
    """Return what is said of one parameter."""
    if ends.told:
        both = readable(ends.low, unit, digits=3, to=ends.high)
        said = [f"{label} {readable(value, unit, digits=3)} ({both}, {level:.0%})"]
    elif ends.closed_below:
        low = readable(ends.low, unit, digits=3)
        said = [f"{label} above {low} ({level:.0%}); not identifiable above"]
    elif ends.closed_above:
        high = readable(ends.high, unit, digits=3)
        said = [f"{label} below {high} ({level:.0%}); not identifiable below"]
    else:
        said = [f"{label}: not identifiable from these speeds"]
    if ends.split:
        said.append(
            f"of the {label} there are two ranges in that interval which give these forces, "
            "with a gap between: another speed, whole curves or a slow test would tell"
        )
    return said
