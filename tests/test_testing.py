"""Nouns of the package and of the examples pass their checks; a broken one fails each check."""

from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.geometry.panels import hat_areas
from viscotack.model.materials import Modes
from viscotack.model.problem.nouns import own_nouns
from viscotack.testing import check, checks

OWN = Path(__file__).resolve().parents[1] / "examples" / "own"
MORSE, COLE_COLE, ROUNDED, LARGEST, FOUNDATION = own_nouns(
    OWN / name for name in ("morse.py", "cole_cole.py", "rounded_cone.py", "foundation.py")
)
SOLID = dict(rubbery_modulus=1.2e6, glassy_modulus=3e7, tau0=2e-3, poisson_ratio=0.4)
LENNARD_JONES = vt.LennardJones(0.05, 1e-6)
NOUNS = {
    "elastic": vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    "sls": vt.StandardSolid(**SOLID),
    "prony": vt.Prony(rubbery_modulus=1e6, branches=[(1e6, 1e-3), (5e6, 1e-5)], poisson_ratio=0.3),
    "power-law": vt.RetardationPowerLaw(**SOLID, exponent=0.6),
    "relaxation-power-law": vt.RelaxationPowerLaw(**SOLID, exponent=0.3),
    "fractional-zener": vt.FractionalZener(**SOLID, order=0.6),
    "cole-cole": COLE_COLE(**SOLID, order=0.7),
    "lennard-jones": LENNARD_JONES,
    "dugdale": vt.Dugdale(0.05, 1e-6, rise=0.05, fall=0.5),
    "exponential": vt.Exponential(0.05, 1e-6, decay=0.3),
    "table": vt.Tabulated.of_points(
        np.array([1.2, 1.5, 1.8, 2.1, 3.0, 4.5, 8.0]) * 1e-6,
        [-300e3, -10e3, 60e3, 75e3, 30e3, 4e3, 0.0],
    ),
    "gent-schultz": vt.GentSchultz.of(LENNARD_JONES, reference_speed=1e-3, exponent=0.5),
    "eyring": vt.Eyring.of(LENNARD_JONES, reference_speed=1e-3, sensitivity=0.1),
    "logarithmic-ageing": vt.LogarithmicAgeing.of(
        LENNARD_JONES, reference_time=1.0, sensitivity=0.1
    ),
    "saturating-ageing": vt.SaturatingAgeing.of(
        LENNARD_JONES, reference_time=1.0, largest_growth=0.5
    ),
    "morse": MORSE(0.05, 1e-6, 3.0),
    "sphere": vt.Sphere(1e-3),
    "cone": vt.Cone(0.1),
    "profile": vt.PowerLawProfile(1e6, 3.0),
    "wavy-sphere": vt.WavySphere(radius=1e-3, amplitude=0.2e-6, wavelength=4e-5),
    "measured-profile": vt.MeasuredProfile.sampled(
        lambda r: max(r * r - 4e-10, 0.0) / 2e-3, np.linspace(0.0, 1.2e-3, 121)
    ),
    "disc": vt.Disc(1e-4, edge_width=9e-5, edge_height=1e-5),
    "rounded-cone": ROUNDED(0.2, 2e-5),
    "half-space": vt.HalfSpace(),
    "layer": vt.Layer(1e-3),
    "bonded-layer": vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.3)),
    "incompressible-layer": vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.5)),
    "foundation": FOUNDATION(2e-5),
}


@pytest.mark.parametrize("noun", NOUNS.values(), ids=NOUNS)
def test_nouns_pass_the_checks_of_formulas(noun):
    check(noun, thorough=False)


@pytest.mark.parametrize("name", ["cole-cole", "morse", "rounded-cone", "foundation"])
def test_nouns_pass_in_simulations(name):
    check(NOUNS[name])


def test_an_observable_passes():
    check(LARGEST)


def broken(noun, **methods):
    """Return a noun with other methods, each of which is given it and its parent first."""
    kind = type("Broken", (type(noun),), {})
    for name, method in methods.items():

        def wrong(self, *given, method=method, **named):
            return method(self, super(kind, self), *given, **named)

        setattr(kind, name, wrong)
    return kind(**{each.name: getattr(noun, each.name) for each in fields(noun)})


def wavering(solid, right, time):
    x = np.log(np.maximum(np.asarray(time) / solid.tau0, 1e-30))
    return right.creep(time) * (1 - 0.3 * np.exp(-((x - 3) ** 2)))


