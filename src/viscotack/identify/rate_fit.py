r"""Identify the interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack (:mod:`.forward`), and simulation
where that does not hold (:mod:`.force_ratios`). Pull-off forces are computed on a grid of works
of adhesion and ranges and interpolated in logarithms (:mod:`.search`), so that the
search and its intervals are fast. Noise of the forces, error of the forward model
and uncertainty of material, temperature and machine (:mod:`.covariances`) form one covariance of
the relative forces.

An interface that grows with speed (:class:`.forward.Opening`) has two additional unknowns.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.lab.tack.repeats import SAME
from viscotack.model.geometry import Layer
from viscotack.theory.crack.contact.recession import MOST_ZONE
from viscotack.theory.sphere import edge_law
from viscotack.units import readable

from .computed import Computed
from .contact_time import PER_DECADE
from .covariances import joint_covariance, shift_covariance
from .force_ratios import Simulations, with_simulations, yielding_near
from .forward import Changed, Forward, FoundGrowth, Interface, Opening, growing
from .likelihood import Best
from .pull_off import PullOff
from .rate_series import RateSeries
from .search import (
    LEAST_TABOR,
    Search,
    SeriesFit,
    Settled,
    Table,
    closely,
    lattice,
    settled,
    widely,
)
from .words import edge_words, fit_words

_LEAST = 4  # speeds
# Searched: works of adhesion below the largest that the forces allow, speeds v0 beyond those of the
# drive, exponents; and their numbers of values.
_WORKS, _SPEEDS, _EXPONENTS = 1e-3, 1e4, (0.1, 1.2)
_COUNTS = 9, 23, 10
_FURTHEST = 10.0  # factor beyond the measured speeds


@dataclass(frozen=True, eq=False)
class EdgeFit(SeriesFit):
    r"""Edge law fitted to a rate series: an elastic solid, and losses at its edge alone.

    .. math:: G = w \left( 1 + \left( \frac{v}{v_0} \right)^n \right)

    in the speed v of the edge (:mod:`viscotack.theory.sphere.edge_law`). It needs no spectrum of
    the material, and does not separate losses of the bulk from those of the interface: w, v0 and n
    describe this pair of surfaces in the measured range of speeds. Its forecast ends a factor of
    ten beyond.

    The unknowns are "work_of_adhesion" [J/m2], "reference_speed" [m/s] and "exponent", and with
    several times in contact at one speed "growth_per_decade".
    """

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result and on what the data do not determine."""
        return tuple(edge_words(self))


def identify_edge(series: RateSeries) -> EdgeFit:
    """Fit work of adhesion, reference speed and exponent of an edge law to a rate series.

    Parameters
    ----------
    series : RateSeries
        The tests; of the material only the relaxed contact modulus is used.

    Raises
    ------
    InputError
        If the series has fewer than four speeds, or whole curves, growth, a history or a layer.
    """
    if series.curves or series.growth or series.history or isinstance(series.body, Layer):
        raise InputError(
            "the edge law is fitted to pull-off forces of relaxed contacts on thick samples; omit "
            "curves, growth, history and thickness"
        )
    speed = series.speed
    if np.unique(speed).size < _LEAST:
        raise InputError(f"the edge law has three unknowns: pull off at {_LEAST} or more speeds")
    most = series.largest_work
    works, speeds, exponents = _COUNTS
    axes = {
        "work_of_adhesion": np.geomspace(_WORKS * most, most, works),
        "reference_speed": np.geomspace(speed.min() / _SPEEDS, speed.max() * _SPEEDS, speeds),
        "exponent": np.geomspace(*_EXPONENTS, exponents),
    }
    forces = edge_forces(series, lattice(axes), speed, series.load)
    forward = Forward(series.passport.material, series.radius)
    search = Search.of(series, forward, Table(axes, np.log(forces)[..., None]))
    if series.stiffness is not None:
        values = search.best().values
        stiff = series.stiffness / (1 + series.compliance_uncertainty)
        other = edge_forces(replace(series, stiffness=stiff), values, speed, series.load)
        softer = np.log(other / edge_forces(series, values, speed, series.load))
        search = replace(search, spread=search.spread + np.outer(softer, softer))
    return EdgeFit.of(settled(search))


