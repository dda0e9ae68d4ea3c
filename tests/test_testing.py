"""Nouns of the package and of the examples pass their checks; a broken one fails each check."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.geometry.hats import hat_areas
from viscotack.model.materials import Modes
from viscotack.model.problem.nouns import own_nouns
from viscotack.model.traction import Tabulated
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
    "table": Tabulated.of_points(
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


@pytest.mark.parametrize("check", checks(FOUNDATION(2e-5)))
def test_a_body_passes_each_check(check):
    check()


@pytest.mark.parametrize("name", ["cole-cole", "morse", "rounded-cone", "incompressible-layer"])
def test_nouns_pass_in_simulations(name):
    check(NOUNS[name])


def test_an_observable_passes():
    check(LARGEST)


# --- broken nouns ---------------------------------------------------------------------------------


class Factored(vt.LennardJones):
    """An energy that is off by a tenth."""

    def energy(self, gap):
        return 1.1 * super().energy(gap)


class Constant(vt.LennardJones):
    """An energy that does not vanish far apart."""

    def energy(self, gap):
        return super().energy(gap) + 1e-3 * self.work_of_adhesion


class Fixed(vt.LennardJones):
    """A traction of the same size in any unit."""

    def reduced(self):
        return replace(self, work_of_adhesion=1.0)


class Lossy(vt.StandardSolid):
    """A creep that starts above the glassy compliance."""

    def creep(self, time):
        return 1.01 * super().creep(time)


class Flat(vt.StandardSolid):
    """A creep of one dimension."""

    def creep(self, time):
        return np.ravel(super().creep(time))


class Wavering(vt.StandardSolid):
    """A creep that falls for a while."""

    def creep(self, time):
        x = np.log(np.maximum(np.asarray(time) / self.tau0, 1e-30))
        return super().creep(time) * (1 - 0.3 * np.exp(-((x - 3) ** 2)))


class Active(vt.StandardSolid):
    """Energy out of nothing."""

    def complex_modulus(self, omega):
        return np.conj(super().complex_modulus(omega))

    def complex_compliance(self, omega):
        return np.conj(super().complex_compliance(omega))


class Careless(vt.StandardSolid):
    """Modes whose error is stated a thousand times too small."""

    def retardation_modes(self, *, shortest, longest, tolerance):
        exact = super().retardation_modes(shortest=shortest, longest=longest, tolerance=tolerance)
        times = tuple(1.01 * t for t in exact.times)
        return Modes(exact.instantaneous, exact.weights, times, 1e-3 * tolerance)


class Shifted(vt.StandardSolid):
    """A complex modulus of another relaxation time, its compliance too."""

    def complex_modulus(self, omega):
        return super().complex_modulus(2 * np.asarray(omega, dtype=float))

    def complex_compliance(self, omega):
        return 1 / self.complex_modulus(omega)


class Clocked(vt.StandardSolid):
    """A reduced solid with the times of the solid."""

    def reduced(self):
        return replace(super().reduced(), tau0=self.tau0)


class Steep(vt.Sphere):
    """A flank that is not the slope of the gap."""

    def flank(self, position):
        return 1.5 * super().flank(position)


class Absolute(vt.Sphere):
    """A sphere that other units leave alone."""

    def reduced(self, along, height):
        return self


class Shallow(vt.Sphere):
    """A flank so flat that the contact reaches less deep than its gap."""

    def flank(self, position):
        return 0.3 * super().flank(position)


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


class Unscaled(FOUNDATION):
    """A body that other units leave alone."""

    def reduced(self, along):
        return self


class Repelling(FOUNDATION):
    """Springs that a sphere lifts."""

    def influence(self, nodes, symmetry):
        return -super().influence(nodes, symmetry)


@dataclass(frozen=True)
class Forgetful(ROUNDED):
    """A number that is another after it was read."""

    word = "forgetful"

    def __post_init__(self):
        super().__post_init__()
        object.__setattr__(self, "rounding", 1.5 * self.rounding)


BROKEN = {
    "derivatives": [Factored(0.05, 1e-6)],
    "law_limits": [Constant(0.05, 1e-6)],
    "law_units": [Fixed(0.05, 1e-6)],
    "plateaus": [Lossy(**SOLID)],
    "array_shapes": [Flat(**SOLID)],
    "monotone": [Wavering(**SOLID)],
    "passive": [Active(**SOLID)],
    "modes": [Careless(**SOLID)],
    "transforms": [Shifted(**SOLID)],
    "solid_units": [Clocked(**SOLID)],
    "profile": [Steep(1e-3)],
    "shape_units": [Absolute(1e-3)],
    "contact_without_adhesion": [Shallow(1e-3)],
    "compliance": [Lopsided(1e-4), Springy(1e-4)],
    "body_units": [Unscaled(1e-4)],
    "sphere_on_body": [Repelling(1e-4)],
    "case_file": [Forgetful(0.2, 2e-5)],
}


def named(noun, name):
    return {each.__name__: each for each in checks(noun)}[name]


@pytest.mark.parametrize(
    ("name", "noun"),
    [(name, noun) for name, nouns in BROKEN.items() for noun in nouns],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
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


def test_a_missing_member_is_named():
    class Incomplete:
        word, symmetry, gap, reduced = "incomplete", "revolution", None, None

    with pytest.raises(vt.InputError, match="lacks flank"):
        checks(dataclass(frozen=True)(Incomplete)())