def careless(solid, right, *, tolerance, **window):
    exact = right.retardation_modes(tolerance=tolerance, **window)
    times = tuple(1.01 * t for t in exact.times)
    return Modes(exact.instantaneous, exact.weights, times, 1e-3 * tolerance)


def lopsided(body, right, nodes, symmetry):
    x = nodes / body.thickness
    B = 1 / (1 + np.abs(x[:, None] - x)) * (1 + 0.2 * (x[:, None] > x))
    return B * hat_areas(nodes, symmetry)


def springy(body, right, nodes, symmetry):
    x = nodes / body.thickness
    B = 1 - np.exp(-np.abs(x[:, None] - x)) + 0.01 * np.eye(x.size)
    return B * hat_areas(nodes, symmetry)


@dataclass(frozen=True)
class Forgetful(ROUNDED):
    """A number that is another after it was read."""

    word = "forgetful"

    def __post_init__(self):
        super().__post_init__()
        object.__setattr__(self, "rounding", 1.5 * self.rounding)


LAW, STANDARD, SPHERE, SPRINGS = LENNARD_JONES, NOUNS["sls"], NOUNS["sphere"], FOUNDATION(1e-4)
BROKEN = [
    ("derivatives", broken(LAW, energy=lambda law, right, gap: 1.1 * right.energy(gap))),
    # an energy that does not vanish far apart, and a traction of the same size in any unit
    ("law_limits", broken(LAW, energy=lambda law, right, gap: right.energy(gap) + 5e-5)),
    ("law_units", broken(LAW, reduced=lambda law, right: replace(law, work_of_adhesion=1.0))),
    ("plateaus", broken(STANDARD, creep=lambda solid, right, t: 1.01 * right.creep(t))),
    ("array_shapes", broken(STANDARD, creep=lambda solid, right, t: np.ravel(right.creep(t)))),
    ("monotone", broken(STANDARD, creep=wavering)),
    (
        "passive",
        broken(
            STANDARD,
            complex_modulus=lambda solid, right, w: np.conj(right.complex_modulus(w)),
            complex_compliance=lambda solid, right, w: np.conj(right.complex_compliance(w)),
        ),
    ),
    ("modes", broken(STANDARD, retardation_modes=careless)),
    (
        "transforms",
        broken(
            STANDARD,
            complex_modulus=lambda solid, right, w: right.complex_modulus(2.0 * np.asarray(w)),
            complex_compliance=lambda solid, right, w: 1 / solid.complex_modulus(w),
        ),
    ),
    (
        "solid_units",
        broken(STANDARD, reduced=lambda solid, right: replace(right.reduced(), tau0=solid.tau0)),
    ),
    ("profile", broken(SPHERE, flank=lambda shape, right, r: 1.5 * right.flank(r))),
    ("shape_units", broken(SPHERE, reduced=lambda shape, right, along, height: shape)),
    # so flat that the contact reaches less deep than its gap
    (
        "contact_without_adhesion",
        broken(SPHERE, flank=lambda shape, right, r: 0.3 * right.flank(r)),
    ),
    ("compliance", broken(SPRINGS, influence=lopsided)),
    ("compliance", broken(SPRINGS, influence=springy)),
    ("body_units", broken(SPRINGS, reduced=lambda body, right, along: body)),
    ("sphere_on_body", broken(SPRINGS, influence=lambda body, right, *of: -right.influence(*of))),
    ("case_file", Forgetful(0.2, 2e-5)),
]


def named(noun, name):
    return {each.__name__: each for each in checks(noun)}[name]


@pytest.mark.parametrize(("name", "noun"), BROKEN, ids=[name for name, _ in BROKEN])
def test_each_check_fails_for_a_broken_noun(name, noun):
    with pytest.raises(AssertionError):
        named(noun, name)()
    with pytest.raises(AssertionError, match=name):
        check(noun, thorough=False)


def test_an_observable_in_newtons_fails():
    def newtons(result):
        return vt.pull_off_force(result) * (1.0 if result.scales is None else result.scales.force)

    with pytest.raises(AssertionError, match="in SI"):
        check(vt.Observable("newtons", "force in newtons", "force", newtons))


def test_an_exception_in_a_noun_fails_its_check_and_ends_no_other():
    class Broken(vt.StandardSolid):
        def relaxation(self, time):
            raise ZeroDivisionError("of my own")

    with pytest.raises(AssertionError, match="(?s)plateaus: ZeroDivisionError.*monotone"):
        check(Broken(**SOLID), thorough=False)