def edge_forces(
    series: RateSeries,
    values: Mapping[str, Any],
    speed: npt.ArrayLike,
    load: npt.ArrayLike,
    decades: Array | None = None,
) -> Array:
    """Return pull-off forces [N] of the sphere of a series with edge laws, at speeds and loads.

    `decades` are those from the middle time in contact.
    """
    law = dict(values)
    per_decade = law.pop(PER_DECADE, 0.0)
    if decades is not None:
        law["work_of_adhesion"] = law["work_of_adhesion"] * (1 + per_decade * decades)
    return np.asarray(
        edge_law.pull_off_force(
            speed,
            preload=load,
            radius=series.radius,
            contact_modulus=series.passport.material.contact_modulus,
            stiffness=series.stiffness,
            **law,
        )
    )


def refuse_far(series: RateSeries, speed: Array) -> None:
    """Raise an error for speeds more than ten times beyond the measured ones."""
    low, high = series.speed.min(), series.speed.max()
    factor = _FURTHEST * (1 + SAME)
    bad = speed[(speed < low / factor) | (speed > high * factor)]
    if bad.size:
        raise OutOfRange(
            f"an edge law holds up to {_FURTHEST:g} times beyond its tests, "
            f"{readable(low, 'm/s', to=high)}, not at {readable(bad[0], 'm/s', digits=3)}: measure "
            "there, or give the material of a dynamic test to `viscotack identify rates`"
        )


_OVER = 1.2  # overshoot of the limit on a layer that is left
_ROUNDS = 6  # largest number of rounds in which speeds are excluded
SIMULATED_TABOR = 0.2  # effective: smallest of a table for tests that can be simulated


