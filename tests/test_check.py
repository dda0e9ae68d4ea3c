"""Conformance: every noun of the package passes its check, and a broken one of each kind fails."""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import viscotack as vt
from viscotack import check
from viscotack.forecast import theories
from viscotack.forecast.learned import SOLIDS
from viscotack.forecast.prediction import MEASURED
from viscotack.forecast.simulation import SIMULATION
from viscotack.forecast.theories import CRACK_CONTACT
from viscotack.forecast.tiers import TIERS
from viscotack.geometry.hats import hat_areas
from viscotack.materials import Modes
from viscotack.problem.nouns import own_nouns
from viscotack.theory import lennard_jones
from viscotack.traction import Eyring, GentSchultz, Tabulated

OWN = Path(__file__).resolve().parents[1] / "examples" / "own"
MORSE, COLE_COLE, ROUNDED, LARGEST, FOUNDATION = own_nouns(
    OWN / name for name in ("morse.py", "cole_cole.py", "rounded_cone.py", "foundation.py")
)
PLATEAUS = dict(rubbery_modulus=1.2e6, glassy_modulus=3e7, poisson_ratio=0.4)
SOLID = PLATEAUS | dict(tau0=2e-3)
WORK, GAP = 0.05, 1e-6
LENNARD_JONES = vt.LennardJones(WORK, GAP)
MATERIALS = {
    "elastic": vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    "sls": vt.StandardSolid(**SOLID),
    "prony": vt.Prony(rubbery_modulus=1e6, branches=[(1e6, 1e-3), (5e6, 1e-5)], poisson_ratio=0.3),
    "power-law": vt.RetardationPowerLaw(**SOLID, exponent=0.6),
    "relaxation-power-law": vt.RelaxationPowerLaw(**SOLID, exponent=0.3),
    "fractional-zener": vt.FractionalZener(**SOLID, order=0.6),
    "cole-cole": COLE_COLE(**SOLID, order=0.7),
}
LAWS_CHECKED = {
    "lennard-jones": LENNARD_JONES,
    "dugdale": vt.Dugdale(WORK, GAP, rise=0.05, fall=0.5),
    "exponential": vt.Exponential(WORK, GAP, decay=0.3),
    "table": Tabulated.of_points(
        np.array([1.2, 1.5, 1.8, 2.1, 3.0, 4.5, 8.0]) * 1e-6,
        [-300e3, -10e3, 60e3, 75e3, 30e3, 4e3, 0.0],
    ),
    "gent-schultz": GentSchultz.of(LENNARD_JONES, reference_speed=1e-3, exponent=0.5),
    "eyring": Eyring.of(LENNARD_JONES, reference_speed=1e-3, sensitivity=0.1),
    "logarithmic-ageing": vt.LogarithmicAgeing.of(
        LENNARD_JONES, reference_time=1.0, sensitivity=0.1
    ),
    "saturating-ageing": vt.SaturatingAgeing.of(
        LENNARD_JONES, reference_time=1.0, largest_growth=0.5
    ),
    "morse": MORSE(WORK, GAP, 3.0),
}
SHAPES_CHECKED = {
    "sphere": vt.Sphere(1e-3),
    "cone": vt.Cone(0.1),
    "profile": vt.PowerLawProfile(1e6, 3.0),
    "wavy-sphere": vt.WavySphere(radius=1e-3, amplitude=0.2e-6, wavelength=4e-5),
    "measured-profile": vt.MeasuredProfile.sampled(
        lambda r: max(r * r - 4e-10, 0.0) / 2e-3, np.linspace(0.0, 1.2e-3, 121)
    ),
    "disc": vt.Disc(1e-4, edge_width=9e-5, edge_height=1e-5),
    "rounded-cone": ROUNDED(0.2, 2e-5),
}
BODIES = {
    "half-space": vt.HalfSpace(),
    "frictionless": vt.Layer(1e-3),
    "bonded": vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.3)),
    "incompressible": vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.5)),
    "foundation": FOUNDATION(2e-5),
}
each_material = pytest.mark.parametrize("material", MATERIALS.values(), ids=MATERIALS)
each_law = pytest.mark.parametrize("law", LAWS_CHECKED.values(), ids=LAWS_CHECKED)
each_shape = pytest.mark.parametrize("shape", SHAPES_CHECKED.values(), ids=SHAPES_CHECKED)


# --- the nouns of the package, and those of the examples -----------------------------------------


@each_material
def test_materials_pass_the_checks_of_formulas_and_ways_in(material):
    check.check_material(material, thorough=False).raise_if_failed()


