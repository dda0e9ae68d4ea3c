r"""Checks of a user-defined traction law, solid, shape, body or observable.

:func:`checks` returns the checks for ``pytest.mark.parametrize``; :func:`check` runs all of them,
for a notebook. A check that fails raises an AssertionError with the numbers.

Derivatives are checked as integrals between neighbouring places, because a traction or a slope may
have kinks.
"""

import json
from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.cards import cards, check_carded, with_units
from viscotack.model.geometry import FlatPunch, Layer, Sphere, detail, equivalent_radius
from viscotack.model.geometry.panels import hat_areas
from viscotack.model.materials import Elastic, StandardSolid
from viscotack.model.materials.conversion import scaled, slowed
from viscotack.model.materials.modes import FINEST, reciprocal, voigt
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_file import read_passport, write_passport
from viscotack.model.problem import Groups, Problem
from viscotack.model.problem.case_file import from_dict, to_dict
from viscotack.model.problem.nouns import known, room_of
from viscotack.model.protocol import AtDepth, AtForce, Retraction
from viscotack.model.traction import LennardJones, at_rest, effective_range, softening
from viscotack.result import Result, load, save
from viscotack.result.observables import pull_off_force, pull_off_stress, summary
from viscotack.simulate import solve
from viscotack.theory import lennard_jones
from viscotack.theory.elastic import indenter

__all__ = ["check", "checks"]

Check = Callable[[], None]

_ACCURACY = 1e-2
_WORK, _GAP = 0.05, 1e-6  # of the law in checks of other nouns [J/m^2], [m]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def checks(noun: Any, *, size: float = 1e-4, thorough: bool = True) -> list[Check]:
    """Return the checks of a law, solid, shape, body or observable.

    Parameters
    ----------
    noun : object
        A law, solid, shape or body in SI, or an observable. Of a law that grows or ages, the law at
        rest is checked.
    size : float
        Contact radius, or half width of a punch, at which a shape or a body is checked [m].
    thorough : bool
        Whether also to simulate contacts, which takes seconds.

    Returns
    -------
    list of callable
        Functions without arguments, each with a name.

    Raises
    ------
    InputError
        If a member is missing; the message names it.

    Examples
    --------
    In a test file::

        @pytest.mark.parametrize("check", checks(MyLaw(0.15, 0.5e-6, steepness=3.0)))
        def test_my_law(check):
            check()

    >>> from viscotack.model.geometry import Sphere
    >>> [check.__name__ for check in checks(Sphere(1e-3), thorough=False)]
    ['profile', 'shape_units', 'contact_without_adhesion', 'case_file']
    """
    if hasattr(noun, "function"):
        found = [observable_labels, *([observable_values] if thorough else [])]
    else:
        formulas, simulated = _CHECKS[room_of(type(noun))]
        found = [*formulas, case_file, *(simulated if thorough else ())]
    return [_bound(each, noun, size) for each in found]


def check(noun: Any, *, size: float = 1e-4, thorough: bool = True) -> None:
    """Run all checks of a noun; the parameters are those of :func:`checks`.

    Raises
    ------
    AssertionError
        With every check that failed.

    Examples
    --------
    >>> from viscotack import LennardJones
    >>> check(LennardJones(0.05, 1e-9), thorough=False)
    """
    failures = []
    for each in checks(noun, size=size, thorough=thorough):
        try:
            each()
        except Exception as error:
            failures.append(f"{each.__name__}: {type(error).__name__}: {str(error).strip()}")
    if failures:
        raise AssertionError("\n\n".join([f"{noun!r:.200} fails", *failures]))


def _bound(function: Callable[[Any, float], None], noun: Any, size: float) -> Check:
    @wraps(function)
    def run() -> None:
        with np.errstate(all="ignore"):
            function(noun, size)

    return run


def _holds(truth: Any, words: str) -> None:
    if not truth:  # `assert` would be skipped by python -O
        raise AssertionError(words)


def _same(words: str, found: Any, expected: Any, *, rtol: float = 0.0, atol: float = 0.0) -> None:
    np.testing.assert_allclose(found, expected, rtol=rtol, atol=atol, err_msg=words)