@dataclass(frozen=True, eq=False)
class RateSeriesFit(SeriesFit):
    """Interface fitted to a rate series on a linear solid.

    The unknowns are "work_of_adhesion" and "equilibrium_gap", with growth also "strengthening" and
    "exponent", and with several times in contact at one speed "growth_per_decade".

    Parameters
    ----------
    growth : FoundGrowth or None
        Growth of the interface with speed, if fitted.
    excluded : tuple of (PullOff, str)
        Tests for which neither theory nor simulation has an answer, with the reason.
    simulations : int
        Number of simulations.
    """

    growth: FoundGrowth | None
    excluded: tuple[tuple[PullOff, str], ...]
    simulations: int

    @property
    def forward(self) -> Forward:
        """Forward model of the material."""
        return self.search.forward

    @property
    def interface(self) -> Interface:
        """The most likely interface."""
        return self.search.interface(self.best.values)

    @property
    def equilibrium_gap(self) -> float:
        """Most likely range h0 [m], for Lennard-Jones forces."""
        return self.best.values["equilibrium_gap"]

    @property
    def tabor(self) -> float:
        """Tabor number of this interface with the material."""
        work, gap, _ = self.interface
        return self.forward.problem(work, gap, float(self.given.load[0])).groups().tabor

    @property
    def yielding(self) -> Array:
        """Ratio of these forces to those of a rigid machine by theory, shape (S,)."""
        return self.search.ratio(self.best.values)

    @property
    def is_zone_length(self) -> bool:
        """Whether the approach excludes every h0 that fits the forces."""
        bound = self.given.range_bound
        return bound is not None and self.intervals["equilibrium_gap"].low > bound

    @cached_property
    def left_out(self) -> tuple[dict[int, float], Changed] | None:
        """Effect of approach and dwell on forces, where they are known and the fit omits them.

        Dwells [s] by number of the tests with the shortest and the longest one, the fastest of
        each, and of the fastest test; and the ratios of their forces to those of relaxed contacts.
        Besides the bulk the contact relaxes: its edge closes long after the modulus is that at
        rest, and fast pulls feel it most.
        """
        given, tests = self.given, self.search.tests
        pasts = {i: one.history for i, one in enumerate(self.series) if one.history}
        dwells = {i: past.dwell for i, past in pasts.items()}
        if given.history or isinstance(given.body, Layer) or not any(dwells.values()):
            return None
        fastest_first = sorted(dwells, key=lambda i: -given.speed[i])
        shortest, longest = (f(fastest_first, key=dwells.__getitem__) for f in (min, max))
        ends = sorted({shortest, longest, fastest_first[0]})
        moves = tuple(pasts[i].moves(given.load[i]) for i in ends)
        changed = (
            tests.some(np.array(ends))._replace(stiffness=None, moves=moves).changed(self.interface)
        )
        return {i: dwells[i] for i in ends}, changed

    @cached_property
    def edge(self) -> EdgeFit | None:
        """The edge law fitted to the same tests; None where it does not apply."""
        try:
            return identify_edge(replace(self.given, growth=False))
        except InputError:
            return None

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result and on what the data do not determine."""
        return tuple(fit_words(self))


def identify_rates(series: RateSeries, *, computed: Computed | None = None) -> RateSeriesFit:
    """Fit work of adhesion and range of attraction to pull-off forces at several speeds.

    Parameters
    ----------
    series : RateSeries
        The tests, with material, machine and assumptions.
    computed : Computed, optional
        Forces of an earlier identification, to which new ones are added.

    Raises
    ------
    OutOfRange
        If the most likely interface is outside the range of theory and simulation.
    ValueError
        If the theory holds for none of the searched ranges.

    Notes
    -----
    The bulk is linear, and the interface rate-independent unless `growth` is set. Forces that rise
    more steeply than any range allows give large residuals. Takes 1 to 20 s, mostly for the cracks
    of the material, and up to a minute where tests are simulated; with growth a minute,
    mostly for the lattice.
    """
    forward = Forward(series.passport.material, series.radius, body=series.body, computed=computed)
    forward.check(compliance=series.stiffness, curves=series.curves, growth=series.growth)
    with Simulations(computed) as runs:
        plain, search, excluded = _located(forward, series, runs)
    found, ends = closely(search, series.level) if series.growth else (settled(search), None)
    fit = RateSeriesFit.of(found, ends, growth=None, excluded=excluded, simulations=runs.count)
    _check_place(fit.search, fit.best)
    found = replace(fit, growth=_growth(fit, plain))
    _ = found.left_out  # now, so that `computed` keeps it for forecasts
    return found


def _located(
    forward: Forward, series: RateSeries, runs: Simulations
) -> tuple[Search, Search, tuple[tuple[PullOff, str], ...]]:
    """Return a search without growth, and one over all unknowns near the likely interfaces.

    Tests for which neither theory nor simulation holds there are excluded, and returned with the
    reason.
    """
    opening, excluded = None, []
    simulable = not (series.growth or series.curves or isinstance(series.body, Layer))
    least = SIMULATED_TABOR if simulable else LEAST_TABOR
    for _ in range(_ROUNDS):
        search = plain = Search.begun(forward, series, least)
        best = plain.best()
        if series.growth:
            if opening is None:
                # the crack speed hardly depends on the interface, because the drive sets it
                place = plain.interface(best.values)
                edge = np.maximum(plain.tests.pulled(place).crack_speed, series.speed)
                middle = float(np.exp(np.mean(np.log(edge))))
                opening = Opening(middle * place.work / forward.material.contact_modulus)
                # the lattice does not include the larger ranges that slower speeds alone would
                # allow
                least_gap, *_, most = plain.table.axes["equilibrium_gap"].tolist()
                forward = growing(forward, opening, (least_gap, most))
                series = replace(series, gaps=(series.gaps[0], most))
            search = widely(forward, plain, opening)
            best = search.best()
        known, changed = _with_errors(search, best)
        if known.ratio.slopes.any():
            # repeat for this machine, because the interface was that of a rigid one
            known, changed = _with_errors(search, known.best())
        refused = changed.refused
        if simulable:
            known, refused = with_simulations(known, changed, runs)
        if np.all(refused == ""):
            most = _largest_gap(known)
            if most is None:
                return plain, known, tuple(sorted(excluded, key=lambda one: one[0].speed))
            series = replace(series, gaps=(series.gaps[0], most))
            continue
        rows = list(zip(series.tests, refused.tolist(), strict=True))
        excluded += [(one, why) for one, why in rows if why]
        left = [one for one, why in rows if not why]
        if len({one.speed for one in left}) < (1 if series.curves else 2):
            one, why = max(excluded, key=lambda row: row[0].speed)
            raise OutOfRange(f"the theory holds for too few of the speeds; at {one.at}: {why}")
        series = replace(series, tests=left)
    raise OutOfRange(
        f"the theory does not hold for {len(excluded)} of the tests, nor for more after their "
        "exclusion; omit the fastest"
    )


def _with_errors(search: Search, best: Best) -> tuple[Search, Changed]:
    """Return a search with the machine, and uncertainties of material, temperature and machine.

    Also return the ratios of the forces at the interface.
    """
    series, interface = search.series, search.interface(best.values)
    own = search.tests
    ratio, changed = yielding_near(own, interface)
    softer = series.compliance_uncertainty * ratio.log_ratio
    noise = series.noise + shift_covariance(series, own, interface)
    spread = joint_covariance(series, [own], interface, search.model, softer, noise)
    return replace(search, spread=spread, ratio=ratio), changed


def _largest_gap(search: Search) -> float | None:
    """Return the largest range whose forces do not reach through the layer; None if all do not.

    The work of adhesion is the likely one of each range.
    """
    if not isinstance(search.series.body, Layer):
        return None
    gaps, series = search.table.axes["equilibrium_gap"], search.series
    likely = [search.objective.best({"equilibrium_gap": float(gap)}) for gap in gaps]
    works = np.array([one.values["work_of_adhesion"] for one in likely])
    pulled = search.forward.pulled(works[:, None], gaps[:, None], series.speed, series.load)
    through = pulled.through.max(axis=-1)
    if through[-1] <= _OVER * MOST_ZONE:
        return None
    over = int(np.argmax(through > MOST_ZONE))
    ends = slice(max(over - 1, 0), over + 1)
    return float(np.exp(np.interp(np.log(MOST_ZONE), np.log(through[ends]), np.log(gaps[ends]))))


def _check_place(search: Search, best: Best) -> None:
    """Raise an error if the theory does not hold for the fitted interface.

    Conditions whose forces are simulated need no theory.
    """
    series, gap = search.series, search.interface(best.values).gap
    simulated, grown = search.ratio.which, search.grown(best.values)
    if not simulated and search.table.at(best.values, grown)[:, 1].min() < LEAST_TABOR:
        raise InputError(
            f"the most likely range, {readable(gap, 'm', digits=3)}, has a cohesive zone as large "
            "as the contact, so the theory does not hold: simulate"
        )
    # speeds were excluded for a nearby interface; check the fastest one again for this interface
    fastest = int(np.argmax(series.speed))
    if fastest in simulated:
        return
    relaxed = search.tests._replace(moves=()).some(np.array([fastest]))
    if why := str(relaxed.changed(search.interface(best.values)).refused[0]):
        raise OutOfRange(f"at {series.tests[fastest].at}: {why}")


def _growth(found: Settled, plain: Search) -> FoundGrowth | None:
    """Return the growth of the interface, compared with the best one without growth."""
    search, best = found.search, found.best
    if search.opening is None:
        return None
    without = replace(search, table=plain.table, opening=None).best()
    return FoundGrowth(
        opening_speed=float(search.opening.speed(best.values["equilibrium_gap"])),
        reference_speed=float(search.opening.growth(best.values).reference_speed),
        better_by=max(without.misfit - best.misfit, 0.0),
        pulled=search.tests.pulled(search.interface(best.values)),
    )