@each_law
def test_laws_pass_the_checks_of_formulas_and_ways_in(law):
    check.check_law(law, thorough=False).raise_if_failed()


@each_shape
def test_shapes_pass_the_checks_of_formulas_and_ways_in(shape):
    check.check_shape(shape, thorough=False).raise_if_failed()


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_bodies_pass(body):
    check.check_body(body).raise_if_failed()


@pytest.mark.slow
def test_nouns_pass_in_simulations_theories_and_campaigns():
    check.check_material(MATERIALS["fractional-zener"]).raise_if_failed()
    check.check_law(LAWS_CHECKED["eyring"]).raise_if_failed()
    check.check_shape(SHAPES_CHECKED["rounded-cone"]).raise_if_failed()


@pytest.mark.slow
@pytest.mark.parametrize(
    "observable",
    [
        LARGEST,
        vt.Observable("work_of_it", "work to pull-off", "work", vt.work_to_pull_off),
    ],
    ids=lambda observable: observable.name,
)
def test_observables_pass(observable):
    check.check_observable(observable).raise_if_failed()


# --- a tier by the interface of tiers ------------------------------------------------------------


@dataclass(frozen=True)
class Slow:
    """The slowest pull-off, answered for two solids, one law and one shape at slow rates."""

    name: str = "slow limit"
    cost: float = 1e-4

    def covers(self, problem: Any) -> str:
        groups = problem.groups()
        if type(groups.body) is not vt.HalfSpace:
            return "verified for the half-space alone"
        if type(groups.material) not in (vt.StandardSolid, vt.RetardationPowerLaw):
            return f"verified for two solids, not {type(groups.material).__name__}"
        if type(groups.traction) is not vt.LennardJones or type(groups.geometry) is not vt.Sphere:
            return "verified for Lennard-Jones and spheres alone"
        slow = groups.rate is not None and groups.rate * groups.material.time_unit <= 1
        return "" if slow and groups.tabor < 5 else "verified for slow rates, Tabor numbers below 5"

    def answer(self, problem: Any, *, confidence: float = 0.9) -> vt.Prediction:
        if reason := self.covers(problem):
            raise vt.OutOfRange(f"{self.name}: {reason}")
        force = float(np.asarray(lennard_jones.pull_off_ratio(problem.groups().tabor)))
        return vt.Prediction(
            pull_off_force=force,
            interval=(force * (1 - 0.02 * confidence), force * (1 + confidence)),
            work_to_pull_off=None,
            work_interval=None,
            confidence=confidence,
            band=MEASURED,
            method=self.name,
            inside=False,
            why="the limit of a slow retraction",
            curve=None,
            curve_band=None,
            problem=problem,
        )


def test_a_tier_that_keeps_to_its_list_passes():
    check.check_tier(Slow()).raise_if_failed()


SHORT_PUNCH = vt.Groups(
    tabor=None,
    cohesion=0.5,
    geometry=vt.FlatPunch(8.0),
    body=vt.Layer(0.3),
    material=vt.StandardSolid(
        rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0
    ),
    start=vt.AtForce(0.1),
    rate=1.0,
)
# Kinds of nouns that a tier compares by their functions and not by their class.
TAKES = {
    SIMULATION: ("solid", "law", "shape", "body"),
    CRACK_CONTACT: ("solid",),
    SOLIDS: ("solid",),
}
COSTLY = {SIMULATION, CRACK_CONTACT}
ONCE = cache(theories.closed_forms)


@pytest.mark.parametrize(
    "tier",
    [
        pytest.param(tier, id=tier.name, marks=[pytest.mark.slow] * (tier.name in COSTLY))
        for tier in TIERS
    ],
)
def test_the_tiers_of_the_package_pass(tier, monkeypatch):
    # all of the cheap tiers ask for the same theories of the same problems
    monkeypatch.setattr(theories, "closed_forms", ONCE)
    takes = TAKES.get(tier.name, ())
    digits = 1e-4 if tier.name == SIMULATION else 1e-9
    cases = [] if tier.name in COSTLY else [SHORT_PUNCH]
    check.check_tier(tier, cases=cases, takes=takes, digits=digits).raise_if_failed()


# --- broken nouns -------------------------------------------------------------------------


class Careless(vt.StandardSolid):
    """Modes whose error is stated a thousand times too small."""

    def retardation_modes(self, *, shortest, longest, tolerance):
        exact = super().retardation_modes(shortest=shortest, longest=longest, tolerance=tolerance)
        times = tuple(1.01 * t for t in exact.times)
        return Modes(exact.instantaneous, exact.weights, times, 1e-3 * tolerance)


