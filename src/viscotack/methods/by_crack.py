r"""A problem answered as a contact whose edge is a steady crack: any Tabor number above a few.

The theory of :mod:`viscotack.theory.crack.contact`, which has forces of short range and no fitted
constant, and the first correction for their range: a zone is :math:`\Gamma` times longer and the
contact at pull-off of a tip r^q :math:`\Gamma^{1/(2q - 1)}` times larger than elastic ones, so that
tensions are those of short range times the elastic pull-off ratio f at
:math:`\mu \Gamma^{-(q - 1)/(2q - 1)}`, for a sphere :math:`\mu \Gamma^{-1/3}`.

Where the interface grows with the opening speed and takes Q works of adhesion, the solid makes
:math:`\Gamma/Q` of them; an interface Q times as strong has the Tabor number
:math:`\mu Q^{q/(2q - 1)}`, for a sphere :math:`\mu Q^{2/3}`, and a zone Q times shorter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.problem import Groups, Problem
from viscotack.protocol import Apart, Dwell
from viscotack.renamed import Renamed
from viscotack.result.loops import Loop, returned, work_at_indenter
from viscotack.result.opening import least_between
from viscotack.result.parts import Span, all_moves, spans_of, waits
from viscotack.theory import SteadyCrack, lennard_jones
from viscotack.theory.crack.contact import (
    Contact,
    Curve,
    Curves,
    profile_of,
    recede,
)
from viscotack.traction import grows

from .crack_band import band_of
from .crack_problem import LOAD, ROOT, drives_of, groups_of, start_of

METHOD = "crack contact"
# Effective Tabor number over the cube root of the amplification below which nothing is answered.
LEAST_TABOR = 2.0
# Largest one: beyond, lengths of the zone and of the contact are no numbers side by side.
LARGEST_TABOR = 1e9
# Way of the edge to the pull-off, in zones, below which a crack above that energy is not steady.
LEAST_ZONES, _SLOW = 1.5, 1.1
# A contact that lets go where it starts has its zone yet to grow: while the tension has hardly
# fallen the edge goes so many zones, or it is refused.
_FLAT, _FAR = 5e-3, 10.0
# How much larger than the largest relaxed state a contact may become.
_MARGIN = 1.15
# Instants nearer to each other than this part of a parabola's tell the same of it.
_NEAR = 1e-6
_NOTHING = 1e-12
# Part of the largest energy of a crack with a growing interface beyond which none is known.
_LAST = 0.97


@dataclass(frozen=True, eq=False)
class CrackContact:
    """The answer of the theory, in the dimensionless units of a :class:`viscotack.Result`.

    Attributes
    ----------
    problem : Problem or Groups
        What was asked.
    time, depth, force, contact_radius, edge_speed : ndarray
        The history as a simulation gives it; `force` with the correction for the range.
    amplification : ndarray
        Energy at the edge over the work of adhesion.
    move : ndarray
        Number of the move at each step.
    status : str
        "detached" or "still in contact".
    pull_off_force, depth_at_pull_off, time_at_pull_off : float or None
        At the largest tension of the last opening; None without one.
    contact_radius_at_pull_off, crack_speed_at_pull_off, amplification_at_pull_off : float or None
        There.
    work_to_pull_off : float or None
        From the last zero crossing of the force to the largest tension.
    hysteresis : float or None
        Work of the whole history at the indenter, from apart to apart or around a closed loop.
    loop : Loop
        In which state that loop closed. The energy stored in the contact is not known, so that of
        a viscoelastic solid closes in depth only.
    zones : float
        Way of the edge until the pull-off, in zones of the crack there: a crack that has gone few
        of them is not steady yet.
    band : float
        Part of the pull-off force by which a simulation may differ, in 9 of 10 cases.
    method : str
        "crack contact".
    inside : bool
        Whether the band was measured there.
    why : str
        What the band is made of, and where it was measured.
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

    pull_off_depth = Renamed("depth_at_pull_off")
    pull_off_time = Renamed("time_at_pull_off")

    @property
    def interval(self) -> tuple[float, float] | None:
        """Between which the pull-off force lies in 9 of 10 cases; None without one."""
        P = self.pull_off_force
        return None if P is None else (P * (1 - self.band), P * (1 + self.band))


