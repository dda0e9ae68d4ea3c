r"""Identify the interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack (:mod:`.forward`), and simulation
where that does not hold (:mod:`.tiers`). Pull-off forces are computed on a grid of works of
adhesion and ranges and interpolated in logarithms (:mod:`.interpolated_forces`), so that the search
(:mod:`.search`) and its intervals are fast. Noise of the forces, error of the forward model and
uncertainty of material, temperature (:mod:`.covariances`) and machine (:mod:`.machine_compliance`)
form one covariance of the relative forces.

An interface that grows with speed (:mod:`.growth`) has two additional unknowns.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.geometry import HalfSpace, Layer
from viscotack.materials import Material, Passport
from viscotack.materials.passport_uncertainty import allowed, shift_error
from viscotack.protocol import Move
from viscotack.theory.crack.contact.films import ERROR_BY_ZONE, MOST_ZONE
from viscotack.units import readable, readable_interval

from .computed import Computed
from .covariances import (
    ModelError,
    covariance,
    log_forces,
    shift_covariance,
    temperature_effect,
    theory_covariance,
)
from .forward import Changed, Forward
from .growth import FoundGrowth, found_growth
from .interpolated_forces import Table
from .machine_compliance import Yielding, yielding_near
from .objective import Best, Interval, Objective
from .pull_off import PullOff
from .search import (
    LEAST_TABOR,
    Data,
    Search,
    Settled,
    closely,
    plain_table,
    pulled_with_growth,
    settled,
    widely,
)
from .simulations import Simulations
from .smooth_ratio import Mixed
from .solutions import solution_words, solutions
from .temperatures import shifted
from .tiers import LEAST_TABOR as SIMULATED_TABOR
from .tiers import Conditions, answered

# Relative standard uncertainty of the forward model, without and with growth, and on a layer
# much thicker than the contact.
_THEORY, _GROWING_THEORY, _LAYER_THEORY = 0.02, 0.03, 0.03
_LOUD = 2.0  # residuals over their uncertainty above which no such interface fits the forces
_MOST = 40  # largest number of speeds
_NAMED = 4  # number of tests that a misfit names
# Standard uncertainties where none is stated: temperature of tests [K], relative compliance.
_TEMPERATURE, _COMPLIANCE = 2.0, 0.1
_WARMEST = 50.0  # K: largest uncertainty of a temperature; 2 degC would be read as 275 K
_OVER = 1.2  # overshoot of the limit on a layer that is left
_THICK = HalfSpace()
_LEFT = 0.05  # part of the modulus that has not relaxed, from which a caution is given
_ROUNDS = 6  # largest number of rounds in which speeds are excluded


@dataclass(frozen=True, eq=False)
class Uncertain:
    """Material and machine of a series, with their uncertainties.

    Parameters
    ----------
    passport : Passport
        Material at the temperature of the tests.
    temperature : float
        Standard uncertainty of this temperature [K].
    stiffness : float or None
        Stiffness of the machine [N/m]; None if rigid.
    compliance : float
        Relative standard uncertainty of its compliance.
    """

    passport: Passport
    temperature: float
    stiffness: float | None
    compliance: float

    @property
    def shift(self) -> float:
        """Relative standard error of all times of the material by the temperature."""
        return shift_error(self.passport, self.temperature)

    def shifts(self, series: Sequence[PullOff]) -> Array:
        """Return the error of each test at its temperature over `shift`, shape (S,)."""
        reference = self.shift
        errors = [
            shift_error(self.passport, self.temperature, at) if reference else 0.0
            for at in self.temperatures(series)
        ]
        return np.array(errors) / reference if reference else np.ones(len(series))

    def temperatures(self, series: Sequence[PullOff]) -> list[float | None]:
        """Return the temperature of each test [K]; that of the material for an unshifted one."""
        own = self.passport.temperature
        return [own if one.shift == 1.0 else one.temperature for one in series]

    def deviations(self, series: Sequence[PullOff]) -> Array:
        """Return the standard deviation of ln(a_T) of each test by the shift law, shape (S,)."""
        known = (
            0.0 if at is None else self.passport.shift_deviation(at)
            for at in self.temperatures(series)
        )
        return np.log(10.0) * np.array(list(known))


@dataclass(frozen=True, eq=False)
class RateSeriesFit:
    """Interface fitted to a rate series.

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Most likely values [J/m2] and [m], for Lennard-Jones forces.
    tabor : float
        Tabor number of this interface with the material.
    intervals : dict of str to Interval
        Profile likelihood intervals of "work_of_adhesion" and "equilibrium_gap", with growth also
        of "strengthening" and "exponent".
    forces : tuple of float
        Pull-off forces of the most likely interface at the measured speeds [N].
    scatter : float
        Root mean square of the residuals over their uncertainty, without `between_speeds`.
    between_tests : float
        Relative standard deviation between tests that repeats do not show, as given.
    between_speeds : float
        Relative scatter of the forces from speed to speed beyond that of repeated tests and of the
        theory, in the covariance; 0 if the residuals need none.
    trend : bool
        Whether most of the variance of that scatter is an error that follows a power of the speed.
    misfit : str
        Sentence on tests that the fit does not describe, the first of the words; empty if it
        describes them.
    solutions : tuple of Best
        Separate interfaces that fit the forces, the most likely first; mostly one.
    words : tuple of str
        Sentences on the result and on what the data do not determine.
    series : tuple of PullOff
        Fitted pull-offs, each with its preload.
    excluded : tuple of PullOff
        Pull-offs at speeds for which neither theory nor simulation has an answer.
    forward : Forward
        Forward model of the material.
    covariance : ndarray, shape (S, S)
        Covariance of the relative forces: noise, theory and material.
    objective : Objective
        Objective function, for profiles and sampling.
    theory : float
        Relative standard uncertainty of the forward model, included in the covariance.
    level : float
        Confidence level of the intervals.
    uncertain : Uncertain
        Material, stiffness of the machine and temperature, with their uncertainties.
    yielding : ndarray, shape (S,)
        Ratio of forces with the machine's stiffness, or simulated, to those of a rigid machine by
        theory, for this interface.
    ratio : Yielding or Mixed
        The same as a function of the interface.
    model_error : ModelError
        Relative error of the forces, included in the covariance.
    growth : FoundGrowth, optional
        Growth of the interface with speed, if fitted.
    """

    work_of_adhesion: float
    equilibrium_gap: float
    tabor: float
    intervals: dict[str, Interval]
    forces: tuple[float, ...]
    scatter: float
    between_tests: float
    between_speeds: float
    trend: bool
    misfit: str
    solutions: tuple[Best, ...]
    words: tuple[str, ...]
    series: tuple[PullOff, ...]
    excluded: tuple[PullOff, ...]
    forward: Forward
    covariance: Array
    objective: Objective
    theory: float
    level: float
    uncertain: Uncertain
    yielding: Array
    ratio: Yielding | Mixed
    model_error: ModelError
    growth: FoundGrowth | None = None

    @property
    def passport(self) -> Passport:
        """Passport of the material."""
        return self.uncertain.passport

    @property
    def stiffness(self) -> float | None:
        """Stiffness of the machine [N/m]; None if rigid."""
        return self.uncertain.stiffness

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
    body: HalfSpace | Layer = _THICK,
    gaps: tuple[float, float] = (0.3e-9, 3e-6),
    work_of_adhesion: tuple[float, float] | None = None,
    stiffness: float | None = None,
    compliance_uncertainty: float | None = None,
    temperature_uncertainty: float | None = None,
    curves: bool = False,
    growth: bool = False,
    history: bool = False,
    scatter: float = 0.0,
    theory: float | None = None,
    level: float = 0.9,
    computed: Computed | None = None,
) -> RateSeriesFit:
    """Fit work of adhesion and range of attraction to pull-off forces at several speeds.

    Parameters
    ----------
    series : sequence of PullOff
        At least two speeds, for one sphere relaxed under its preload. Tests with a temperature are
        shifted to that of the passport (:func:`.temperatures.shifted`).
    material : Passport or Material
        Solid at the temperature of tests that state none. The sampled solids of a passport widen
        the intervals; a bare material is assumed exact.
    radius : float
        Radius of the sphere [m].
    preload : float, optional
        Force under which all contacts relaxed [N]; by default that of each pull-off.
    body : HalfSpace or Layer
        Sample: thick, or a layer of known thickness [m] on a rigid base. On a layer only pull-off
        forces of relaxed contacts, a stiff machine and interfaces without growth are known.
    gaps : (float, float)
        Searched ranges of attraction h0 [m]; reduced to the validity of the theory.
    work_of_adhesion : (float, float), optional
        Value known from a slow test, with its standard uncertainty [J/m2].
    stiffness : float, optional
        Stiffness of the machine between drive and sphere [N/m], the inverse of its compliance; None
        if rigid. While the tension grows, the sphere moves more slowly than the drive.
    compliance_uncertainty : float, optional
        Relative standard uncertainty of this compliance; by default 10 %.
    temperature_uncertainty : float, optional
        Standard uncertainty of the temperature of the tests [K]; by default 2 K. It changes all
        times of the material by the shift law of the passport; without one it has no effect.
    curves : bool
        Whether to fit whole curves, by the travels between forces of each pull-off; then one
        speed is sufficient, and rate effects within the curve are included.
    growth : bool
        Whether to fit an interface that grows with the opening speed (Gent and Schultz), and test
        whether the data need growth. Its four unknowns need at least four speeds.
    history : bool
        Whether to compute the forces with approach and dwell of each test, mostly by simulation;
        by default contacts have relaxed under the preload. Not with `curves`, `growth` or a layer.
    scatter : float
        Relative standard deviation between tests, if repeated tests do not show it.
    theory : float, optional
        Relative standard uncertainty of the theory, correlated between near speeds; by default
        2 %, or 3 % with growth or on a layer. Where the forces reach through a layer, 7 % times
        the zone length times the contact radius over the squared thickness is added. Simulated
        forces have the error of their interpolation.
    level : float
        Confidence level of the intervals.
    computed : Computed, optional
        Forces of an earlier identification, to which new ones are added.

    Raises
    ------
    OutOfRange
        If the most likely interface is outside the range of theory and simulation.
    ValueError
        If an option is not available for a layer, there are fewer than two speeds (without curves),
        a pull-off has no travels (with curves), or the theory holds for none of the searched
        ranges.

    Notes
    -----
    The bulk is linear, and the interface rate-independent unless `growth` is set. Forces that rise
    more steeply than any range allows give large residuals. Takes 1 to 20 s, mostly for the cracks
    of the material, and up to a minute where tests are simulated; with growth 1 to 2 minutes,
    mostly for the lattice.
    """
    passport = material if isinstance(material, Passport) else Passport(name="", material=material)
    passport.refuse_liquid("a rate series cannot be identified, because contacts do not relax")
    series = [_loaded(one, preload) for one in series]
    series, shift_words = shifted(series, passport, growth)
    thin = isinstance(body, Layer)
    if theory is None:
        theory = _GROWING_THEORY if growth else _LAYER_THEORY if thin else _THEORY
    forward = Forward(passport.material, radius, body=body, computed=computed)
    forward.check(stiffness=stiffness, curves=curves, growth=growth)
    if history:
        _check_history(series, curves or growth or thin)
    _check(series, radius, gaps, stiffness, curves, scatter, theory, level)
    uncertain = _uncertain(passport, temperature_uncertainty, stiffness, compliance_uncertainty)

    def data_of(some: Sequence[PullOff]) -> Data:
        return Data(some, work_of_adhesion, curves, scatter, theory)

    with Simulations(computed) as runs:
        near = _near(forward, data_of, series, uncertain, gaps, growth, history, runs)
    forward, plain, search, dropped = near.forward, near.plain, near.search, near.dropped
    if growth:
        fit, intervals = closely(forward, search, level)
    else:
        fit = settled(search)
        intervals = fit.search.intervals(fit.best, level)
    search, best = fit.search, fit.best
    objective, data = search.objective, search.data
    several = solutions(objective, best, intervals, level)
    if several[0].misfit < best.misfit:
        best = several[0]
        intervals = search.intervals(best, level)
    _check_place(forward, search, best, stiffness)
    found = _growth(forward, search, replace(search, table=plain, opening=None), best)
    doubted = bool(allowed(passport))
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    forces = search.table(best.values) * search.yielding(best.values)
    misfit = _misfit(fit, forces, growth, thin)
    words = [
        *([misfit] if misfit else []),
        *_words(best, intervals, level, doubted, found),
        *_between_words(fit.between, fit.trend),
        *solution_words(several, forward, search.opening, data.speed, data.load, theory),
        *_layer_words(forward, search, best),
        *near.words,
        *([] if history else _relaxed_words(series, forward.material)),
        *shift_words,
        *_temperature_words(uncertain, temperature_uncertainty is None),
        *_left_out(dropped),
        *(remark for one in series for remark in one.remarks),
    ]
    return RateSeriesFit(
        work_of_adhesion=w,
        equilibrium_gap=gap,
        tabor=forward.problem(w, gap, float(data.load[0])).groups().tabor,
        intervals=intervals,
        forces=tuple(forces.tolist()),
        scatter=fit.scatter,
        between_tests=scatter,
        between_speeds=fit.between,
        trend=fit.trend,
        misfit=misfit,
        solutions=several,
        words=tuple(words),
        series=tuple(data.series),
        excluded=tuple(one for one in series if one.speed in dropped),
        forward=forward,
        covariance=search.spread,
        objective=objective,
        theory=theory,
        level=level,
        uncertain=uncertain,
        yielding=search.yielding(best.values),
        ratio=search.yielding,
        model_error=search.model,
        growth=found,
    )


class _Near(NamedTuple):
    """Search near the likely interface.

    Attributes
    ----------
    forward : Forward
        Theory, with growth if fitted.
    plain : Table
        Forces of interfaces without growth.
    search : Search
        Search over the speeds that are left.
    dropped : dict
        Excluded speed -> reason.
    words : list of str
        Sentences on simulated forces.
    """

    forward: Forward
    plain: Table
    search: Search
    dropped: dict[float, str]
    words: list[str]


def _near(
    forward: Forward,
    data_of: Callable[[Sequence[PullOff]], Data],
    series: Sequence[PullOff],
    uncertain: Uncertain,
    gaps: tuple[float, float],
    growth: bool,
    history: bool,
    runs: Simulations,
) -> _Near:
    """Return the search over the speeds for which theory or simulation hold near its best fit."""
    opening, dropped, words = None, {}, []
    for _ in range(_ROUNDS):
        data = data_of(series)
        simulable = not (growth or data.curves or isinstance(forward.body, Layer))
        plain = plain_table(forward, data, gaps, SIMULATED_TABOR if simulable else LEAST_TABOR)
        rigid = Yielding.of_a_rigid_machine(data.speed.size)
        search = Search(data, plain, data.spread, rigid, data.model)
        best = search.best()
        if growth:
            if opening is None:
                forward, opening = pulled_with_growth(forward, search, best)
                # the lattice does not include the larger ranges that slower speeds alone would
                # allow
                gaps = gaps[0], float(plain.axes["equilibrium_gap"][-1])
            search = widely(forward, search, opening)
            best = search.best()
        known, changed = _disturbed(search, best, forward, uncertain)
        if isinstance(known.yielding, Yielding) and known.yielding.much:
            # repeat for this machine, because the interface was that of a rigid one
            known, changed = _disturbed(search, known.best(), forward, uncertain)
        refused = changed.refused
        if simulable:
            moves = tuple(_moves(one) for one in series) if history else ()
            tests = Conditions(data.speed, data.load, uncertain.stiffness, moves)
            known, refused, words = answered(known, changed, forward, tests, runs)
        if not refused:
            most = _largest_gap(known, forward)
            if most is None:
                return _Near(forward, plain, known, dropped, words)
            gaps = gaps[0], most
            continue
        dropped |= {series[i].speed: why for i, why in refused.items()}
        series = [one for i, one in enumerate(series) if i not in refused]
        _check_left(series, data.curves, dropped)
    raise OutOfRange(
        f"the theory does not hold for {len(dropped)} of the speeds, nor for more after their "
        "exclusion; omit the fastest"
    )


def _disturbed(
    search: Search, best: Best, forward: Forward, uncertain: Uncertain
) -> tuple[Search, Changed]:
    """Return a search that includes a compliant machine, and uncertainties of material and machine.

    Also return the ratios of the forces at the interface.
    """
    solids, data, stiffness = allowed(uncertain.passport), search.data, uncertain.stiffness
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    grown = None if search.opening is None else search.opening.of(best.values)
    yielding, changed = yielding_near(forward, w, gap, data.speed, data.load, stiffness, grown)
    more = forward.layer_error(w, gap, data.speed, data.load)
    spread = data.own + theory_covariance(data.speed, data.theory + more)
    if solids:
        # hardly depends on the interface
        rows = log_forces(forward, solids, w, gap, data.speed, data.load, grown)
        spread = spread + covariance(rows)
    case = w, gap, data.speed, data.load
    warmer = temperature_effect(forward, uncertain.shift, *case, grown)
    warmer = warmer * uncertain.shifts(data.series)
    deviation = uncertain.deviations(data.series)
    if deviation.any():
        at = np.array(uncertain.temperatures(data.series), dtype=float)
        spread = spread + shift_covariance(forward, deviation, at, *case)
    softer = uncertain.compliance * yielding.log_ratio
    spread = spread + np.outer(warmer, warmer) + np.outer(softer, softer)
    return replace(search, spread=spread, yielding=yielding), changed


def _largest_gap(search: Search, forward: Forward) -> float | None:
    """Return the largest range whose forces do not reach through the layer; None if all do not.

    The work of adhesion is the likely one of each range.
    """
    if not isinstance(forward.body, Layer):
        return None
    gaps, data = search.table.axes["equilibrium_gap"], search.data
    likely = [search.objective.best({"equilibrium_gap": float(gap)}) for gap in gaps]
    works = np.array([one.values["work_of_adhesion"] for one in likely])
    pulled = forward.pulled(works[:, None], gaps[:, None], data.speed, data.load)
    through = pulled.through.max(axis=-1)
    if through[-1] <= _OVER * MOST_ZONE:
        return None
    over = int(np.argmax(through > MOST_ZONE))
    ends = slice(max(over - 1, 0), over + 1)
    return float(np.exp(np.interp(np.log(MOST_ZONE), np.log(through[ends]), np.log(gaps[ends]))))


def _layer_words(forward: Forward, search: Search, best: Best) -> list[str]:
    """Return a sentence on the layer and the error of the theory on it."""
    if not isinstance(forward.body, Layer):
        return []
    data = search.data
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    pulled = forward.pulled(w, gap, data.speed, data.load)
    radius, error = pulled.edge_radius, data.theory + ERROR_BY_ZONE * pulled.through
    nu = forward.body.poisson_ratio
    base = "sliding on its base" if nu is None else f"bonded, Poisson ratio {nu:.3g}"
    return [
        f"the sample is a layer of {readable(forward.body.thickness, 'm', digits=3)}, {base}; "
        "contact radii at pull-off "
        f"{readable(radius.min(), 'm', digits=2, to=radius.max())}, error of the theory "
        f"{error.min():.1%} to {error.max():.1%}; contact modulus "
        f"{readable(forward.material.contact_modulus, 'Pa', digits=3)} with the Poisson ratio "
        f"{forward.material.poisson_ratio:.3g} of the material"
    ]


def _check_left(left: Sequence[PullOff], curves: bool, dropped: Mapping[float, str]) -> None:
    """Raise an error if too few speeds are left."""
    if len({one.speed for one in left}) < (1 if curves else 2):
        speed, why = max(dropped.items())
        raise OutOfRange(f"the theory holds for too few of the speeds; at {_speed(speed)}: {why}")


def _left_out(dropped: Mapping[float, str]) -> list[str]:
    """Return a sentence on excluded speeds."""
    if not dropped:
        return []
    speeds = ", ".join(_speed(speed) for speed in sorted(dropped))
    why = dropped[max(dropped)]
    return [f"excluded, because the theory does not hold there: {speeds} ({why})"]


def _check_place(forward: Forward, search: Search, best: Best, stiffness: float | None) -> None:
    """Raise an error if the theory does not hold for the fitted interface.

    Conditions whose forces are simulated need no theory.
    """
    by_theory = np.ones(search.data.speed.size, dtype=bool)
    if isinstance(search.yielding, Mixed):
        by_theory[search.yielding.mixed] = False
    elif search.table.effective(best.values) < LEAST_TABOR:
        raise InputError(
            f"the most likely range, {readable(best.values['equilibrium_gap'], 'm', digits=3)}, "
            "has a cohesive zone as large as the contact, so the theory does not hold: simulate"
        )
    # speeds were excluded for a nearby interface; check the fastest one again for this interface
    fastest = [int(np.argmax(search.data.speed))]
    if not by_theory[fastest]:
        return
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
    """Return the growth of the interface, compared with the best one without growth."""
    if search.opening is None:
        return None
    data, grown = search.data, search.opening.of(best.values)
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    pulled = forward.pulled(w, gap, data.speed, data.load, growth=grown)
    better = plain.best().misfit - best.misfit
    return found_growth(best.values, search.opening, better, data.speed, pulled)


def _moves(one: PullOff) -> tuple[Move, ...]:
    assert one.history is not None and one.preload is not None, "checked by the caller"
    return one.history.moves(one.preload)


def _check_history(series: Sequence[PullOff], other: bool) -> None:
    """Raise an error if histories cannot be taken into account."""
    if other:
        raise InputError(
            "approach and dwell are taken into account for pull-off forces on thick samples "
            "without growth only; omit history, or curves, growth and thickness"
        )
    for one in series:
        if one.history is None:
            raise InputError(
                f"the tests at {_speed(one.speed)} have no speed of their approach; omit history"
            )


def _relaxed_words(series: Sequence[PullOff], material: Material) -> list[str]:
    """Return a caution if contacts had not relaxed in their dwell."""
    dwells = [
        (one.history.dwell, one.speed)
        for one in series
        if one.history is not None and one.history.dwell > 0
    ]
    if not dwells:
        return []
    dwell, speed = min(dwells)
    left = float(material.relaxation(dwell)) / material.rubbery_modulus - 1
    if left < _LEFT:
        return []
    return [
        f"the contacts are taken as relaxed, but after a dwell of {readable(dwell, 's', digits=2)} "
        f"at {_speed(speed)} the modulus is {left:.0%} above the relaxed one; with --history the "
        "forces include approach and dwell"
    ]


def _uncertain(
    passport: Passport,
    temperature: float | None,
    stiffness: float | None,
    compliance: float | None,
) -> Uncertain:
    """Return material and machine with their uncertainties, stated or usual."""
    temperature = _TEMPERATURE if temperature is None else temperature
    compliance = _COMPLIANCE if compliance is None else compliance
    if not (0 <= temperature <= _WARMEST and 0 <= compliance < 1):
        raise InputError(
            f"the uncertainty of the temperature must lie between 0 and {_WARMEST:g} K, and that "
            f"of the compliance between 0 and 1 of it; got {temperature:g} K and {compliance:g}"
        )
    return Uncertain(passport, temperature, stiffness, compliance)


def _temperature_words(uncertain: Uncertain, usual: bool) -> list[str]:
    """Return a sentence on the uncertainty of the temperature."""
    if not uncertain.temperature or uncertain.passport.temperature is None:
        return []
    if uncertain.passport.shift is None:
        return [
            "the uncertainty of the temperature of the tests is not in the intervals, because the "
            "passport has no shift of times with temperature"
        ]
    known = "assumed" if usual else "stated"
    return [
        f"the temperature of the tests has a standard uncertainty of {uncertain.temperature:.2g} K "
        f"({known}), by which the times of the material change by {uncertain.shift:.1%}; it is in "
        "the intervals"
    ]


def _loaded(one: PullOff, preload: float | None) -> PullOff:
    load = one.preload if preload is None else preload
    if load is None:
        raise InputError(
            f"the pull-off at {_speed(one.speed)} has no preload; give the force [N] under "
            "which the contact relaxed (preload)"
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
            "whole curves must begin in compression and have points between zero force and the "
            "pull-off; omit curves, or the tests that do not"
        )
    if not curves and len(speeds) < 2 or not 0 < len(series) <= _MOST:
        raise InputError(
            f"a rate series needs pull-offs at two or more speeds, up to {_MOST} in all; got "
            f"{len(series)} at {len(speeds)} speeds"
        )
    if not all(one.speed > 0 and one.force.value > 0 for one in series):
        raise InputError("speeds and pull-off forces must be positive")
    loads = [one.preload or 0.0 for one in series]
    if stiffness is not None and not 0 < stiffness < np.inf:
        raise InputError(f"the stiffness of a machine must be positive, got {stiffness} N/m")
    if not (radius > 0 and min(loads) > 0 and 0 < level < 1):
        raise InputError(
            f"radius and preload must be positive and level between 0 and 1; got {radius} m, "
            f"{min(loads)} N and {level}"
        )
    if not (0 <= scatter < 1 and 0 <= theory < 1):
        raise InputError(f"scatter and theory must lie between 0 and 1, got {scatter} and {theory}")
    if not 0 < gaps[0] < gaps[1]:
        raise InputError(f"gaps must be two positive ranges [m], the smaller first, got {gaps!r}")


_LABELS = {
    "work_of_adhesion": ("work of adhesion", "J/m2"),
    "equilibrium_gap": ("range of attraction h0", "m"),
    "strengthening": ("strengthening", ""),
    "exponent": ("exponent of growth", ""),
}


def _words(
    best: Best,
    intervals: dict[str, Interval],
    level: float,
    doubted: bool,
    growth: FoundGrowth | None,
) -> list[str]:
    said = []
    for name, ends in intervals.items():
        label, unit = _LABELS[name]
        if name == "strengthening" and growth is not None:
            label += f" at an opening speed of {_speed(growth.opening_speed)}"
        said += _of_one(label, unit, best.values[name], ends, level)
    if growth is not None:
        said += growth.words()
    if not doubted:
        said.append("the material is assumed exact, because its uncertainty is unknown")
    return said


def _misfit(fit: Settled, forces: Array, growth: bool, thin: bool) -> str:
    """Return a sentence on tests that the fit does not describe; empty if it describes them."""
    if fit.scatter <= _LOUD:
        return ""
    data = fit.search.data
    off = data.force / forces - 1
    worst = np.sort(np.argsort(np.abs(off))[-_NAMED:])
    tests = ", ".join(f"{_speed(float(data.speed[i]))} {off[i]:+.0%}" for i in worst)
    if growth:
        cure = "even an interface that grows; the material may be wrong, or nonlinear"
    elif thin:
        cure = "; the material or the thickness may be wrong"
    else:
        cure = "; --growth fits an interface that grows with speed, or the material may be wrong"
    if not fit.trend:
        cure += ", or tests at one speed scatter by as much, which --scatter states"
    return (
        f"the fit does not describe these tests: measured over fitted forces are off by {tests}, "
        f"which is {fit.scatter:.2g} times the uncertainty of the tests and the theory. No work of "
        f"adhesion and range of a linear solid explain them{cure}"
    )


def _between_words(between: float, trend: bool) -> list[str]:
    if not between:
        return []
    if trend:
        return [
            f"forces depart from the model by {between:.1%} beyond repeated tests and theory, with "
            "a power of the speed; intervals and bands include such a trend, which a forecast "
            "continues beyond the measured speeds"
        ]
    return [
        f"forces scatter by {between:.1%} from speed to speed beyond repeated tests and theory; "
        "the intervals include this"
    ]


def _speed(value: float) -> str:
    return readable(value, "m/s", digits=3)


def _of_one(label: str, unit: str, value: float, ends: Interval, level: float) -> list[str]:
    """Return a sentence on one parameter."""
    if ends.told:
        both = readable_interval(ends.low, ends.high, unit)
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
            f"the interval of the {label} consists of separate ranges that fit these forces"
        )
    return said
