r"""Conformance checks for the body under the indenter: reciprocity, energy, units, limits.

The compliance of a body, the displacement of node i under a unit force on node j for E* = 1, is
symmetric (Betti) and positive definite. If the body is stiff compared with the forces across the
gap, it detaches like a rigid one: a sphere at :math:`2 \pi R \Delta\gamma_0` (Derjaguin), a punch
at the strength of the interface.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from viscotack.cards import check_carded
from viscotack.forecast.simulation import SIMULATION
from viscotack.forecast.tiers import TIERS
from viscotack.geometry import BODIES, FlatPunch, HalfSpace, Layer, Sphere
from viscotack.geometry.hats import hat_areas
from viscotack.materials import Elastic
from viscotack.problem import Problem
from viscotack.protocol import AtDepth, Retraction
from viscotack.result.observables import pull_off_force, pull_off_stress
from viscotack.theory.elastic import indenter
from viscotack.traction import LennardJones

from . import round_trips, simulated, tiers
from .findings import Finding, Report, holds, report, rises, same

# Tolerances for the asymmetry of collocation, and for hat functions against point loads.
_DISCRETE = 0.05
_SYMMETRIES = ("revolution", "plane")
_WORK = 0.05


def check_body(body: Any, *, size: float = 1e-4, thorough: bool = True) -> Report:
    """Check the properties of a body on which the package relies.

    Parameters
    ----------
    body : Body
        A body in SI, from the package or user-defined. If it has a ``base``, its transfer function
        is checked as well.
    size : float
        Contact radius, or half width of a punch, of the checked contacts [m].
    thorough : bool
        Whether also to simulate contacts and plan a campaign, which takes seconds.

    Returns
    -------
    Report
        The findings.

    Examples
    --------
    >>> from viscotack.geometry import HalfSpace
    >>> check_body(HalfSpace(), thorough=False).passed
    True
    """
    checks = (_symmetries, _compliance, _units, _theory, _transfer, _case_file, _tiers)
    more = (_campaign, _contact) if thorough else ()
    return report(body, checks + more, size, room="bodies")


def _symmetries(body: Any, size: float) -> Iterator[Finding]:
    """Check the card, the symmetries and the decay length."""
    if type(body) not in BODIES.values():
        check_carded(type(body))
    given = body.symmetries
    known = bool(given) and set(given) <= set(_SYMMETRIES)
    yield holds("symmetries are of 'revolution' and 'plane'", known, _SYMMETRIES, given)
    length = body.decay_length
    yield holds("decay_length is not negative", length >= 0, ">= 0 m", length)


def _compliance(body: Any, size: float) -> Iterator[Finding]:
    """Check the compliance of the body."""
    nodes = size * np.linspace(0.0, 3.0, 61)
    for symmetry in body.symmetries:
        B = np.asarray(body.influence(nodes, symmetry)) / hat_areas(nodes, symmetry)
        yield holds("compliance is finite", bool(np.all(np.isfinite(B))), "numbers", "inf or nan")
        even = (B + B.T) / 2
        # the hat function at the axis is half a cone, and the last one is cut off
        off = float(np.max(np.abs((B - B.T)[2:-1, 2:-1])) / np.max(np.abs(even)))
        name = "reciprocity: compliance is symmetric"
        yield holds(name, off < _DISCRETE, f"< {_DISCRETE}", off)
        least = float(np.min(np.linalg.eigvalsh(even)) / np.max(np.abs(even)))
        yield holds("energy is positive: compliance is positive definite", least > 0, "> 0", least)
        own = float(np.min(np.diag(B)))
        yield holds("a force moves its own node into the body", own > 0, "> 0", own)


def _units(body: Any, size: float) -> Iterator[Finding]:
    """Check the body in other units of length."""
    nodes, along = size * np.linspace(0.0, 2.0, 21), 0.3 * size
    other = body.reduced(along)
    for symmetry in body.symmetries:
        G, found = body.influence(nodes, symmetry), other.influence(nodes / along, symmetry)
        scale = float(np.max(np.abs(G)))
        name = "reduced: influence with lengths in another unit"
        yield same(name, along * np.asarray(found), G, rtol=1e-9, atol=1e-9 * scale)
    length = body.decay_length
    yield same(
        "reduced: decay_length in another unit", along * other.decay_length, length, rtol=1e-9
    )


def _theory(body: Any, size: float) -> Iterator[Finding]:
    """Check the contact of a sphere without adhesion."""
    if "revolution" not in body.symmetries:
        return
    a = size * np.linspace(0.5, 1.0, 17)
    sphere: Any = {"shape": Sphere(20 * size), "body": body}
    solid: Any = {"contact_modulus": 1e6, "work_of_adhesion": 0.0}
    depth = np.asarray(indenter.bare_depth(a, **sphere))
    force = np.asarray(indenter.force(a, **sphere, **solid))
    yield rises("depth of a sphere rises with the contact radius", depth)
    yield rises("force of a sphere rises with the contact radius", force)


def _transfer(body: Any, size: float) -> Iterator[Finding]:
    """Check the transfer function of a layer."""
    base = getattr(body, "base", None)
    if base is None:
        return
    t = np.geomspace(1e-4, 50.0, 400)
    kappa = np.asarray(base.transfer(t))
    yield same("a thick layer is a half-space: transfer tends to 1", kappa[-1], 1.0, rtol=1e-3)
    thin, factor = 2 * kappa[0] / t[0], base.foundation
    name = "a thin layer is a foundation: transfer tends to c t/2"
    yield same(name, thin, factor, rtol=1e-3, atol=1e-3)
    # a bonded incompressible layer bulges, so that kappa slightly exceeds 1
    yield holds(
        "transfer is positive and at most 1",
        bool(np.all((kappa > 0) & (kappa < 1.2))),
        "0 to 1.2",
        (float(np.min(kappa)), float(np.max(kappa))),
    )
    yield rises("transfer rises with the thickness where the layer is thin", kappa[t < 0.5])


def _tables(body: Any, size: float) -> dict[str, Any]:
    numbers = round_trips.numbers_of(body)
    material: dict[str, Any] = {"model": "elastic", "rubbery_modulus": "1 MPa"}
    nu = getattr(body, "poisson_ratio", None)
    if isinstance(body, Layer):
        numbers["base"] = body.base.word
    tables: dict[str, Any] = {"material": material | {"poisson_ratio": 0.5 if nu is None else nu}}
    if "revolution" not in body.symmetries:
        tables |= {"sphere": {}, "punch": {"half_width": f"{size!r} m"}}
    return tables | {body.word: numbers}


def _case_file(body: Any, size: float) -> Iterator[Finding]:
    """Check the round trip through a case file."""
    yield from round_trips.through_case_file(body, "body", _tables(body, size))


def _tiers(body: Any, size: float) -> Iterator[Finding]:
    """Check that every tier either lists the body or rejects it with a reason."""
    if type(body) in BODIES.values():
        return
    for tier in TIERS:
        if tier.name == SIMULATION:
            continue
        case = next(case for case in tiers.problems() if tier.covers(case) == "")
        if case.geometry.symmetry in body.symmetries:
            reason = tier.covers(replace(case, body=body.reduced(size)))
            yield holds(f"{tier.name} refuses the body", "body" in reason, "its name", reason)


def _campaign(body: Any, size: float) -> Iterator[Finding]:
    """Check a plan of a campaign."""
    if isinstance(body, HalfSpace):
        return iter(())
    return round_trips.through_campaign(body, _tables(body, size))


def _contact(body: Any, size: float) -> Iterator[Finding]:
    """Check simulated contacts."""
    for problem, pull_off, name in _stiff(body, size):
        result = simulated.run(problem)
        found = pull_off(result)
        yield holds(name, 0.96 < found < 1.04, "1 within 4 %", f"{found:.4g}")
        residual = result.energy_residual
        closes = residual is not None and abs(residual) < 0.01
        yield holds("simulation: the energy audit closes", closes, "below 0.01", residual)
        yield from simulated.saved(problem, round_trips.classes_of(body))


def _stiff(body: Any, size: float) -> Iterator[tuple[Problem, Any, str]]:
    """Yield contacts stiff enough to detach like rigid ones: problem, pull-off over that, name.

    A pressure like the strength on an area like the contact moves the surface by a hundredth of the
    range h_0 of the forces, where they begin without a depth.
    """
    nu = getattr(body, "poisson_ratio", None)
    nodes = size * np.linspace(0.0, 1.0, 33)
    for symmetry in body.symmetries:
        sphere, h0 = symmetry == "revolution", 1e-3 * size
        shape = Sphere(0.5 * size**2 / h0) if sphere else FlatPunch(size)
        moved = float(np.sum(np.asarray(body.influence(nodes, symmetry))[0]))
        modulus = 100 * moved * _WORK / h0**2
        ratio = 0.5 if nu is None else nu
        solid = Elastic(rubbery_modulus=modulus * (1 - ratio**2), poisson_ratio=ratio)
        law = LennardJones(_WORK, h0)
        test = Retraction(AtDepth(0.0), 1e-6)
        problem = Problem(solid, law, shape, test, body)
        if sphere:
            name = "simulation: pull-off of a sphere from a stiff body is 2 pi R dg"
            yield problem, lambda result: pull_off_force(result) * 0.75, name
        else:
            name = "simulation: pull-off of a punch from a stiff body is the strength"
            yield problem, pull_off_stress, name