class Active(vt.StandardSolid):
    """Energy out of nothing."""

    def complex_modulus(self, omega):
        return np.conj(super().complex_modulus(omega))


class Shifted(vt.StandardSolid):
    """A complex modulus of another relaxation time, its compliance too."""

    def complex_modulus(self, omega):
        return super().complex_modulus(2 * np.asarray(omega, dtype=float))

    def complex_compliance(self, omega):
        return 1 / self.complex_modulus(omega)


class Factored(vt.LennardJones):
    """An energy that is off by a tenth."""

    def energy(self, gap):
        return 1.1 * super().energy(gap)


class Kilo(vt.LennardJones):
    """A traction in kPa: consistent in itself, but not in SI."""

    def traction(self, gap):
        return 1e-3 * super().traction(gap)


class Steep(vt.Sphere):
    """A flank that is not the slope of the gap."""

    def flank(self, position):
        return 1.5 * super().flank(position)


class Lopsided(FOUNDATION):
    """A compliance that is not symmetric."""

    def influence(self, nodes, symmetry):
        x = nodes / self.thickness
        B = 1 / (1 + np.abs(x[:, None] - x)) * (1 + 0.2 * (x[:, None] > x))
        return B * hat_areas(nodes, symmetry)


class Springy(FOUNDATION):
    """A compliance of negative energy."""

    def influence(self, nodes, symmetry):
        x = nodes / self.thickness
        B = 1 - np.exp(-np.abs(x[:, None] - x)) + 0.01 * np.eye(x.size)
        return B * hat_areas(nodes, symmetry)


class Boastful(Slow):
    """Covers whatever it is given."""

    def covers(self, problem):
        return ""


class Dimensional(Slow):
    """Another answer in SI."""

    def answer(self, problem, *, confidence=0.9):
        found = super().answer(problem, confidence=confidence)
        factor = 1.001 if isinstance(problem, vt.Problem) else 1.0
        return replace(found, pull_off_force=factor * found.pull_off_force)


def in_newtons(result):
    return vt.pull_off_force(result) * (1.0 if result.scales is None else result.scales.force)


SI_ONLY = vt.Observable("in_newtons", "force in newtons", "force", in_newtons)

MUTANTS: dict[str, tuple[Any, str]] = {
    "modes stated too well": (Careless(**SOLID), "tolerance 0.01: error: expected <= stated"),
    "not passive": (Active(**SOLID), "passive: the loss modulus is not negative"),
    "another complex modulus": (Shifted(**SOLID), "compliance is the transform of the creep"),
    "energy off by a factor": (Factored(WORK, GAP), "derivative of the energy by the gap"),
    "traction in kPa": (Kilo(WORK, GAP), "the traction does the work of adhesion"),
    "flank": (Steep(1e-3), "flank is the derivative of the gap"),
    "not reciprocal": (Lopsided(1e-4), "reciprocity: compliance is symmetric"),
    "negative energy": (Springy(1e-4), "energy is positive"),
    "boastful": (Boastful(), "an unverified solid is not covered"),
    "another answer in SI": (Dimensional(), "same value as its dimensionless form"),
}


def checked(noun):
    if hasattr(noun, "creep"):
        return check.check_material(noun, thorough=False)
    if hasattr(noun, "energy_beyond"):
        return check.check_law(noun, thorough=False)
    if hasattr(noun, "flank"):
        return check.check_shape(noun, thorough=False)
    if hasattr(noun, "influence"):
        return check.check_body(noun, thorough=False)
    return check.check_tier(noun)


@pytest.mark.parametrize(("noun", "words"), MUTANTS.values(), ids=MUTANTS)
def test_a_broken_noun_fails_in_words_that_name_the_identity(noun, words):
    found = checked(noun)
    assert not found.passed and words in str(found)
    with pytest.raises(check.CheckFailed, match="checks passed"):
        found.raise_if_failed()


@pytest.mark.slow
def test_a_broken_observable_fails():
    found = "\n".join(map(str, check.check_observable(SI_ONLY).failures))
    assert "the dimensionless value is the same in SI" in found


def test_an_exception_in_a_noun_is_a_finding_and_ends_no_other_check():
    class Broken(vt.StandardSolid):
        def relaxation(self, time):
            raise ZeroDivisionError("of my own")

    found = check.check_material(Broken(**SOLID), thorough=False)
    assert "ZeroDivisionError: of my own" in str(found)
    assert sum(finding.passed for finding in found.findings) > 20
