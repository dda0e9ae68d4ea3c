"""Numbers of a reduced contact, from a problem: units, arms, cells and the tables of its edge."""

from __future__ import annotations

from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.model.geometry import Sphere
from viscotack.model.materials.interconversion import reciprocal
from viscotack.model.problem import Problem
from viscotack.model.traction import grows
from viscotack.simulate.crack_contact.by_crack import tension_left
from viscotack.simulate.crack_contact.crack_problem import LOAD, ROOT, groups_of
from viscotack.theory.crack.contact import Edge
from viscotack.theory.crack.steady import SteadyCrack
from viscotack.units import readable

from .reduced import ReducedContact

# Least Tabor number, and longest zone [beta]: within them histories were compared with simulations.
LEAST, _LONGEST_ZONE = 8.0, 0.065
# Bands of force and work, and their growth with the longest zone: 19 in 20 of these histories lay
# within. A closing edge lags behind that of the model, and a pull of few zones is not steady.
_BAND, _BY_ZONE = (0.02, 0.03), (2.5, 4.0)
# Cells: equal ones up to a radius [beta], then each longer by a factor; the last has no end.
_EQUAL, _UP_TO, _LONGER, _FACTOR, _END = 80, 3.0, 20, 1.15, 1e6
# Window of the arms [s], and their error over the rubbery compliance.
_WINDOW, _TOLERANCE = (1e-6, 1e6), 2e-3
# Rows of the tables, and their ends for an elastic solid.
_ROWS, _ELASTIC = 256, (-10.0, 300.0)
# By this factor edges are faster than where their energy is that of a glassy solid, e^10.
_FASTER = 10.0
# Ends of the time in the zone, over the shortest and the longest of the arms.
_SHORT, _LONG = 1e-4, 1e4