def _rises(words: str, values: npt.ArrayLike) -> None:
    v = np.asarray(values, dtype=float)
    fall, largest = np.max(-np.diff(v), initial=0.0), np.max(np.abs(v))
    within = fall <= 1e-12 * largest and np.all(np.isfinite(v))
    _holds(within, f"{words}: falls by {fall:.4g} in values up to {largest:.4g}")


def _integrals(function: Callable[[Any], Any], x: Any) -> Any:
    """Return the integrals of a function between neighbouring places."""
    half, middle = np.diff(x) / 2, (x[1:] + x[:-1]) / 2
    return half * (np.asarray(function(middle[:, None] + half[:, None] * _NODES)) @ _WEIGHTS)


def _simulated(problem: Any, accuracy: float = _ACCURACY) -> Result:
    result = solve(problem, until="pull-off", accuracy=accuracy, estimate_error=False)
    residual = result.energy_residual
    closes = residual is None or abs(residual) < 0.02
    _holds(closes, f"the energy audit of a simulation has a residual of {residual}, above 0.02")
    return result


# --- laws -----------------------------------------------------------------------------------------


def _gaps(law: Any) -> Any:
    """Return gaps from compressed to far apart, finer where the law may be discontinuous."""
    beyond = np.concatenate([np.linspace(0, 4, 1600), np.geomspace(4, 1e3, 300)[1:]])
    gaps = [np.linspace(0.6, 0.999, 200), 1 + effective_range(law) * beyond]
    return law.equilibrium_gap * np.concatenate(gaps)


def derivatives(law: Any, size: float) -> None:
    """Check that traction and stiffness are derivatives; the traction does the work of adhesion."""
    law = at_rest(law)
    h, s = _gaps(law), law.strength
    energy, traction, beyond = law.energy(h), law.traction(h), law.energy_beyond(h)
    _same(
        "traction is the derivative of the energy by the gap",
        _integrals(law.traction, h),
        np.diff(energy),
        rtol=1e-3,
        atol=2e-5 * np.max(np.abs(energy)),
    )
    work = np.sum(_integrals(law.traction, h[h >= law.equilibrium_gap])) - law.energy(h[-1])
    words = "the traction does the work of adhesion from h0 to infinity"
    _same(words, work, law.work_of_adhesion, rtol=2e-3)
    _same(
        "stiffness is the derivative of the traction by the gap",
        _integrals(law.stiffness, h),
        np.diff(traction),
        rtol=2e-2,
        atol=max(2e-2 * s, 1e-4 * np.max(np.abs(traction))),
    )
    _same(
        "energy_beyond is the integral of the energy to infinity",
        _integrals(law.energy, h),
        -np.diff(beyond),
        rtol=1e-3,
        atol=2e-5 * np.max(np.abs(beyond)),
    )


def law_limits(law: Any, size: float) -> None:
    """Check the law at its equilibrium gap, at its peak and far apart."""
    law = at_rest(law)
    h0, w, s, reach = law.equilibrium_gap, law.work_of_adhesion, law.strength, effective_range(law)
    _holds(0 < softening(law) < np.inf, "the tension must fall beyond its peak")
    _same("energy at h0 is minus the work of adhesion", law.energy(h0), -w, rtol=1e-6)
    _same("traction at h0 is 0", law.traction(h0), 0.0, atol=1e-6 * s)
    below = np.max(law.traction(h0 * np.linspace(0.7, 0.999, 100)))
    _holds(below < 0, f"surfaces must repel below h0, found a traction of {below:.4g} Pa")
    far = 1e4 * h0 * max(1.0, reach)
    _same("energy far apart is 0", law.energy(far), 0.0, atol=1e-6 * w)
    _same("energy_beyond far apart is 0", law.energy_beyond(far), 0.0, atol=1e-3 * w * h0)
    largest = np.max(law.traction(_gaps(law)))
    words = f"strength is {s:.8g} Pa, the largest traction {largest:.8g} Pa"
    _holds(s * (1 - 1e-2) <= largest <= s * (1 + 1e-9), words)
    _same("traction at edge_gap is the strength", law.traction(law.edge_gap), s, rtol=1e-6)


