r"""Steady-crack contact model: the contact edge is a steady crack, for Tabor numbers above a few.

The model combines the theory of :mod:`viscotack.theory.crack.contact`, which assumes a short range
of adhesion and has no fitted constant, with a first-order correction for the range. With the
amplification :math:`\Gamma` the cohesive zone is :math:`\Gamma` times longer than an elastic one,
and the contact of a tip r^q at pull-off :math:`\Gamma^{1/(2q - 1)}` times larger. The tension is
therefore multiplied by the elastic pull-off ratio f at the effective Tabor number
:math:`\mu \Gamma^{-(q - 1)/(2q - 1)}`, for a sphere :math:`\mu \Gamma^{-1/3}`.

If the interface energy grows with the opening speed to Q times the work of adhesion, the solid
amplifies it by :math:`\Gamma/Q`. An interface Q times as strong has the Tabor number
:math:`\mu Q^{q/(2q - 1)}`, for a sphere :math:`\mu Q^{2/3}`, and a zone Q times shorter.

**Band.** It is the outcome of a comparison with simulations, and has a range. The model neglects
the zone length relative to the contact radius and to the travel of the edge; the band has a term
for each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import dropwhile
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Sphere
from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.accuracy import outside
from viscotack.model.protocol import Apart, Approach, Dwell, LoadTo, Retract
from viscotack.model.traction import LennardJones, grows
from viscotack.result.curve import shares
from viscotack.result.cycles import Loop, returned, work_at_indenter
from viscotack.result.opening import least_between
from viscotack.result.parts import all_moves, spans_of, waits
from viscotack.simulate.crack_contact import LARGEST_TABOR
from viscotack.simulate.crack_contact.crack_problem import (
    LOAD,
    ROOT,
    drives_of,
    groups_of,
    start_of,
)
from viscotack.theory import SteadyCrack, lennard_jones
from viscotack.theory.crack.contact import Contact, Curve, Curves, profile_of, recede

# Contributions to the band: error of the simulations at default accuracy; second-order effect of
# the range [over effective^2]; influence of the start [over zone lengths]; histories; and growing
# interfaces (`tests/ladder/test_growing_crack.py`).
_GROWING_BAND = 0.02
_LEAST_BAND, _RANGE_BAND, _START_BAND, _HISTORY_BAND = 0.004, 0.12, 0.15, 0.012
# What work, curve and travel to zero force are less certain by than the force, at Tabor numbers of
# 10 to 40: nine of ten of 18 simulated cases, even in the logarithms of the inputs.
FURTHER = np.array([0.0, 0.016, 0.005, 0.003])
# Largest Tabor number with simulations for comparison.
SIMULATED = 200.0
# Ranges of the simulations for comparison; rate in h0 per time unit. For a sphere with
# Lennard-Jones forces, a rigid machine and a start from rest the ranges are wider: outside the
# simulated ones the zone only becomes shorter relative to the contact and to the travel.
_MEASURED = {
    "tabor": (3.0, 100.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
}
_MEASURED_FROM_REST = {
    "tabor": (3.0, 1e6),
    "modulus_ratio": (1e-4, 1.0),
    "rate over the Tabor number": (0.0, 1e6),
}
# Ranges of the simulated histories.
_MEASURED_HISTORIES = {
    "tabor": (8.0, 60.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
    "speed of a move over the Tabor number": (0.3, 100.0),
    "number of moves": (1, 3),
}
_KINDS = Approach | Retract | Dwell | LoadTo
# Softer springs were not simulated; stiffer ones tend to the rigid machine.
_SPRINGS = {"stiffness times the Tabor number": (0.1, np.inf)}


def band_parts(energy: Any, effective: Any, zones: Any) -> tuple[Any, Any, Any]:
    """Contributions to the band of a retraction from rest, relative to the force.

    The contributions are the error of the simulations, the range of the forces, and a short travel
    of the edge. In simulations the force is lower by about 0.1 over the number of zone lengths,
    independent of energy, but not for an amplification near 1.

    Parameters
    ----------
    energy, effective, zones : float or ndarray
        Amplification at pull-off, effective Tabor number, and travel of the edge in zone lengths.
    """
    by_way = _START_BAND * (1 - 1 / np.maximum(energy, 1.0)) / np.maximum(zones, 1.0)
    return _LEAST_BAND, _RANGE_BAND / effective**2, by_way


def curve_bands(energy: float, effective: float, zones: float) -> Array:
    """Bands of force, work, curve and travel to zero force of a retraction from rest, shape (4,).

    Of the curve over the pull-off force, the others relative; parameters as :func:`band_parts`.
    """
    return sum(map(float, band_parts(energy, effective, zones))) + FURTHER


def band_of(
    groups: Groups, energy: float, effective: float, zones: float
) -> tuple[float, bool, str]:
    """Return the band of the force, whether it was measured for such a problem, and why."""
    accuracy, by_range, by_way = band_parts(energy, effective, zones)
    parts = {
        "accuracy of the simulations used for comparison": accuracy,
        f"range of the forces, effective Tabor number {effective:.3g}": by_range,
        f"travel of {zones:.3g} zone lengths to pull-off": by_way,
    }
    if history_of(groups):
        parts["history"] = _HISTORY_BAND * min(1.0, 10 / effective)
    if grows(groups.traction):
        parts["interface that grows with the opening speed"] = _GROWING_BAND
    band = float(sum(parts.values()))
    why = "; ".join(f"{name}: {part:.2%}" for name, part in parts.items())
    if elsewhere := not_measured(groups):
        why += f"; this band was measured for other problems and may not hold here: {elsewhere}"
    elif groups.effective_tabor > SIMULATED:
        why += f"; measured up to a Tabor number of {SIMULATED:g}, extrapolated beyond"
    return band, not elsewhere, why


def history_of(groups: Groups) -> tuple[Any, ...]:
    """Return the moves without initial dwells, which do not change a relaxed contact."""
    return tuple(dropwhile(lambda move: isinstance(move, Dwell), groups.moves))


def not_measured(groups: Groups) -> str:
    """Describe why the band was not measured for such a problem; "" if it was."""
    moves, unit = history_of(groups), groups.material.time_unit / groups.tabor
    values = {"tabor": groups.effective_tabor, "modulus_ratio": groups.modulus_ratio}
    # an elastic contact does not depend on the rate
    if groups.rate is not None and groups.modulus_ratio < 1:
        values["rate over the Tabor number"] = groups.rate * unit
    if groups.modulus_ratio == 1 and not grows(groups.traction):
        # beyond the simulated Tabor numbers an elastic contact is that of JKR
        values["tabor"] = min(values["tabor"], _MEASURED["tabor"][1])
    simple = isinstance(groups.geometry, Sphere) and isinstance(groups.traction, LennardJones)
    measured = _MEASURED_FROM_REST if simple and groups.stiffness is None else _MEASURED
    if groups.stiffness is not None:
        measured = measured | _SPRINGS
        values["stiffness times the Tabor number"] = groups.stiffness * groups.tabor
    if not moves:
        return outside(values, measured)
    measured = measured | _MEASURED_HISTORIES
    values["number of moves"] = len(moves)
    speeds = [move.speed * unit for move in moves if isinstance(move, Approach | Retract)]
    found = [outside(values, measured)]
    if groups.modulus_ratio < 1:
        name = "speed of a move over the Tabor number"
        found += [outside({name: speed}, measured) for speed in speeds]
    others = {type(move).__name__ for move in moves if not isinstance(move, _KINDS)}
    found += [f"moves of type {name} were not compared" for name in sorted(others)]
    return "; ".join(word for word in found if word)


METHOD = "crack contact"
# Smallest accepted effective Tabor number, range-corrected and with the amplification.
LEAST_TABOR = 2.0
# Smallest travel of the edge to pull-off [zone lengths], required if the amplification is above
# _SLOW: with less travel the crack is not steady.
LEAST_ZONES, _SLOW = 1.5, 1.1
# A contact that detaches at its start has no developed zone. The case is rejected unless the edge
# travels _FAR zones while the tension falls by less than the fraction _FLAT.
_FLAT, _FAR = 5e-3, 10.0
# Largest contact radius over that of the largest relaxed state.
_MARGIN = 1.15
# Points closer than this fraction of the parabola's width are treated as one point.
_NEAR = 1e-6
_NOTHING = 1e-12
# Fraction of the largest tabulated energy of a crack with a growing interface that is used.
_LAST = 0.97


@dataclass(frozen=True, eq=False)
class CrackContact:
    """Result of :func:`crack_contact`, in the dimensionless units of a :class:`viscotack.Result`.

    Attributes
    ----------
    problem : Problem or Groups
        The problem that was solved.
    time, depth, force, contact_radius, edge_speed : ndarray, shape (n,)
        The history, as of a simulation; `force` includes the correction for the range.
    amplification : ndarray
        Energy release rate at the edge over the work of adhesion.
    move : ndarray
        Number of the move at each step.
    status : str
        "detached" or "still in contact".
    pull_off_force, depth_at_pull_off, time_at_pull_off : float or None
        Force (positive), depth and time at the largest tension of the last opening; None if
        there is no opening.
    contact_radius_at_pull_off, crack_speed_at_pull_off, amplification_at_pull_off : float or None
        State at the same instant.
    work_to_pull_off : float or None
        Work from the last zero crossing of the force to the largest tension.
    hysteresis : float or None
        Work of the indenter over the whole history, if it starts and ends apart or is a closed
        loop; else None.
    loop : Loop
        How the loop closed. The energy stored in the contact is not computed, so a loop of a
        viscoelastic solid is at best closed in depth only.
    zones : float
        Travel of the edge until pull-off, in cohesive zone lengths at pull-off. After few zone
        lengths the crack is not steady yet.
    band : float
        Relative half width of the 90 % interval of the pull-off force.
    method : str
        "crack contact".
    inside : bool
        Whether the coverage of the band was measured for such problems.
    why : str
        Contributions to the band, and where they were measured.
    """

    problem: Problem | Groups
    time: Array
    depth: Array
    force: Array
    contact_radius: Array
    edge_speed: Array
    amplification: Array
    move: npt.NDArray[np.intp]
    status: str
    pull_off_force: float | None
    depth_at_pull_off: float | None
    time_at_pull_off: float | None
    contact_radius_at_pull_off: float | None
    crack_speed_at_pull_off: float | None
    amplification_at_pull_off: float | None
    work_to_pull_off: float | None
    hysteresis: float | None
    loop: Loop
    zones: float
    band: float
    inside: bool
    why: str
    method: str = METHOD

    @property
    def interval(self) -> tuple[float, float] | None:
        """90 % interval of the pull-off force; None without a pull-off."""
        P = self.pull_off_force
        return None if P is None else (P * (1 - self.band), P * (1 + self.band))


def crack_contact(problem: Problem | Groups) -> CrackContact:
    """Compute a contact history with the steady-crack contact model.

    Parameters
    ----------
    problem : Problem or Groups
        A shape of revolution (sphere, cone, power-law tip or other) on a half-space; any material,
        traction law, history, spring and load.

    Returns
    -------
    CrackContact
        The history with the pull-off and its band, dimensionless.

    Raises
    ------
    OutOfRange
        If the model does not hold: a punch on a layer, or a cohesive zone as large as the contact.
    ValueError
        If no relaxed contact exists at the start.
    TypeError
        If the argument is not a problem.

    Notes
    -----
    The first call for a material and a traction law computes their steady cracks (0.2 to 3 s).
    Later calls take 0.05 to 0.2 s for a retraction from rest and 0.2 to 1 s for a history.
    docs/steady_crack.md compares the model with simulations.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> groups = Groups(tabor=1e4, material=solid, start=AtDepth(2e5), rate=1e5)
    >>> answer = crack_contact(groups)
    >>> f"{answer.pull_off_force:.1f} within {answer.band:.1%}"
    '10.0 within 0.4%'
    """
    groups = groups_of(problem)
    _check_tabor(groups)
    law, unit = groups.traction, groups.material.time_unit
    crack, profile = SteadyCrack(groups.material, law), profile_of(groups.geometry)
    start, largest = start_of(groups, profile)
    series: dict[str, Any]
    rests = all(isinstance(move, Dwell) for move in groups.moves)
    if start > 0 and groups.stiffness is None and groups.rate is not None and rests:
        found = recede(
            crack,
            profile,
            radius=np.array([start]),
            rate=np.array([groups.rate * unit / groups.tabor]),
            tabor=np.array([groups.tabor]),
        )
        series, detached = _receded(groups, crack, found, 0), True
    else:
        spring = groups.stiffness
        contact = Contact(
            crack,
            profile,
            tabor=groups.tabor,
            largest=_MARGIN * largest,
            stiffness=None if spring is None else spring * LOAD * groups.tabor,
            tension=lambda speed: tension_left(groups, crack, crack.amplification(speed), speed),
        )
        if isinstance(groups.start, Apart):
            state = contact.apart(-groups.start.gap / groups.tabor)
        else:
            state = contact.relaxed(start)
        run = contact.run(state, drives_of(groups))
        series, detached = _series(groups, run), run.detached
    return _answer(problem, groups, crack, series, detached)


def unloading(found: CrackContact) -> tuple[Array, Array]:
    """Return the unloading curve of a retraction from rest that reached its pull-off.

    Returns
    -------
    points : ndarray, shape (3, 24)
        Travel left to the pull-off, force and contact radius at
        :func:`viscotack.result.curve.shares`.
    steps : ndarray, shape (2, m)
        Travel from zero force, or from a start in tension, and tension at the steps from there.
    """
    peak, deep, time, wide = (float(getattr(found, name)) for name in _AT_PULL_OFF[:4])
    before, ends = found.time < time, (deep, -peak, wide)
    depth, force, radius = (
        np.append(x[before], end)
        for x, end in zip((found.depth, found.force, found.contact_radius), ends, strict=True)
    )
    kept, travel = np.append(np.diff(depth) < 0, True), depth[0] - depth[-1]
    x, force, radius = (depth[0] - depth[kept]) / travel, force[kept], radius[kept]
    along, pressed = scipy.interpolate.PchipInterpolator(x, force), np.flatnonzero(force > 0)
    zero = (
        float(scipy.optimize.brentq(along, *x[pressed[-1] + np.arange(2)])) if len(pressed) else 0
    )
    part, tense = shares(zero), np.append(zero, x[x > zero])
    points = np.stack([(1 - part) * travel, along(part), np.interp(part, x, radius)])
    return points, np.stack([(tense - zero) * travel, -along(tense)])


def crack_contacts(several: Sequence[Groups]) -> list[CrackContact | InputError]:
    """Compute many retractions from rest on one material in a single vectorised call.

    Parameters
    ----------
    several : sequence of Groups
        Problems with the same material, traction law and shape, with relaxed starts and a rigid
        machine.

    Returns
    -------
    list
        For each problem the result of :func:`crack_contact`, or the InputError that it would
        raise.

    Raises
    ------
    ValueError
        If the problems differ in material, law or shape, or the material has no steady crack.
    """
    if not several:
        return []
    first = several[0]
    shared = (first.material, first.traction, first.geometry, (), None)
    if any((g.material, g.traction, g.geometry, g.moves, g.stiffness) != shared for g in several):
        raise InputError(
            "all problems need the same material, traction law and shape, no moves and no spring; "
            "group them by these"
        )
    unit, profile = first.material.time_unit, profile_of(first.geometry)
    crack = SteadyCrack(first.material, first.traction)
    rates = np.array([g.rate for g in several], dtype=float)
    tabor = np.array([g.tabor for g in several])
    found = recede(
        crack,
        profile,
        radius=np.array([start_of(g, profile)[0] for g in several]),
        rate=rates * unit / tabor,
        tabor=tabor,
    )
    answers: list[CrackContact | InputError] = []
    for i, groups in enumerate(several):
        series = _receded(groups, crack, found, i)
        try:
            _check_tabor(groups)
            answers.append(_answer(groups, groups, crack, series, True))
        except InputError as error:
            answers.append(error)
    return answers


def _check_tabor(groups: Groups) -> None:
    """Raise OutOfRange if the Tabor number is too large."""
    if groups.effective_tabor > LARGEST_TABOR:
        raise OutOfRange(
            f"the range-corrected Tabor number is {groups.effective_tabor:.4g}; the steady-crack "
            f"contact model is valid up to {LARGEST_TABOR:g}"
        )


def _receded(groups: Groups, crack: SteadyCrack, found: Curves, case: int) -> dict[str, Any]:
    """Series of a retraction from rest, in the format of a result, after its initial dwells."""
    time, radius, depth, force, speed, energy = (column[:, case] for column in found)
    force = np.where(force < 0, tension_left(groups, crack, energy, speed), 1.0) * force
    # the start and the end of each dwell
    waits = [move.duration for move in groups.moves if isinstance(move, Dwell)]
    ends = np.append(0.0, np.cumsum(waits)) / groups.material.time_unit
    count = len(waits)
    time = np.append(ends[:-1], time + ends[-1])
    depth, force, radius, speed, energy = (
        np.append(np.full(count, column[0]), column)
        for column in (depth, force, radius, speed, energy)
    )
    move = np.clip(np.arange(time.size) - 1, 0, count)
    return _series(groups, Curve(time, depth, force, radius, speed, energy, move, True))


def _series(groups: Groups, run: Curve) -> dict[str, Any]:
    """Series of a history, in the format of a result."""
    unit = groups.material.time_unit
    return {
        "time": run.time * unit,
        "depth": run.depth * groups.tabor,
        "force": run.force / LOAD,
        "contact_radius": run.radius / ROOT,
        "edge_speed": run.speed / groups.tabor**2 / unit,
        "amplification": run.amplification,
        "move": run.move,
    }


def tension_left(groups: Groups, crack: SteadyCrack, energy: Any, speed: Any) -> Array:
    """Elastic pull-off ratio: tension of the law over that of the short-range limit."""
    effective = effective_tabor(groups, energy, np.asarray(crack.interface_work(speed)))
    return np.asarray(lennard_jones.pull_off_ratio(effective))


def _answer(
    problem: Problem | Groups,
    groups: Groups,
    crack: SteadyCrack,
    series: dict[str, Any],
    detached: bool,
) -> CrackContact:
    """Build the result of a history; OutOfRange if the model does not hold for it."""
    status = "detached" if detached else "still in contact"
    pull_off = _pull_off(groups, series)
    at: dict[str, Any] = pull_off if pull_off is not None else dict.fromkeys(_AT_PULL_OFF)
    energy = float(at["amplification_at_pull_off"] or np.max(series["amplification"]))
    # energy dissipated and stored by the interface at pull-off, over the work of adhesion
    interface = 1.0
    if (speed := at["crack_speed_at_pull_off"]) is not None:
        unit = groups.tabor**2 * groups.material.time_unit
        interface = float(crack.interface_work(speed * unit))
    if grows(groups.traction) and energy > _LAST * crack.largest:
        raise OutOfRange(
            f"the energy at the edge is {energy:.4g} times the work of adhesion; steady cracks "
            f"of this interface are computed only up to {crack.largest:.4g} times; reduce the "
            "retraction speed, or simulate the problem"
        )
    effective = float(effective_tabor(groups, energy, interface))
    if effective < LEAST_TABOR:
        raise OutOfRange(too_large_zone(groups, effective, energy))
    zones = interface * _zones(groups, crack, series, at, energy / interface)
    if pull_off is not None and zones < LEAST_ZONES and energy > _SLOW:
        raise OutOfRange(
            f"the edge travels {zones:.2g} zone lengths until pull-off, and the crack is steady "
            f"only after {LEAST_ZONES:g}: the preload is too small for this rate; press deeper, "
            "pull more slowly, or simulate the problem"
        )
    band, inside, why = band_of(groups, energy / interface, effective, zones)
    force, depth, loop = series["force"], series["depth"], Loop.OPEN
    if isinstance(groups.start, Apart) and detached:
        loop = Loop.APART
    elif groups.moves and returned(depth):
        closed = groups.modulus_ratio >= 1 and returned(force)
        loop = Loop.CLOSED if closed else Loop.DEPTH
    return CrackContact(
        problem=problem,
        **series,
        status=status,
        **at,
        # separated surfaces do not attract each other here, so no interface energy remains
        hysteresis=None if loop is Loop.OPEN else work_at_indenter(depth, force),
        loop=loop,
        zones=zones,
        band=band,
        inside=inside,
        why=why,
    )


def too_large_zone(groups: Groups, effective: float, energy: float = 1.0) -> str:
    """Describe an effective Tabor number below :data:`LEAST_TABOR`."""
    return (
        f"the cohesive zone is too large compared with the contact of a {groups.geometry.word}: at "
        f"a range-corrected Tabor number of {groups.effective_tabor:.4g} and an energy of "
        f"{energy:.3g} times the work of adhesion the effective Tabor number is {effective:.3g}, "
        f"and steady cracks are valid from {LEAST_TABOR:g}; simulate the problem"
    )


def effective_tabor(groups: Groups, energy: Any, interface: Any) -> Any:
    """Tabor number of an elastic contact with the same ratio of zone length to contact radius."""
    # a user-defined shape is treated as a paraboloid
    q = getattr(groups.geometry, "exponent", 2.0)
    bulk = np.maximum(np.maximum(energy, 1.0) / interface, 1.0)
    stronger = interface ** (q / (2 * q - 1))
    return groups.effective_tabor * stronger * bulk ** (-(q - 1) / (2 * q - 1))


_AT_PULL_OFF = (
    "pull_off_force",
    "depth_at_pull_off",
    "time_at_pull_off",
    "contact_radius_at_pull_off",
    "crack_speed_at_pull_off",
    "amplification_at_pull_off",
    "work_to_pull_off",
)


def _zones(
    groups: Groups, crack: SteadyCrack, series: dict[str, Any], at: dict[str, Any], bulk: float
) -> float:
    """Lower bound of the travel of the edge to pull-off, in zone lengths at pull-off.

    The zone is longer than at rest by the amplification of the solid.
    """
    energy, radius = at["amplification_at_pull_off"], series["contact_radius"]
    if energy is None:
        return 0.0
    # since the edge last rested or advanced
    rows = np.flatnonzero(series["time"] <= at["time_at_pull_off"])
    slow = np.flatnonzero(series["amplification"][rows] <= 1)
    last = int(slow[-1]) if slow.size else 0
    way = radius[last] - at["contact_radius_at_pull_off"]
    if energy > _SLOW:
        # The steps of the radius may be too coarse. The energy of an edge that hardly moves grows
        # with the square of the drive's travel: it is above one half for a quarter of the time.
        before = np.flatnonzero(series["move"] < series["move"][-1])
        begun = series["time"][max(last, before[-1] if before.size else 0)]
        loading = 0.25 * (at["time_at_pull_off"] - begun) / groups.material.time_unit
        way = max(way, loading * float(crack.speed(energy / 2)) / groups.tabor**2 / ROOT)
    zone = crack.zone_length * bulk / groups.tabor**2 / ROOT
    if way < LEAST_ZONES * zone:
        flat = np.flatnonzero(series["force"] < -(1 - _FLAT) * at["pull_off_force"])
        further = radius[last] - radius[flat[-1]] if flat.size else 0.0
        way = further if further > _FAR * zone else way
    return max(way, 0.0) / zone


def _pull_off(groups: Groups, series: dict[str, Any]) -> dict[str, Any] | None:
    """State at the largest tension of the last opening, interpolated between steps."""
    force, depth = series["force"], series["depth"]
    span = spans_of(groups, series["move"], depth, force)[-1]
    detached = not series["contact_radius"][-1] > 0
    low, run = -1, None
    # the steps of the opening, split at the dwells of the machine
    waiting = np.array([waits(move) for move in all_moves(groups)])[series["move"]]
    steps = np.arange(span.turn, span.last + 1 if span.opens else span.turn)
    steps = steps[~waiting[steps] | (steps == span.turn)]
    for pulled in np.split(steps, np.flatnonzero(np.diff(steps) > 1) + 1):
        if not pulled.size:
            continue
        if pulled[0] != span.turn:  # after a dwell the curve continues from its end
            pulled = np.append(pulled[0] - 1, pulled)
        i = int(pulled[np.argmin(force[pulled])])
        begins, ends = i == pulled[0] > span.turn, i == pulled[-1]
        pulls_off = not begins and (not ends or (i == span.last and detached))
        if force[i] <= -_NOTHING and pulls_off and (run is None or force[i] < force[low]):
            low, run = i, pulled
    if run is None:
        return None
    first, last = span.turn, run[-1]
    place = np.zeros(1)
    weights = np.array([1.0])
    # at the first step the edge is at rest: the parabola must not include it
    x = series["time"][low - 1 : low + 2]
    inside = run[0] + 1 < low < last and series["contact_radius"][low + 1] > 0
    # steps at one time have no slope between them
    inside = inside and series["time"][low - 1] > series["time"][low - 2]
    if inside and float(np.min(np.diff(x))) > _NEAR * (x[2] - x[0]):
        y = force[low - 1 : low + 2]
        u = (x - x[1]) / (x[2] - x[0])
        slope = np.linalg.solve(np.vander(u, increasing=True), y)
        top = -slope[1] / (2 * slope[2]) if slope[2] > 0 else 0.0
        top = float(np.clip(top, u[0], u[2]))
        least = least_between(series["time"], force, low, float(x[1] + top * (x[2] - x[0])))
        if slope @ [1, top, top**2] >= least:
            weights = np.array([1, top, top**2]) @ np.linalg.inv(np.vander(u, increasing=True))
            place = np.arange(-1, 2)
    at = {name: float(weights @ series[name][low + place.astype(int)]) for name in series}
    rows = np.arange(first, low + 1)
    compressed = np.flatnonzero(force[rows] > 0)
    x, y = depth[rows], -force[rows]
    if compressed.size:
        i = int(compressed[-1])
        part = force[rows[i]] / (force[rows[i]] - force[rows[i + 1]])
        x = np.append(x[i] + part * (x[i + 1] - x[i]), x[i + 1 :])
        y = np.append(0.0, y[i + 1 :])
    work = float(np.sum((y[1:] + y[:-1]) / 2 * -np.diff(x)))
    values = (-at["force"], at["depth"], at["time"], at["contact_radius"])
    values = (*values, at["edge_speed"], at["amplification"], work)
    return dict(zip(_AT_PULL_OFF, values, strict=True))


_IN_SI = {
    "pull_off_force": ("force", "N"),
    "depth_at_pull_off": ("length", "m"),
    "time_at_pull_off": ("time", "s"),
    "contact_radius_at_pull_off": ("radius", "m"),
    "crack_speed_at_pull_off": ("edge_speed", "m_per_s"),
    "work_to_pull_off": ("work", "J"),
    "hysteresis": ("work", "J"),
}


def summary(found: CrackContact) -> dict[str, Any]:
    """Numbers of a result by name: dimensionless, and also in SI if the problem is in SI."""
    scales = found.problem.scales()
    numbers: dict[str, Any] = {"status": found.status, "loop": str(found.loop)}
    for name in (*_AT_PULL_OFF, "hysteresis"):
        value = getattr(found, name)
        numbers[name] = value
        if scales is not None and name in _IN_SI:
            scale, tail = _IN_SI[name]
            factor = getattr(scales, scale)
            numbers[f"{name}_{tail}"] = None if value is None else value * factor
    interval = found.interval
    return numbers | {
        "interval": None if interval is None else list(interval),
        "band": found.band,
        "zones": found.zones,
        "method": found.method,
        "inside": found.inside,
        "why": found.why,
    }
