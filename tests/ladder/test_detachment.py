"""The ladder of the state at pull-off: its three statements, its limits, simulations."""

import numpy as np
import pytest

import viscotack as vt
from solids import creep_power_law
from viscotack.theory import CrackLaw, detachment, greenwood, jkr, lennard_jones, persson_brener

LENS = dict(radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15)
MODULI = dict(rubbery_modulus=1.5e6, poisson_ratio=0.5)
SOLID = vt.StandardSolid(**MODULI, glassy_modulus=15e6, tau0=0.1)
SOLIDS = [
    SOLID,
    vt.RetardationPowerLaw(**MODULI, glassy_modulus=1.5e9, exponent=0.22, tau0=0.02),
    vt.RetardationPowerLaw(**MODULI, glassy_modulus=1.6e6, exponent=1.0, tau0=0.02),
    vt.Prony(**MODULI, branches=((3e6, 1e-3), (2e7, 10.0))),
]
DEPTH, TIP = 3e-3, 1e-6


def at(speed, material=SOLID, depth=DEPTH):
    law = CrackLaw(theory="persson-brener", material=material, tip_length=TIP)
    return detachment.at_pull_off(speed, law, depth=depth, **LENS)


@pytest.mark.parametrize("material", SOLIDS, ids=["standard", "broad", "weak", "prony"])
def test_the_state_keeps_its_three_statements(material):
    r = np.geomspace(1e-9, 1.0, 30)
    state = at(r, material)
    R, E, w = LENS.values()
    # the edge is a crack of Persson and Brener, in the JKR contact of its energy
    law = persson_brener.amplification(
        state.crack_speed * material.time_unit / TIP, material=material
    )
    assert state.amplification == pytest.approx(law, rel=1e-12, abs=0)
    a = state.contact_radius
    tougher = dict(LENS, work_of_adhesion=w)
    end = jkr.pull_off(**tougher)
    assert state.force == pytest.approx(-end.force * law, rel=1e-12, abs=0)
    assert a == pytest.approx(end.contact_radius * np.cbrt(law), rel=1e-12, abs=0)
    # the bulk has crept for the time of the travel
    creep = material.rubbery_modulus * np.asarray(material.creep(state.time))
    assert state.compliance == pytest.approx(creep, rel=1e-9, abs=0)
    travel = state.compliance * (DEPTH - end.depth * law ** (2 / 3))
    assert r * state.time == pytest.approx(travel, rel=1e-9, abs=0)
    # and the edge follows the depth as in JKR with that energy, on a bulk so much stiffer
    h = 1e-4 * a
    depths = [(x**2 / R - np.sqrt(2 * np.pi * x * law * w / E)) for x in (a - h, a + h)]
    slope = state.compliance * (depths[1] - depths[0]) / (2 * h)
    assert state.crack_speed == pytest.approx(r / slope, rel=1e-7, abs=0)


@pytest.mark.parametrize("material", SOLIDS, ids=["standard", "broad", "weak", "prony"])
def test_the_slowest_is_jkr_and_the_fastest_the_glassy_superposition(material):
    force = jkr.pull_off_force(radius=LENS["radius"], work_of_adhesion=LENS["work_of_adhesion"])
    k = material.modulus_ratio
    slow, fast = at(1e-22, material, 0.2), at(1e40, material, 0.2)
    assert slow.force == pytest.approx(force, rel=1e-6, abs=0)
    assert slow.compliance == pytest.approx(1, rel=1e-9, abs=0)
    assert fast.force == pytest.approx(force / k, rel=1e-5, abs=0)
    assert fast.compliance == pytest.approx(k, rel=1e-5, abs=0)


def test_the_slow_force_leaves_jkr_as_its_crack_does():
    """Relaxed, Gamma - 1 is in proportion to the speed, with the law's own coefficient."""
    r = np.array([1e-11, 1e-12])
    state = at(r)
    coefficient = (state.amplification - 1) / (state.crack_speed * SOLID.tau0 / TIP)
    # one mode: Gamma - 1 = pi (1 - k) v
    assert coefficient == pytest.approx(np.pi * (1 - 0.1), rel=1e-3, abs=0)
    # and the speed in proportion to the rate
    assert np.diff(np.log(state.amplification - 1)) / np.diff(np.log(r)) == pytest.approx(
        1, abs=1e-3
    )