def law_units(law: Any, size: float) -> None:
    """Check that the reduced law has work 1 and gap 1, and is the same law."""
    law = at_rest(law)
    r, w, h0 = law.reduced(), law.work_of_adhesion, law.equilibrium_gap
    _same("reduced: work and gap", (r.work_of_adhesion, r.equilibrium_gap), 1.0, rtol=1e-12)
    x = np.array([[0.8, 1.0, 1.1], [1.5, 3.0, 10.0]])
    units = {"traction": w / h0, "energy": w, "energy_beyond": w * h0, "stiffness": w / h0**2}
    for name, unit in units.items():
        found, expected = getattr(r, name)(x), np.asarray(getattr(law, name)(x * h0)) / unit
        atol = 1e-9 * float(np.max(np.abs(expected)))
        _same(f"{name} of the reduced law", found, expected, rtol=1e-9, atol=atol)


def law_contacts(law: Any, size: float) -> None:
    """Check that a simulated sphere is near JKR at short range, and near Bradley at long range."""
    law = at_rest(law).reduced()
    solid, reach = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0), effective_range(law)
    for tabor, start, low, high in ((5.0, 0.0, 0.97, 1.06), (0.05, -0.5, 1.27, 1.35)):
        groups = Groups(tabor * reach, solid, AtForce(start), 1.0, law)
        force = pull_off_force(_simulated(groups))
        words = f"pull-off force {force:.4g} at an effective Tabor number of {tabor}"
        _holds(low <= force <= high, f"{words}, expected {low} to {high}")


# --- solids ---------------------------------------------------------------------------------------


def plateaus(m: Any, size: float) -> None:
    """Check that the functions go from the glassy to the rubbery modulus."""
    E0, Einf, nu = m.rubbery_modulus, m.glassy_modulus, m.poisson_ratio
    _holds(0 < E0 <= Einf, f"moduli must be 0 < rubbery <= glassy, got {E0} and {Einf}")
    _same("modulus_ratio is rubbery over glassy", m.modulus_ratio, E0 / Einf, rtol=1e-12)
    _same("contact_modulus is E0/(1 - nu^2)", m.contact_modulus, E0 / (1 - nu**2), rtol=1e-12)
    _holds(0 < m.time_unit < np.inf, f"time_unit must be positive, got {m.time_unit} s")
    ends = np.array([0.0, np.inf])
    _same("creep at 0 and infinity", m.creep(ends), (1 / Einf, 1 / E0), rtol=1e-9)
    _same("relaxation at 0 and infinity", m.relaxation(ends), (Einf, E0), rtol=1e-9)
    _same("complex modulus at 0 and infinity", m.complex_modulus(ends), (E0, Einf), rtol=1e-9)
    if "glassy_modulus" in cards(type(m)):
        flat, t = replace(m, glassy_modulus=E0), m.time_unit * np.geomspace(1e-3, 1e3, 61)
        _same("equal plateaus: creep", flat.creep(t), 1 / E0, rtol=1e-9)
        _same("equal plateaus: complex modulus", flat.complex_modulus(1 / t), E0, rtol=1e-9)


def array_shapes(m: Any, size: float) -> None:
    """Check that returned arrays have the shape of the argument."""
    for name in ("creep", "relaxation", "complex_modulus", "complex_compliance"):
        for shape in ((2, 3), ()):
            found = np.shape(getattr(m, name)(np.full(shape, m.time_unit)))
            _holds(found == shape, f"{name} of times of shape {shape} has the shape {found}")


def monotone(m: Any, size: float) -> None:
    """Check that creep never falls, relaxation never rises, and their product is at most 1."""
    t = m.time_unit * np.geomspace(1e-12, 1e12, 241)
    C, R = np.asarray(m.creep(t)), np.asarray(m.relaxation(t))
    _rises("creep", C)
    _rises("minus the relaxation", -R)
    product = np.max(C * R)
    _holds(product <= 1 + 1e-8, f"relaxation times creep must be at most 1, found {product}")