def reduced_contact(problem: Problem) -> ReducedContact:
    """Return the reduced contact of a sphere on a half-space.

    Parameters
    ----------
    problem : Problem
        Solid, law and sphere; its protocol does not matter.

    Returns
    -------
    ReducedContact
        The numbers, from the steady cracks of the solid and the law.

    Raises
    ------
    OutOfRange
        If the range of attraction is too long: a Tabor number below 8.
    ValueError
        If the problem is not a sphere on a half-space without a spring, in SI, or if the law grows
        with the opening speed.

    Examples
    --------
    >>> from viscotack import AtForce, LennardJones, Retraction, StandardSolid
    >>> rubber = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.01, poisson_ratio=0.5
    ... )
    >>> law = LennardJones(work_of_adhesion=0.05, equilibrium_gap=5e-9)
    >>> ball = Problem(rubber, law, Sphere(1e-3), protocol=Retraction(AtForce(1e-3), speed=1e-6))
    >>> contact = reduced_contact(ball)
    >>> state = contact.apart(0.0)
    >>> for depth in range(1, 101):
    ...     state, _ = contact.step(state, depth * 1e-8, 0.01)
    >>> f"{contact.force(state)[0] * 1e6:.0f} uN at {contact.radius(state)[0] * 1e6:.1f} um"
    '53 uN at 45.8 um'
    """
    if not isinstance(problem, Problem):
        raise InputError(f"a contact for simulators is in SI and needs a Problem, got {problem!r}")
    groups = groups_of(problem)
    if not isinstance(problem.geometry, Sphere):
        raise InputError(f"the reduced contact is that of a sphere, got {problem.geometry}")
    if problem.protocol.stiffness is not None:
        raise InputError("leave out stiffness: the simulator has the spring of the machine")
    if grows(problem.traction):
        raise InputError("interface: a law that grows with the opening speed has no reduction")
    if groups.effective_tabor < LEAST:
        raise OutOfRange(
            f"the Tabor number is {groups.effective_tabor:.3g}, and the reduction holds from "
            f"{LEAST:g}, where the zone of the crack is short beside the contact; for such a long "
            "equilibrium_gap tabulate the force, `viscotack control`"
        )
    crack, scales = SteadyCrack(groups.material, groups.traction), problem.scales()
    # the zone of an edge grows with its energy
    most = _LONGEST_ZONE * problem.tabor**2 / crack.zone_length
    zone, fastest, until = crack.zone_length * crack.largest / problem.tabor**2, np.inf, "any speed"
    if crack.largest > most:
        rate = float(np.asarray(crack.speed(most))) / problem.tabor**2 / problem.material.time_unit
        zone, fastest = _LONGEST_ZONE, rate * scales.radius / ROOT
        until = f"speeds up to {readable(fastest, 'm/s', digits=3)}"
    modulus, time = _arms(problem.material)
    rest = float(tension_left(groups, crack, np.ones(1), np.zeros(1))[0])
    # V = mu^2 |da/dt| tau, with the rate of the radius in beta/s
    shift = np.log(problem.tabor**2 * problem.material.time_unit)
    first, per, energy = [], [], []
    for sign in (1, -1):
        edge = Edge(crack, sign)
        ends = _ELASTIC if edge.elastic else (edge.span[0], edge.span[1] + _FASTER)
        speed = np.exp(np.linspace(*ends, _ROWS))
        gamma = np.asarray(edge.amplification(speed))
        left = tension_left(groups, crack, gamma, speed) if sign > 0 else rest
        first.append(ends[0] - shift)
        per.append((_ROWS - 1) / (ends[1] - ends[0]))
        energy.append(gamma * left)
    zones = crack.zone_length / problem.tabor**2, zone
    force_band, work_band = (
        (least + more * zones[0], least + more * zones[1])
        for least, more in zip(_BAND, _BY_ZONE, strict=True)
    )
    return ReducedContact(
        node=np.concatenate(
            [
                np.linspace(0, _UP_TO, _EQUAL + 1),
                _UP_TO * _FACTOR ** np.arange(1, _LONGER),
                [_END],
            ]
        ),
        modulus=modulus,
        relaxation_time=time,
        first=np.array(first),
        per=np.array(per),
        energy=np.log(energy),
        zone_time=np.log([_zone_time(modulus, time, rest / e, s) for s, e in enumerate(energy)]),
        surface=rest,
        length=scales.length * problem.tabor,
        force_unit=scales.force / LOAD,
        radius_unit=scales.radius / ROOT,
        of=f"{problem.geometry} on {problem.material}, {problem.traction}",
        range=f"Tabor number {groups.effective_tabor:.3g}; edges that open at {until} up to the "
        f"pull-off; times of {readable(_WINDOW[0], 's')} and more",
        fastest=fastest,
        force_band=force_band,
        work_band=work_band,
    )


def _arms(material: Any) -> tuple[Array, Array]:
    """Return moduli over the relaxed one and relaxation times [s]; one of modulus 0 if elastic."""
    shortest, longest = _WINDOW
    modes = material.retardation_modes(shortest=shortest, longest=longest, tolerance=_TOLERANCE)
    if not modes.times:
        return np.zeros(1), np.ones(1)
    total = modes.instantaneous + sum(modes.weights)
    weights = np.array(modes.weights) / total
    return reciprocal(modes.instantaneous / total, weights, np.array(modes.times))


def _zone_time(modulus: Array, time: Array, ratio: Array, side: int) -> Array:
    """Return the times in the zone with which a relaxed bulk releases or takes the surface energy.

    `ratio` is the energy of the surface over that at the edge: released by an annulus of energy 1
    that opens (side 0), taken by one that closes (side 1).
    """
    low = np.full(ratio.shape, np.log(_SHORT * time.min()))
    high = np.full(ratio.shape, np.log(_LONG * time.max()))
    for _ in range(60):
        x = np.exp((low + high) / 2)[:, None] / time
        if side == 0:
            arm = modulus / (1 + x)
            y = 1 - 1 / (1 + modulus.sum())
            # backward Euler, as the recovery of a step
            rise = y * arm.sum(1) / (1 + arm.sum(1))
            strain = (rise - y)[:, None] / (1 + x)
            lacks = (strain @ modulus) ** 2 + strain**2 @ modulus > 1 - ratio
        else:
            lacks = 1 + (1 / (1 + x)) ** 2 @ modulus > ratio
        low, high = np.where(lacks, (low + high) / 2, low), np.where(lacks, high, (low + high) / 2)
    return np.exp(high)
