r"""Coupled simulation of two contacts in series, from two problems to a result in SI.

The work of the drive is the sum of the works at both contacts and the change of the energy of the
spring. Each contact stores elastic and interface energy and dissipates heat, so

.. math:: \int F\, dD = \sum_i \left(\Delta U_i + Q_i + L_i\right) + \frac{F^2 - F_0^2}{2 K},

with the losses L of jumps and meshes. :attr:`SeriesResult.energy_residual` is the difference of
both sides over the largest term, with the left side integrated from the common force.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from viscotack.arrays import Array
from viscotack.clock import TimeUp, limited
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import AtForce, Retraction
from viscotack.simulate.bounds import check_bounds
from viscotack.simulate.contacts.contact import Contact, Relaxed
from viscotack.simulate.crack_contact import too_short
from viscotack.simulate.history import History
from viscotack.simulate.machine import Leg
from viscotack.simulate.march import Part
from viscotack.simulate.settings import Settings
from viscotack.simulate.solver import contact_of, part_of_run, relaxed_start
from viscotack.simulate.two_contacts import SeriesHistory, Units, march_in_series
from viscotack.threads import one_blas_thread

_STATUS = {
    "detached": "one contact has separated",
    "fallen": "the tension has fallen to a fifth of its maximum",
    "jump": "one contact opens in a jump",
    "steps": "the limit on steps was reached",
}


@dataclass(frozen=True, eq=False)
class SeriesResult:
    """Coupled simulation of two contacts in series, in SI.

    Attributes
    ----------
    opened : int or None
        The contact that opens, 0 or 1; None if both open together or the run was stopped.
    tension : float
        Largest common tension [N].
    time, force : ndarray, shape (n,)
        Time [s] and common force [N], positive in compression.
    depth : ndarray, shape (2, n)
        Depths of both contacts [m].
    contact_radius : ndarray, shape (2, n)
        Contact radii [m]; nan without an edge.
    energy_residual : float
        Energy balance over both contacts and the spring, relative to its largest term.
    status : str
        How the run ended.
    """

    opened: int | None
    tension: float
    time: Array
    force: Array
    depth: Array
    contact_radius: Array
    energy_residual: float
    status: str

    @property
    def held(self) -> float:
        """Radius of the contact that holds at the end, over that at the start; nan if unknown."""
        if self.opened is None:
            return float("nan")
        radius = self.contact_radius[1 - self.opened]
        return float(radius[-1] / radius[0])


def simulate_in_series(
    first: Problem,
    second: Problem,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    time_limit: float | None = None,
) -> SeriesResult:
    """Simulate two contacts in series that one machine pulls apart.

    Parameters
    ----------
    first, second : Problem
        Both contacts with equal protocols: a relaxed start at a force, a speed, and perhaps the
        stiffness of the machine.
    accuracy : float
        As for :func:`viscotack.solve`.
    time_limit : float, optional
        Longest time of the run [s].

    Raises
    ------
    OutOfRange
        If a contact cannot be simulated because the range of its forces is too short.
    ValueError
        If a contact has no relaxed start under the common force.
    """
    settings = Settings.for_accuracy(accuracy)
    test = first.protocol
    assert isinstance(test.start, AtForce)
    assert test.speed is not None
    with one_blas_thread(), limited(time_limit):
        try:
            posed = posed_contact(first, settings), posed_contact(second, settings)
        except TimeUp as limit:
            raise InputError(f"{limit} before the relaxed starts were found") from None
        history = march_in_series(
            _parts(posed, test, settings),
            (posed[0].units, posed[1].units),
            speed=test.speed,
            stiffness=test.stiffness,
            settings=settings,
        )
    return _result(posed, history, test.speed, test.stiffness)


@dataclass(frozen=True, eq=False)
class PosedContact:
    """A problem with its groups, contact, relaxed start, units, and unit of its radius [m]."""

    groups: Groups
    contact: Contact
    start: Relaxed
    units: Units
    radius: float


def _parts(
    posed: tuple[PosedContact, PosedContact], test: Retraction, settings: Settings
) -> tuple[Part, Part]:
    """Return both contacts at rest, with modes that cover the times of the pair."""
    assert isinstance(test.start, AtForce)
    assert test.speed is not None
    V, K = test.speed, inf if test.stiffness is None else test.stiffness
    travel = sum((max(x.start.depth, 0.0) + 5 * x.contact.travel) * x.units.depth for x in posed)
    forces = abs(test.start.force), *(x.units.force / x.groups.modulus_ratio for x in posed)
    longest = (travel + 2 * max(forces) / K) / V
    shortest = min(2 * settings.first_travel * x.contact.travel * x.units.depth / V for x in posed)
    first, second = (part_of(x, settings, shortest, longest) for x in posed)
    return first, second


def posed_contact(problem: Problem, settings: Settings) -> PosedContact:
    """Return a contact at its relaxed start, with its units.

    Raises
    ------
    OutOfRange
        If the range of its forces is too short for a simulation.
    """
    groups, si = problem.groups(), problem.scales()
    if too_short(groups):
        raise OutOfRange(
            f"the range-corrected Tabor number of the contact of {problem.geometry} is "
            f"{groups.effective_tabor:.4g}, too large to simulate"
        )
    contact = contact_of(groups)
    check_bounds(groups, contact)
    start = relaxed_start(groups, contact, settings)
    return PosedContact(groups, contact, start, Units(si.length, si.force, si.time), si.radius)


def part_of(posed: PosedContact, settings: Settings, shortest: float, longest: float) -> Part:
    """Return a contact with modes that cover the times from the shortest to the longest [s]."""
    groups, contact, unit = posed.groups, posed.contact, posed.units.time
    legs = (Leg(inf, -1.0, least_step=shortest / unit),)
    longest, deepest = longest / unit, posed.start.depth
    return part_of_run(groups, contact, posed.start, legs, longest, deepest, settings)


def _result(
    posed: tuple[PosedContact, PosedContact],
    history: SeriesHistory,
    speed: float,
    stiffness: float | None,
) -> SeriesResult:
    """Return the result of a run in SI."""
    pairs = list(zip(posed, history.histories, strict=True))

    def series(name: str) -> list[Array]:
        return [np.array([getattr(s, name) for s in h.snapshots]) for _, h in pairs]

    units = [x.units for x in posed]
    time = series("time")[0] * units[0].time
    force = series("force")[0] * units[0].force
    depth = np.array([x * u.depth for x, u in zip(series("depth"), units, strict=True)])
    edges = zip(series("edge"), posed, strict=True)
    radius = np.array([x / one.contact.edge_unit * one.radius for x, one in edges])
    return SeriesResult(
        opened=history.opened if history.opened >= 0 else None,
        tension=float(max(-force.min(), 0.0)),
        time=time,
        force=force,
        depth=depth,
        contact_radius=radius,
        energy_residual=_residual(pairs, time, force, speed, stiffness),
        status=history.reason or _STATUS[history.outcome],
    )


def _residual(
    pairs: list[tuple[PosedContact, History]],
    time: Array,
    force: Array,
    speed: float,
    stiffness: float | None,
) -> float:
    """Return the largest difference of both sides of the energy balance, over its largest term."""
    steps = (force[1:] + force[:-1]) / 2 * np.diff(time)
    drive = np.append(0.0, np.cumsum(-speed * steps))
    spring = 0.0 * force if stiffness is None else (force**2 - force[0] ** 2) / (2 * stiffness)
    taken, largest = spring.copy(), np.maximum(np.abs(drive), np.abs(spring))
    for posed, history in pairs:
        unit, first = posed.units.depth * posed.units.force, history.snapshots[0]
        for i, (books, now) in enumerate(zip(history.books, history.snapshots, strict=True)):
            taken[i] += unit * (books.work - books.imbalance(first, now))
            largest[i] = max(largest[i], unit * history.measure(books, now))
    return float(np.max(np.abs(drive - taken) / np.maximum.accumulate(largest)))