def passive(m: Any, size: float) -> None:
    """Check that modulus and compliance are inverse, the loss positive, the storage rising."""
    w = np.geomspace(1e-10, 1e10, 241) / m.time_unit
    E, C = np.asarray(m.complex_modulus(w)), np.asarray(m.complex_compliance(w))
    _same("modulus times compliance is 1", E * C, 1.0, rtol=1e-8)
    # in the elastic limit the loss may be negative by round-off of the storage modulus
    loss = np.min(np.imag(E) / np.real(E))
    _holds(loss >= -1e-14, f"the loss modulus must not be negative, found {loss:.4g} E'")
    _rises("storage modulus with frequency", np.real(E))


def modes(m: Any, size: float) -> None:
    """Check that the modes of the creep keep to their stated error."""
    unit, k = m.time_unit, m.modulus_ratio
    for low, high in ((1e-6, 1e3), (1e-3, 1.0)):
        t = unit * np.geomspace(low, high, 400)
        expected = m.rubbery_modulus * np.asarray(m.creep(t))
        for tolerance in (1e-2, 1e-4, 1e-7):
            found = m.retardation_modes(shortest=t[0], longest=t[-1], tolerance=tolerance)
            where = f"modes from {low:g} to {high:g} time units, tolerance {tolerance:g}"
            _same(f"{where}: creep", found.creep(t), expected, atol=found.error + 1e-12)
            fits = found.error <= tolerance * (1 + 1e-9)
            _holds(fits, f"{where}: the stated error is {found.error}")
            total = found.instantaneous + sum(found.weights)
            _same(f"{where}: sum of the compliances", total, 1.0, rtol=1e-9)
            _holds(min(found.weights, default=1) > 0, f"{where}: weights {found.weights} > 0")
            ascend = np.all(np.diff((0.0, *found.times)) > 0)
            _holds(ascend, f"{where}: times must be positive and ascend, got {found.times}")
    # the tolerance of crack theories
    found = m.retardation_modes(shortest=1e-13 * unit, longest=1e9 * unit, tolerance=1e-14 * k)
    _holds(found.error <= FINEST, f"modes at tolerance 1e-14 k: error {found.error} > {FINEST}")


def transforms(m: Any, size: float) -> None:
    """Check that creep, relaxation and complex compliance are of one solid."""
    unit, E0 = m.time_unit, m.rubbery_modulus
    tolerance = max(1e-6 * m.modulus_ratio, FINEST)
    found = m.retardation_modes(shortest=1e-14 * unit, longest=1e14 * unit, tolerance=tolerance)
    if not found.times:
        return  # for an elastic solid the limits are sufficient
    weights, times = np.array(found.weights), np.array(found.times)
    t = unit * np.geomspace(1e-6, 1e6, 61)
    expected = (found.instantaneous + voigt(1 / t[:, None] * times) @ weights) / E0
    words = "complex compliance is the transform of the creep"
    _same(words, m.complex_compliance(1 / t), expected, rtol=1e-4)
    stiff, relaxing = reciprocal(found.instantaneous, weights, times)
    expected = E0 * (1 + np.exp(-t[:, None] / relaxing) @ stiff)
    _same("relaxation is the reciprocal of the creep", m.relaxation(t), expected, rtol=1e-3)


def solid_units(m: Any, size: float) -> None:
    """Check that the reduced solid, and that in other units, are the same solid."""
    r, t = m.reduced(), np.geomspace(1e-6, 1e6, 49)
    numbers = (r.rubbery_modulus, r.time_unit, r.poisson_ratio)
    _same("reduced: rubbery modulus, time unit, Poisson ratio", numbers, (1, 1, 0))
    creep = np.asarray(m.creep(t * m.time_unit))
    _same("creep of the reduced solid", r.creep(t), m.rubbery_modulus * creep, rtol=1e-9)
    other = 3.0 * np.asarray(scaled(m, modulus=3.0, time=7.0).creep(7.0 * t * m.time_unit))
    _same("creep in other units, by the cards", other, creep, rtol=1e-9)
    w = t / m.time_unit
    slow, expected = slowed(m, 50.0).complex_modulus(w), m.complex_modulus(50 * w)
    _same("times longer by 50 are frequencies higher by 50", slow, expected, rtol=1e-9)