def crack_contact(problem: Problem | Groups) -> CrackContact:
    """Return what a contact does whose edge is the steady crack of its solid and its law.

    Parameters
    ----------
    problem : Problem or Groups
        A sphere, cone, power-law tip or another shape of revolution on a half-space; any solid,
        any law of which the crack is found, any history, springs and loads.

    Raises
    ------
    OutOfRange
        If the theory does not hold: a punch on a layer, zones as large as the contact.
    ValueError
        If there is no relaxed contact to begin with.
    TypeError
        If it is no problem.

    Notes
    -----
    The first answer for a solid and a law solves its cracks, 0.2 to 3 s; later ones take 0.05 to
    0.2 s for a retraction from rest and 0.2 to 1 s for a history. docs/steady_crack.md compares
    it with simulations.

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
    if start > 0 and groups.stiffness is None and groups.rate is not None and _rests(groups):
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
            tension=lambda speed: _tension(groups, crack, crack.amplification(speed), speed),
        )
        if isinstance(groups.start, Apart):
            state = contact.apart(-groups.start.gap / groups.tabor)
        else:
            state = contact.relaxed(start)
        run = contact.run(state, drives_of(groups))
        series, detached = _series(groups, run), run.detached
    return _answer(problem, groups, crack, series, detached)


def crack_contacts(several: Sequence[Groups]) -> list[CrackContact | InputError]:
    """Return what :func:`crack_contact` says of many retractions from rest of one solid, at once.

    Parameters
    ----------
    several : sequence of Groups
        Of the same solid, law and shape, from relaxed starts by a rigid machine.

    Returns
    -------
    list
        An answer each, or why there is none.

    Raises
    ------
    ValueError
        If they differ in what they must share, or no crack of the solid is found.
    """
    if not several:
        return []
    first = several[0]
    shared = (first.material, first.traction, first.geometry, (), None)
    if any((g.material, g.traction, g.geometry, g.moves, g.stiffness) != shared for g in several):
        raise InputError(
            "cases that are answered at once share solid, law and shape, and have neither moves "
            "nor a spring; group them"
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
    """Raise OutOfRange where the theory ends."""
    if groups.effective_tabor > LARGEST_TABOR:
        raise OutOfRange(
            f"an effective Tabor number of {groups.effective_tabor:.4g} is too large: the theory "
            f"goes to {LARGEST_TABOR:g}"
        )


def _rests(groups: Groups) -> bool:
    """Return whether all that a relaxed contact does before the retraction is to wait."""
    return all(isinstance(move, Dwell) for move in groups.moves)


def _receded(groups: Groups, crack: SteadyCrack, found: Curves, case: int) -> dict[str, Any]:
    """Return a retraction from rest as a result has it, after the dwells that change nothing."""
    time, radius, depth, force, speed, energy = (column[:, case] for column in found)
    force = np.where(force < 0, _tension(groups, crack, energy, speed), 1.0) * force
    # the start, and the end of each dwell
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
    """Return a history as a result has it."""
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


def _tension(groups: Groups, crack: SteadyCrack, energy: Any, speed: Any) -> Array:
    """Return the part of a tension of short range that the range of the law leaves."""
    effective = _effective(groups, energy, np.asarray(crack.interface_work(speed)))
    return np.asarray(lennard_jones.pull_off_ratio(effective))


def _answer(
    problem: Problem | Groups,
    groups: Groups,
    crack: SteadyCrack,
    series: dict[str, Any],
    detached: bool,
) -> CrackContact:
    """Return the record of a history."""
    status = "detached" if detached else "still in contact"
    pull_off = _pull_off(groups, series)
    at: dict[str, Any] = pull_off if pull_off is not None else dict.fromkeys(_AT_PULL_OFF)
    energy = float(at["amplification_at_pull_off"] or np.max(series["amplification"]))
    interface = _interface_work(groups, crack, at)
    if grows(groups.traction) and energy > _LAST * crack.largest:
        raise OutOfRange(
            f"an energy of {energy:.4g} works of adhesion is asked of the edge, and the last crack "
            f"with so fast an interface has {crack.largest:.4g}; pull more slowly, or simulate it"
        )
    effective = float(_effective(groups, energy, interface))
    if effective < LEAST_TABOR:
        raise OutOfRange(
            "the zone at the edge is too large beside the contact: the Tabor number "
            f"{groups.tabor:.4g} is one of {effective:.3g} for the range of the law and an energy "
            f"of {energy:.3g} works of adhesion, and the theory holds from {LEAST_TABOR:g} on; "
            "simulate it"
        )
    zones = interface * _zones(groups, crack, series, at, energy / interface)
    if pull_off is not None and zones < LEAST_ZONES and energy > _SLOW:
        raise OutOfRange(
            f"the edge goes {zones:.2g} zones until the pull-off, and is no steady crack before it "
            f"has gone {LEAST_ZONES:g}: the start is too small for this rate; press deeper, "
            "pull more slowly, or simulate it"
        )
    band, inside, why = band_of(groups, energy / interface, effective, zones)
    hysteresis, loop = _hysteresis(groups, series, detached)
    return CrackContact(
        problem=problem,
        **series,
        status=status,
        **at,
        hysteresis=hysteresis,
        loop=loop,
        zones=zones,
        band=band,
        inside=inside,
        why=why,
    )


def _effective(groups: Groups, energy: Any, interface: Any) -> Any:
    """Return the Tabor number of an elastic contact whose zone is as large beside it."""
    # a shape of the user's is taken for a paraboloid
    q = getattr(groups.geometry, "exponent", 2.0)
    bulk = np.maximum(np.maximum(energy, 1.0) / interface, 1.0)
    stronger = interface ** (q / (2 * q - 1))
    return groups.effective_tabor * stronger * bulk ** (-(q - 1) / (2 * q - 1))


def _interface_work(groups: Groups, crack: SteadyCrack, at: dict[str, Any]) -> float:
    """Return what the interface takes at the pull-off [works of adhesion]."""
    speed = at["crack_speed_at_pull_off"]
    if speed is None:
        return 1.0
    return float(crack.interface_work(speed * groups.tabor**2 * groups.material.time_unit))


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
    """Return the way of the edge to the pull-off in lengths of the zone there, at least.

    The zone is as many times longer as the solid makes of the energy.
    """
    energy, radius = at["amplification_at_pull_off"], series["contact_radius"]
    if energy is None:
        return 0.0
    # since the edge last rested or closed
    rows = np.flatnonzero(series["time"] <= at["time_at_pull_off"])
    slow = np.flatnonzero(series["amplification"][rows] <= 1)
    last = int(slow[-1]) if slow.size else 0
    way = radius[last] - at["contact_radius_at_pull_off"]
    if energy > _SLOW:
        # Steps of the radius may not tell it. The energy of an edge that hardly moves grows with
        # the square of the way of the drive: it is above the half for a quarter of the time.
        begun = max(series["time"][last], _begun(series))
        loading = 0.25 * (at["time_at_pull_off"] - begun) / groups.material.time_unit
        way = max(way, loading * float(crack.speed(energy / 2)) / groups.tabor**2 / ROOT)
    zone = crack.zone_length * bulk / groups.tabor**2 / ROOT
    if way < LEAST_ZONES * zone:
        flat = np.flatnonzero(series["force"] < -(1 - _FLAT) * at["pull_off_force"])
        further = radius[last] - radius[flat[-1]] if flat.size else 0.0
        way = further if further > _FAR * zone else way
    return max(way, 0.0) / zone


def _begun(series: dict[str, Any]) -> float:
    """Return when the last move began."""
    before = np.flatnonzero(series["move"] < series["move"][-1])
    return float(series["time"][before[-1]]) if before.size else 0.0


def _pull_off(groups: Groups, series: dict[str, Any]) -> dict[str, Any] | None:
    """Return the state at the largest tension of the last opening, between steps."""
    force, depth = series["force"], series["depth"]
    span = spans_of(groups, series["move"], depth, force)[-1]
    detached = not series["contact_radius"][-1] > 0
    low, run = -1, None
    for pulled in _runs(groups, series, span):
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
    # the first step is one of an edge at rest: no parabola goes through it
    x = series["time"][low - 1 : low + 2]
    inside = run[0] + 1 < low < last and series["contact_radius"][low + 1] > 0
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


def _runs(groups: Groups, series: dict[str, Any], span: Span) -> list[npt.NDArray[np.intp]]:
    """Return the steps of an opening between stops: where the machine waits, nothing is pulled."""
    waiting = np.array([waits(move) for move in all_moves(groups)])[series["move"]]
    steps = np.arange(span.turn, span.last + 1 if span.opens else span.turn)
    pulled = steps[~waiting[steps] | (steps == span.turn)]
    runs = np.split(pulled, np.flatnonzero(np.diff(pulled) > 1) + 1)
    # behind a stop the curve goes on from its end
    return [run if run[0] == span.turn else np.append(run[0] - 1, run) for run in runs if run.size]


def _hysteresis(
    groups: Groups, series: dict[str, Any], detached: bool
) -> tuple[float | None, Loop]:
    """Return the work at the indenter of a history that closes, and in which state it does.

    Surfaces apart do not attract each other here, so that no energy is left across the gap.
    """
    force, depth = series["force"], series["depth"]
    if isinstance(groups.start, Apart) and detached:
        loop = Loop.APART
    elif groups.moves and returned(depth):
        elastic = groups.modulus_ratio >= 1
        loop = Loop.CLOSED if elastic and returned(force) else Loop.DEPTH
    else:
        return None, Loop.OPEN
    return work_at_indenter(depth, force), loop


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
    """Return the numbers of an answer by name: dimensionless, and in SI where the problem is."""
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
