r"""Conformance checks for linear viscoelastic materials.

The relaxation modulus R falls monotonically from the glassy to the rubbery modulus, and the creep
compliance C rises monotonically from 1/glassy to 1/rubbery; R(t) C(t) <= 1; E*(w) C*(w) = 1, both
with non-negative loss (Christensen, Theory of Viscoelasticity, 2nd ed. (1982), chapters 1 and 4).
C is a sum of exponentials with positive weights within the stated error.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.cards import cards, check_carded
from viscotack.materials.conversion import slowed
from viscotack.materials.interconversion import reciprocal
from viscotack.materials.modes import FINEST, voigt
from viscotack.materials.passport import Passport
from viscotack.materials.passport_file import read_passport, write_passport
from viscotack.materials.scaling import scaled
from viscotack.operations.declare.questions import material_numbers
from viscotack.problem import Groups
from viscotack.protocol import AtForce
from viscotack.traction import LennardJones

from . import round_trips, simulated
from .findings import Finding, Report, holds, report, rises, same

_TOLERANCES = (1e-2, 1e-4, 1e-7)
# Equilibrium gap of the law of a rough surface [m].
_GAP = 1e-6


def check_material(material: Any, *, thorough: bool = True) -> Report:
    """Check the identities, limits and bounds of a material on which the package relies.

    Parameters
    ----------
    material : Material
        A material in SI, from the package or user-defined, with any numbers allowed by its cards.
    thorough : bool
        Whether also to simulate contacts and evaluate the theories, which takes seconds to a
        minute. Without it the checks of formulas and round trips take a fraction of a second.

    Returns
    -------
    Report
        The findings.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> check_material(solid, thorough=False).passed
    True
    """
    checks = (
        _constants, _limits, _elastic_limit, _shapes_of_answers, _in_time, _in_frequency, _modes,
        _finest_modes, _transforms, _reduced, _units, _case_file,
        _flags, _campaign, _passport,
    )  # fmt: skip
    checks += (_contacts, _theories) if thorough else ()
    return report(material, checks, room="materials")


def _times(m: Any, decades: float = 12) -> Any:
    return m.time_unit * np.geomspace(10.0**-decades, 10.0**decades, 241)


def _constants(m: Any) -> Iterator[Finding]:
    """Check the constants of the solid."""
    E0, Einf, nu = m.rubbery_modulus, m.glassy_modulus, m.poisson_ratio
    yield holds("moduli: 0 < rubbery <= glassy", 0 < E0 <= Einf, "0 < E0 <= Einf", (E0, Einf))
    yield same("modulus_ratio is rubbery over glassy", m.modulus_ratio, E0 / Einf, rtol=1e-12)
    yield same("contact_modulus is E0/(1 - nu^2)", m.contact_modulus, E0 / (1 - nu**2), rtol=1e-12)
    yield holds("Poisson ratio lies in [0, 0.5]", 0 <= nu <= 0.5, "[0, 0.5]", nu)
    yield holds("time_unit is positive", 0 < m.time_unit < np.inf, "a time > 0 s", m.time_unit)
    check_carded(type(m))


def _limits(m: Any) -> Iterator[Finding]:
    """Check the limits in time and frequency."""
    E0, Einf = m.rubbery_modulus, m.glassy_modulus
    yield same("creep starts at 1/glassy_modulus", m.creep(0.0), 1 / Einf, rtol=1e-9)
    yield same("creep ends at 1/rubbery_modulus", m.creep(np.inf), 1 / E0, rtol=1e-9)
    yield same("relaxation starts at glassy_modulus", m.relaxation(0.0), Einf, rtol=1e-9)
    yield same("relaxation ends at rubbery_modulus", m.relaxation(np.inf), E0, rtol=1e-9)
    yield same("complex modulus at rest is rubbery_modulus", m.complex_modulus(0.0), E0, rtol=1e-9)
    fast = m.complex_modulus(np.inf)
    yield same("complex modulus at infinity is glassy_modulus", fast, Einf, rtol=1e-9)


def _elastic_limit(m: Any) -> Iterator[Finding]:
    """Check the limit of equal plateaus."""
    if "glassy_modulus" not in cards(type(m)):
        return
    flat = replace(m, glassy_modulus=m.rubbery_modulus)
    E0, t = m.rubbery_modulus, _times(m, 3)
    yield same("equal plateaus: creep is 1/rubbery_modulus", flat.creep(t), 1 / E0, rtol=1e-9)
    found = flat.complex_modulus(1 / t)
    yield same("equal plateaus: complex modulus is rubbery_modulus", found, E0, rtol=1e-9)


def _shapes_of_answers(m: Any) -> Iterator[Finding]:
    """Check that returned arrays have the shape of the argument."""
    t = m.time_unit * np.array([[0.1, 1.0, 10.0], [0.2, 2.0, 20.0]])
    for name in ("creep", "relaxation", "complex_modulus", "complex_compliance"):
        function = getattr(m, name)
        found = np.shape(function(t)), np.shape(function(m.time_unit))
        expected = (t.shape, ())
        yield holds(f"{name}: shape of the returned array", found == expected, expected, found)


def _in_time(m: Any) -> Iterator[Finding]:
    """Check creep and relaxation in time."""
    t = _times(m)
    C, R = np.asarray(m.creep(t)), np.asarray(m.relaxation(t))
    yield rises("creep never falls with time", C)
    yield rises("relaxation never rises with time", -R)
    product = float(np.max(C * R))
    yield holds("relaxation times creep is at most 1", product <= 1 + 1e-8, "<= 1", product)


def _in_frequency(m: Any) -> Iterator[Finding]:
    """Check complex modulus and compliance."""
    w = 1 / _times(m, 10)
    E = np.asarray(m.complex_modulus(w), dtype=complex)
    C = np.asarray(m.complex_compliance(w), dtype=complex)
    yield same("modulus times compliance is 1", E * C, 1.0, rtol=1e-8)
    # in the elastic limit the loss may be negative by round-off of the storage modulus
    loss = float(np.min(np.imag(E) / np.real(E)))
    yield holds("passive: the loss modulus is not negative", loss >= -1e-14, "E'' >= 0", loss)
    loss = float(np.min(-np.imag(C) / np.real(C)))
    yield holds("passive: the loss compliance is not negative", loss >= -1e-14, "C'' >= 0", loss)
    yield rises("storage modulus rises with frequency", np.real(E)[::-1])


def _modes(m: Any) -> Iterator[Finding]:
    """Check the exponential modes of the creep."""
    unit, E0 = m.time_unit, m.rubbery_modulus
    for low, high in ((1e-6, 1e3), (1e-3, 1.0)):
        t = unit * np.geomspace(low, high, 400)
        for tolerance in _TOLERANCES:
            modes = m.retardation_modes(shortest=t[0], longest=t[-1], tolerance=tolerance)
            name = f"modes from {low:g} to {high:g} time units, tolerance {tolerance:g}"
            missed = float(np.max(np.abs(modes.creep(t) - E0 * np.asarray(m.creep(t)))))
            allowed = modes.error + 1e-12
            yield holds(f"{name}: error", missed <= allowed, f"<= stated {allowed:.3g}", missed)
            fits = modes.error <= tolerance * (1 + 1e-9)
            yield holds(f"{name}: stated error", fits, f"<= {tolerance:g}", modes.error)
            total = modes.instantaneous + sum(modes.weights)
            yield same(f"{name}: the compliances sum to 1", total, 1.0, rtol=1e-9)
            positive = min(modes.weights, default=1.0) > 0
            yield holds(f"{name}: weights are positive", positive, "> 0", modes.weights)
            ascending = bool(np.all(np.diff((0.0, *modes.times)) > 0))
            yield holds(f"{name}: times are positive and ascend", ascending, "> 0", modes.times)


def _finest_modes(m: Any) -> Iterator[Finding]:
    """Check modes at the tolerance that crack theories use."""
    unit, k = m.time_unit, m.modulus_ratio
    modes = m.retardation_modes(shortest=1e-13 * unit, longest=1e9 * unit, tolerance=1e-14 * k)
    name = "modes at the tolerance 1e-14 k of crack theories: stated error"
    yield holds(name, modes.error <= FINEST, f"<= {FINEST:g}", modes.error)


def _transforms(m: Any) -> Iterator[Finding]:
    """Check that creep, relaxation and complex functions are one solid."""
    unit, k, E0 = m.time_unit, m.modulus_ratio, m.rubbery_modulus
    tolerance = max(1e-6 * k, FINEST)
    modes = m.retardation_modes(shortest=1e-14 * unit, longest=1e14 * unit, tolerance=tolerance)
    weights, times = np.array(modes.weights), np.array(modes.times)
    if not times.size:
        return  # for an elastic solid the limits are sufficient
    w = np.geomspace(1e-6, 1e6, 61) / unit
    expected = (modes.instantaneous + voigt(w[:, None] * times) @ weights) / E0
    found = m.complex_compliance(w)
    yield same("complex compliance is the transform of the creep", found, expected, rtol=1e-4)
    t = unit * np.geomspace(1e-6, 1e6, 61)
    stiff, relaxing = reciprocal(modes.instantaneous, weights, times)
    expected = E0 * (1 + np.exp(-t[:, None] / relaxing) @ stiff)
    found = m.relaxation(t)
    yield same("relaxation is the reciprocal of the creep", found, expected, rtol=1e-3)


def _reduced(m: Any) -> Iterator[Finding]:
    """Check the dimensionless form."""
    r, t = m.reduced(), np.geomspace(1e-6, 1e6, 49)
    numbers = (r.rubbery_modulus, r.time_unit, r.poisson_ratio)
    yield same(
        "reduced: rubbery modulus 1, time unit 1, Poisson ratio 0", numbers, (1, 1, 0), rtol=0
    )
    yield same("reduced: same modulus ratio", r.modulus_ratio, m.modulus_ratio, rtol=1e-12)
    expected = m.rubbery_modulus * np.asarray(m.creep(t * m.time_unit))
    yield same("reduced: creep in units of modulus and time", r.creep(t), expected, rtol=1e-9)


def _units(m: Any) -> Iterator[Finding]:
    """Check the conversion to other units of modulus and time by the cards."""
    t, w = _times(m, 6), 1 / _times(m, 6)
    other = scaled(m, modulus=3.0, time=7.0)
    found = 3.0 * np.asarray(other.creep(7.0 * t))
    yield same("units: creep in other units, by the cards", found, m.creep(t), rtol=1e-9)
    found = slowed(m, 50.0).complex_modulus(w)
    yield same(
        "time shift: slower by 50 is 50 times the frequency",
        found,
        m.complex_modulus(50 * w),
        rtol=1e-9,
    )


def _tables(m: Any) -> dict[str, Any]:
    return {"material": {"model": m.word} | round_trips.numbers_of(m)}


def _case_file(m: Any) -> Iterator[Finding]:
    """Check the round trip through a case file."""
    yield from round_trips.through_case_file(m, "material", _tables(m))


def _campaign(m: Any) -> Iterator[Finding]:
    """Check a plan of a campaign."""
    return round_trips.through_campaign(m, _tables(m))


def _flags(m: Any) -> Iterator[Finding]:
    """Check the flags."""
    r = m.reduced()
    stated = {"rubbery_modulus", "poisson_ratio", "glassy_modulus", "tau0"}
    flags: dict[str, Any] = {}
    named = material_numbers(type(m))
    if "modulus-ratio" in named:
        flags["modulus-ratio"] = r.modulus_ratio
    if "exponent" in named:
        flags["exponent"], stated = r.exponent, stated | {"exponent"}
    rest = [repr(x) for name, x in round_trips.numbers_of(r).items() if name not in stated]
    if any("[" in text or "'" in text for text in rest):
        return  # lists and numbers with units are given in files only
    flags["material"] = ":".join([m.word, ",".join(rest)]) if rest else m.word
    yield round_trips.through_flags(r, "material", flags)


def _passport(m: Any) -> Iterator[Finding]:
    """Check the round trip through a passport."""
    passport = Passport(name="a solid", material=m)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "passport.toml"
        write_passport(passport, path)
        back = read_passport(path, also=round_trips.classes_of(m))
    yield holds("passport: written and read back", back == passport, repr(m), repr(back.material))


def _groups(m: Any, tabor: float, rate: float) -> Groups:
    return Groups(tabor, m.reduced(), AtForce(2.0), rate, LennardJones(1.0, 1.0))


def _contacts(m: Any) -> Iterator[Finding]:
    """Check simulated contacts."""
    groups = _groups(m, 1.0, 3.0)
    yield from simulated.between_limits(groups)
    yield from simulated.in_si(groups, modulus=m.rubbery_modulus, poisson_ratio=m.poisson_ratio)
    yield from simulated.saved(groups, round_trips.classes_of(m))
    # a law so weak that slopes of the map are small
    law = LennardJones(m.contact_modulus * _GAP / 100, _GAP)
    yield from simulated.on_a_map(m, law)


def _theories(m: Any) -> Iterator[Finding]:
    """Check that theories and predictions return a value or a reason."""
    for tabor in (0.5, 3.0, 30.0):
        yield from simulated.answered(_groups(m, tabor, 30.0))