def passport(m: Any, size: float) -> None:
    """Check that a passport is read back as the same solid."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "passport.toml"
        write_passport(Passport(name="a solid", material=m), path)
        back = read_passport(path, also=_own(m)).material
    _holds(back == m, f"the passport of {m} is read as {back}")


def solid_contact(m: Any, size: float) -> None:
    """Check that the simulated pull-off is between its limits, and the same in SI."""
    groups = Groups(1.0, m.reduced(), AtForce(2.0), 3.0, LennardJones(1.0, 1.0))
    force, k = pull_off_force(_simulated(groups)), groups.modulus_ratio
    slow, fast = (float(lennard_jones.pull_off_ratio(x)) for x in (1.0, k ** (1 / 3)))
    words = f"pull-off force {force:.4g}, expected {slow:.4g} to {fast / k:.4g}"
    _holds(0.97 * slow <= force <= 1.03 * fast / k, words)
    problem = groups.in_si(
        radius=2e-3,
        contact_modulus=m.contact_modulus,
        work_of_adhesion=0.03,
        time_unit=0.7,
        poisson_ratio=m.poisson_ratio,
    )
    found = pull_off_force(_simulated(problem))
    _same("the dimensionless force of the problem in SI", found, force, rtol=1e-6)


# --- shapes ---------------------------------------------------------------------------------------


def profile(shape: Any, size: float) -> None:
    """Check that the flank is the slope of the gap, which is 0 at its lowest place."""
    _holds(shape.symmetry == "revolution", f"symmetry must be 'revolution', not {shape.symmetry!r}")
    r, smooth = size * np.geomspace(1e-3, 10, 400), np.isinf(detail(shape))
    if smooth:
        _same("gap at the tip", shape.gap(0.0), 0.0, atol=1e-12 * size)
        _rises("gap outwards", shape.gap(r))
        _rises("flank outwards", shape.flank(r))
    else:
        r = np.union1d(r, np.linspace(0, r[-1], int(32 * r[-1] / detail(shape)) + 2)[1:])
        atol = 1e-3 * float(shape.gap(size))
        _same("lowest gap", np.min(shape.gap(np.append(0.0, r))), 0.0, atol=atol)
    gap = np.asarray(shape.gap(r))
    atol = (1e-9 if smooth else 1e-8) * np.max(np.abs(gap))  # a slope may have a kink
    words = "flank is the derivative of the gap"
    _same(words, _integrals(shape.flank, r), np.diff(gap), rtol=1e-4, atol=atol)


def shape_units(shape: Any, size: float) -> None:
    """Check that the shape in other units of distance and height is the same shape."""
    r, along, height = size * np.geomspace(1e-3, 10, 50), 0.3 * size, 2e-3 * size
    other = shape.reduced(along, height)
    gap, flank = np.asarray(shape.gap(r)), np.asarray(shape.flank(r))
    _same("reduced: gap", other.gap(r / along), gap / height, rtol=1e-9)
    _same("reduced: flank", other.flank(r / along), flank * along / height, rtol=1e-9)
    _same("reduced and back: gap", other.reduced(1 / along, 1 / height).gap(r), gap, rtol=1e-9)


def contact_without_adhesion(shape: Any, size: float) -> None:
    """Check that the stiffness without adhesion is 2 E* a (Pharr, Oliver & Brotzen 1992)."""
    a = size * np.linspace(0.5, 1.0, 33)
    depth = np.asarray(indenter.bare_depth(a, shape=shape))
    force = indenter.force(a, shape=shape, contact_modulus=1e6, work_of_adhesion=0.0)
    _rises("depth with the contact radius", depth)
    stiffness, expected = np.diff(force) / np.diff(depth), 1e6 * (a[1:] + a[:-1])
    _same("stiffness without adhesion is 2 E* a", stiffness, expected, rtol=2e-3)
    least, most = float(shape.gap(size)), 2 * size * float(shape.flank(size))
    words = f"depth {depth[-1]:.4g} m without adhesion, expected {least:.4g} to {most:.4g} m"
    _holds(least < depth[-1] <= most, words)


def shape_contact(shape: Any, size: float) -> None:
    """Check that a simulated pull-off at short range is near JKR for the shape."""
    modulus = 1e6
    a = size * np.geomspace(0.01, 3, 3000)
    force = indenter.force(a, shape=shape, contact_modulus=modulus, work_of_adhesion=_WORK)
    # a range so short that JKR holds within a few per cent, and that the mesh can resolve
    part, radius = 0.03, float(a[np.argmin(force)])
    if np.isfinite(detail(shape)):
        part, radius = 0.1, equivalent_radius(shape, _WORK / modulus)
    law = LennardJones(_WORK, part * float(np.cbrt(radius * (_WORK / modulus) ** 2)))
    solid = Elastic(rubbery_modulus=0.75 * modulus, poisson_ratio=0.5)
    problem = Problem(solid, law, shape, Retraction(AtForce(0.0), 1e-6))
    ratio = pull_off_force(_simulated(problem)) * problem.scales().force / -np.min(force)
    _holds(0.93 < ratio < 1.1, f"pull-off force over that of JKR is {ratio:.4g}, not 0.93 to 1.1")


# --- bodies ---------------------------------------------------------------------------------------


def compliance(body: Any, size: float) -> None:
    """Check that the compliance is symmetric (Betti) and positive definite."""
    given = body.symmetries
    known_words = given and set(given) <= {"revolution", "plane"}
    _holds(known_words, f"symmetries must be of 'revolution' and 'plane', got {given}")
    _holds(body.decay_length >= 0, f"decay_length is negative: {body.decay_length}")
    nodes = size * np.linspace(0.0, 3.0, 61)
    for symmetry in given:
        B = np.asarray(body.influence(nodes, symmetry)) / hat_areas(nodes, symmetry)
        even, largest = (B + B.T) / 2, np.max(np.abs(B))
        # hats of collocation are not points; that at the axis is half a cone, the last one cut off
        inner = slice(2, -1), slice(2, -1)
        _same("compliance is symmetric", B[inner], B.T[inner], atol=0.05 * largest)
        least = np.min(np.linalg.eigvalsh(even)) / largest
        _holds(least > 0, f"compliance must be positive definite, lowest eigenvalue {least:.4g}")


def body_units(body: Any, size: float) -> None:
    """Check that the body in another unit of length is the same body."""
    nodes, along = size * np.linspace(0.0, 2.0, 21), 0.3 * size
    other = body.reduced(along)
    for symmetry in body.symmetries:
        G = np.asarray(body.influence(nodes, symmetry)) / along
        found, atol = other.influence(nodes / along, symmetry), 1e-9 * float(np.max(np.abs(G)))
        _same("reduced: influence", found, G, rtol=1e-9, atol=atol)
    length = body.decay_length / along
    _same("reduced: decay_length", other.decay_length, length, rtol=1e-9)


def sphere_on_body(body: Any, size: float) -> None:
    """Check that depth and force of a sphere without adhesion rise with the contact radius."""
    if "revolution" in body.symmetries:
        a, sphere = size * np.linspace(0.5, 1.0, 17), Sphere(20 * size)
        _rises("depth of a sphere", indenter.bare_depth(a, shape=sphere, body=body))
        solid = {"contact_modulus": 1e6, "work_of_adhesion": 0.0}
        _rises("force of a sphere", indenter.force(a, shape=sphere, body=body, **solid))


def body_contact(body: Any, size: float) -> None:
    """Check that a stiff body detaches like a rigid one.

    A sphere does so at 2 pi R dg (Derjaguin), a punch at the strength. A pressure like the strength
    moves the surface of a stiff body by a hundredth of the range of the forces.
    """
    nodes, h0 = size * np.linspace(0.0, 1.0, 33), 1e-3 * size
    nu = getattr(body, "poisson_ratio", None)
    nu = 0.5 if nu is None else nu
    for symmetry in body.symmetries:
        moved = float(np.sum(np.asarray(body.influence(nodes, symmetry))[0]))
        modulus = 100 * moved * _WORK / h0**2 * (1 - nu**2)
        solid = Elastic(rubbery_modulus=modulus, poisson_ratio=nu)
        punch = symmetry == "plane"
        shape = FlatPunch(size) if punch else Sphere(0.5 * size**2 / h0)
        test = Retraction(AtDepth(0.0), 1e-6)
        result = _simulated(Problem(solid, LennardJones(_WORK, h0), shape, test, body))
        ratio = pull_off_stress(result) if punch else 0.75 * pull_off_force(result)
        words = f"pull-off of a {shape.word} from a stiff body over that from a rigid one"
        _holds(0.96 < ratio < 1.04, f"{words} is {ratio:.4g}, not 1 within 4 %")


# --- all four -------------------------------------------------------------------------------------


def _own(noun: Any) -> tuple[type, ...]:
    """Return the class of a noun if it is user-defined, for ``also=``."""
    classes = getattr(known(), room_of(type(noun)))
    return () if type(noun) in classes.values() else (type(noun),)


def case_file(noun: Any, size: float) -> None:
    """Check that a case file and JSON with the noun are read back as the same problem."""
    room, nu = room_of(type(noun)), getattr(noun, "poisson_ratio", None)
    for kind in _own(noun):
        check_carded(kind)
    plane = room == "bodies" and "revolution" not in noun.symmetries
    solid = Elastic(rubbery_modulus=1e6, poisson_ratio=0.5 if nu is None else nu)
    parts: dict[str, Any] = {
        "material": solid,
        "traction": LennardJones(_WORK, _GAP),
        "geometry": FlatPunch(size) if plane else Sphere(1e-3),
        "protocol": Retraction(AtDepth(1e-6), 1e-5),
    }
    fields = {"laws": "traction", "materials": "material", "shapes": "geometry", "bodies": "body"}
    problem = Problem(**parts | {fields[room]: noun})
    record = json.loads(json.dumps(to_dict(problem)))
    back = from_dict(record, also=_own(noun))
    _holds(back == problem, f"JSON: {noun} is read as {getattr(back, fields[room])}")
    if isinstance(noun, Layer):
        return
    # numbers of a file have units
    name = {"laws": "interface", "materials": "material"}.get(room, getattr(noun, "word", ""))
    record[name] = record.get(name, {}) | with_units(noun)
    back = getattr(from_dict(record, also=_own(noun)), fields[room])
    _holds(back == noun, f"case file: {noun} is read as {back}")


# --- observables ----------------------------------------------------------------------------------


def observable_labels(observable: Any, size: float) -> None:
    """Check that name, words and measure are known ones."""
    measures = {"force", "depth", "radius", "speed", "work", "time", "1"}
    _holds(observable.name.isidentifier(), f"name must be an identifier: {observable.name!r}")
    _holds(observable.words.strip(), "words must describe the number")
    _holds(observable.measure in measures, f"measure {observable.measure!r} is not of {measures}")


def observable_values(observable: Any, size: float) -> None:
    """Check the number in SI, at a finer accuracy, after saving, and in the summary."""
    solid = StandardSolid(rubbery_modulus=1.0, glassy_modulus=5.0, tau0=1.0, poisson_ratio=0.0)
    groups, of = Groups(1.0, solid, AtForce(2.0), 1.0), observable.function
    problem = groups.in_si(
        radius=2e-3, contact_modulus=3e6, work_of_adhesion=0.03, time_unit=0.7, poisson_ratio=0.4
    )
    result = _simulated(groups)
    value = of(result)
    _holds(np.isfinite(value), f"the number must be finite, got {value}")
    _same("in SI", of(_simulated(problem)), value, rtol=1e-6, atol=1e-9)
    fine = of(_simulated(groups, _ACCURACY / 5))
    _same("at an accuracy five times finer", fine, value, rtol=0.05, atol=1e-6)
    with TemporaryDirectory() as folder:
        save(result, Path(folder) / "run.npz")
        _same("saved", of(load(Path(folder) / "run.npz")), value, rtol=1e-12)
    told = summary(result, also=(observable,))[observable.name]
    _same("in the summary", told, value, rtol=1e-12)


# Room -> checks of formulas, and checks that simulate.
_CHECKS: dict[str, tuple[tuple[Callable[[Any, float], None], ...], tuple[Any, ...]]] = {
    "laws": ((derivatives, law_limits, law_units), (law_contacts,)),
    "materials": (
        (plateaus, array_shapes, monotone, passive, modes, transforms, solid_units, passport),
        (solid_contact,),
    ),
    "shapes": ((profile, shape_units, contact_without_adhesion), (shape_contact,)),
    "bodies": ((compliance, body_units, sphere_on_body), (body_contact,)),
}