def test_what_the_theory_does_not_hold_is_refused():
    with pytest.raises(ValueError, match="speed must be positive"):
        at(0.0)
    with pytest.raises(ValueError, match="press deeper, or retract more slowly"):
        at(10.0, depth=1e-5)
    with pytest.raises(ValueError, match="that of the pull-off of the relaxed contact"):
        at(1e-6, depth=0.999 * jkr.instability(**LENS).depth)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rate", "tabor", "modulus_ratio", "exponent"), [(30.0, 3.24, 0.1, 0.8), (1e6, 5, 0.01, 0.5)]
)
def test_simulations_are_met_at_every_rate(rate, tabor, modulus_ratio, exponent):
    """Nine of ten cases lie within 20 % in speed and 10 % in force."""
    material = creep_power_law(1.0, 1 / modulus_ratio, exponent, 1.0, 0.0)
    start = 2 * (9 / (8 * modulus_ratio)) ** (1 / 3)
    case = vt.Groups(tabor=tabor, material=material, start=vt.AtRadius(start), rate=rate)
    result = vt.solve(case, accuracy=5e-3, until="pull-off", estimate_error=False)
    unit = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0)
    tip = persson_brener.crack_tip_length(
        contact_modulus=1.0,
        work_of_adhesion=1.0,
        strength=case.traction.strength * tabor,
        strength_ratio=np.pi / 9,
    )
    state = detachment.at_pull_off(
        rate / tabor,
        CrackLaw(theory="persson-brener", material=material, tip_length=tip),
        depth=jkr.depth(start * np.pi ** (1 / 3), **unit),
        **unit,
    )
    speed, force = vt.crack_speed_at_pull_off(result), vt.pull_off_force(result)
    assert state.crack_speed == pytest.approx(speed, rel=0.25, abs=0)
    found = lennard_jones.pull_off_ratio(tabor) * state.force / (1.5 * np.pi)
    assert found == pytest.approx(force, rel=0.12, abs=0)


@pytest.mark.parametrize("theory", [greenwood, persson_brener])
@pytest.mark.parametrize("material", SOLIDS, ids=["standard", "broad", "weak", "prony"])
def test_a_crack_by_its_passage_is_the_crack_by_its_speed(theory, material):
    word = {greenwood: "greenwood", persson_brener: "persson-brener"}[theory]
    law = CrackLaw(theory=word, material=material, tip_length=TIP)
    times = np.linspace(-9.0, 9.0, 25)
    found = law.passage(times)
    gamma, k = np.exp(found.log_amplification), material.modulus_ratio
    assert gamma == pytest.approx(
        theory.amplification(np.exp(found.log_speed), material=material), rel=1e-12, abs=0
    )
    assert np.exp(found.log_odds) == pytest.approx((gamma - 1) / (1 / k - gamma), rel=1e-6, abs=0)
    assert np.log(gamma) - found.log_speed == pytest.approx(times, rel=1e-12, abs=1e-12)
    curve = law.amplification_of_passage(-9.0, 9.0)
    assert curve(times) == pytest.approx(gamma, rel=1e-12, abs=0)


def test_a_passage_of_a_standard_solid_is_explicit():
    # one retardation time: 1/Gamma = k + (1 - k) psi, psi of the theory alone
    times, k = np.array([-2.0, 0.0, 2.0]), SOLID.modulus_ratio
    zone = k + (1 - k) * np.asarray(greenwood.zone_response(np.exp(times)))
    q = np.exp(times) / (2 * np.pi)
    tip = k + (1 - k) * (1 - np.sqrt(1 + q**2) + q)
    for found, curve, expected in (
        (
            greenwood.passage(times, material=SOLID),
            greenwood.amplification_of_passage(-2.0, 2.0, material=SOLID),
            1 / zone,
        ),
        (
            persson_brener.passage(times, material=SOLID),
            persson_brener.amplification_of_passage(-2.0, 2.0, material=SOLID),
            1 / tip,
        ),
    ):
        assert np.exp(found.log_amplification) == pytest.approx(expected, rel=1e-11, abs=0)
        assert curve(times) == pytest.approx(expected, rel=1e-11, abs=0)


def test_a_start_of_any_size_has_the_state_that_it_tends_to():
    law = CrackLaw(theory="persson-brener", material=SOLID, tip_length=TIP)
    found = detachment.unlimited(1e-3, law, depth=[1e-5, DEPTH], **LENS)
    assert found.force[1] == pytest.approx(float(at(1e-3).force), rel=1e-12, abs=0)
    assert found.compliance[0] < found.compliance[1] and found.force[0] > found.force[1]
    with pytest.raises(ValueError, match="below"):
        detachment.at_pull_off(1e-3, law, depth=1e-5, **LENS)
