"""Conformance checks for indenters of revolution: profile, units, contact with JKR theory."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from viscotack.cards import check_carded
from viscotack.geometry import MeasuredProfile, PowerLawProfile, detail, equivalent_radius
from viscotack.materials.branched_solids import Elastic
from viscotack.problem import Problem
from viscotack.protocol import AtForce, Retraction
from viscotack.result.observables import pull_off_force
from viscotack.theory.elastic import indenter
from viscotack.traction import LennardJones

from . import round_trips, simulated
from .findings import Finding, Report, holds, report, rises, same


def check_shape(shape: Any, *, size: float = 1e-4, thorough: bool = True) -> Report:
    """Check the properties of an indenter of revolution on which the package relies.

    Parameters
    ----------
    shape : Shape
        A shape in SI, from the package or user-defined.
    size : float
        Contact radius [m]; the profile is checked from a thousandth to ten times this radius.
    thorough : bool
        Whether also to simulate a contact and plan a campaign, which takes seconds.

    Returns
    -------
    Report
        The findings.

    Examples
    --------
    >>> from viscotack.geometry import Sphere
    >>> check_shape(Sphere(1e-3), thorough=False).passed
    True
    """
    checks = (_profile, _units, _theory, _case_file)
    more = (_campaign, _contact) if thorough else ()
    return report(shape, checks + more, size, room="shapes")


def _profile(shape: Any, size: float) -> Iterator[Finding]:
    """Check gap and flank."""
    check_carded(type(shape))
    symmetric = shape.symmetry == "revolution"
    yield holds("symmetry is 'revolution'", symmetric, "'revolution'", shape.symmetry)
    r = size * np.geomspace(1e-3, 10, 400)
    if np.isinf(detail(shape)):
        yield same("gap is 0 at the tip", shape.gap(0.0), 0.0, rtol=0, atol=1e-12 * size)
        yield rises("gap never falls outwards", shape.gap(r))
        yield rises("flank never falls outwards", shape.flank(r))
    else:
        r = np.unique(np.append(r, np.linspace(0, r[-1], int(32 * r[-1] / detail(shape)) + 2)[1:]))
        lowest = float(np.min(shape.gap(np.append(0.0, r))))
        name, atol = "gap is 0 at the lowest place", 1e-3 * float(np.asarray(shape.gap(size)))
        yield same(name, lowest, 0.0, rtol=0, atol=atol)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    half, middle = np.diff(r) / 2, (r[1:] + r[:-1]) / 2
    climbed = half * (np.asarray(shape.flank(middle[:, None] + half[:, None] * nodes)) @ weights)
    name = "flank is the derivative of the gap"
    largest = float(np.max(np.abs(shape.gap(r))))
    # a slope may have a kink
    atol = (1e-9 if np.isinf(detail(shape)) else 1e-8) * largest
    yield same(name, climbed, np.diff(shape.gap(r)), rtol=1e-4, atol=atol)
    found = np.shape(shape.gap(np.full((2, 3), size)))
    yield holds("gap: shape of the returned array", found == (2, 3), (2, 3), found)


def _units(shape: Any, size: float) -> Iterator[Finding]:
    """Check other units of length."""
    r, along, height = size * np.geomspace(1e-3, 10, 50), 0.3 * size, 2e-3 * size
    other = shape.reduced(along, height)
    name = "reduced: gap with distances and gaps in other units"
    yield same(name, height * np.asarray(other.gap(r / along)), shape.gap(r), rtol=1e-9)
    slope = height / along * np.asarray(other.flank(r / along))
    yield same("reduced: flank in other units", slope, shape.flank(r), rtol=1e-9)
    back = other.reduced(1 / along, 1 / height)
    yield same("reduced and back is the shape", back.gap(r), shape.gap(r), rtol=1e-9)


def _theory(shape: Any, size: float) -> Iterator[Finding]:
    """Check the contact without adhesion."""
    a = size * np.linspace(0.5, 1.0, 33)
    solid: Any = {"contact_modulus": 1e6, "work_of_adhesion": 0.0}
    depth = np.asarray(indenter.bare_depth(a, shape=shape))
    force = np.asarray(indenter.force(a, shape=shape, **solid))
    yield rises("contact without adhesion: depth rises with the radius", depth)
    # dF/d depth = 2 E* a, whatever the profile (Pharr, Oliver & Brotzen 1992)
    stiffness = np.diff(force) / np.diff(depth)
    name = "contact without adhesion: stiffness is 2 E* a"
    yield same(name, stiffness, 2e6 * (a[1:] + a[:-1]) / 2, rtol=2e-3)
    least, most = shape.gap(size), size * shape.flank(size)
    fits = bool(least < depth[-1] <= 2 * most)
    yield holds(
        "contact without adhesion: depth above the gap of its edge",
        fits,
        f"{least:.4g} to {2 * most:.4g} m",
        depth[-1],
    )


def _tables(shape: Any, size: float) -> dict[str, Any]:
    numbers = round_trips.numbers_of(shape)
    if isinstance(shape, PowerLawProfile):
        # given by its height at a radius, because the unit of the coefficient depends on q
        height = float(np.asarray(shape.gap(size)))
        stated = {"height": f"{height!r} m", "at_radius": f"{size!r} m"}
        numbers = {"exponent": shape.exponent} | stated
    if isinstance(shape, MeasuredProfile):
        numbers = {"points": [[f"{r!r} m", f"{z!r} m"] for r, z in shape.points]}
    return {"sphere": {}} | {shape.word: numbers}


def _case_file(shape: Any, size: float) -> Iterator[Finding]:
    """Check the round trip through a case file."""
    yield from round_trips.through_case_file(shape, "geometry", _tables(shape, size))


def _campaign(shape: Any, size: float) -> Iterator[Finding]:
    """Check a plan of a campaign."""
    return round_trips.through_campaign(shape, _tables(shape, size))


def _contact(shape: Any, size: float) -> Iterator[Finding]:
    """Check simulated contact."""
    modulus, work = 1e6, 0.05
    solid = Elastic(rubbery_modulus=0.75 * modulus, poisson_ratio=0.5)
    theory = {"shape": shape, "contact_modulus": modulus, "work_of_adhesion": work}
    a = size * np.geomspace(0.01, 3, 3000)
    pulled = -float(np.min(indenter.force(a, **theory)))
    at = float(a[np.argmin(indenter.force(a, **theory))])
    # a range so short that JKR holds within a few per cent, and that the mesh can resolve
    adhesion, part, radius = work / modulus, 0.03, at
    if np.isfinite(detail(shape)):
        part, radius = 0.1, equivalent_radius(shape, adhesion)
    gap = part * float(np.cbrt(radius * adhesion**2))
    law = LennardJones(work, gap)
    problem = Problem(solid, law, shape, Retraction(AtForce(0.0), 1e-6))
    result = simulated.run(problem)
    found = pull_off_force(result) * problem.scales().force
    yield holds(
        "simulation: pull-off at short range is near JKR for the shape",
        0.93 < found / pulled < 1.1,
        f"{pulled:.4g} N within 0.93 to 1.1",
        f"{found:.4g} N",
    )
    yield from simulated.saved(problem, round_trips.classes_of(shape))
