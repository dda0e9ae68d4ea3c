"""Interfaces whose tension grows with the opening speed: laws, limits, energies, order."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.model.problem import Groups
from viscotack.model.protocol import AtDepth
from viscotack.model.traction.growing import reduced
from viscotack.simulate import Settings

REST = vt.LennardJones(0.1523, 200e-9)
POWER = vt.GentSchultz.of(REST, reference_speed=1e-3, exponent=0.4)
BONDS = vt.Eyring.of(REST, reference_speed=1e-6, sensitivity=0.2)
laws = pytest.mark.parametrize("law", [POWER, BONDS], ids=["power", "bonds"])
GAPS = np.array([0.9, 0.99, 1.01, 1.2, 1.7, 4.0]) * 200e-9


def unloaded(law, tabor=1.0, depth=2.0, material=ELASTIC, rate=1.0, **given):
    groups = Groups(tabor=tabor, material=material, start=AtDepth(depth), rate=rate, traction=law)
    return vt.solve(groups, **({"until": "pull-off", "estimate_error": False} | given))


# --- the law
@laws
def test_only_surfaces_that_attract_and_open_feel_the_speed(law):
    at_rest = REST.traction(GAPS)
    np.testing.assert_array_equal(law.traction(GAPS), at_rest)
    np.testing.assert_array_equal(law.traction(GAPS, -1e-3), at_rest)
    opening, attracts = law.traction(GAPS, 1e-3), at_rest > 0
    np.testing.assert_array_equal(opening[~attracts], at_rest[~attracts])
    np.testing.assert_allclose(
        opening[attracts], at_rest[attracts] * (1 + law.growth(1e-3)), rtol=1e-14
    )
    # the power law doubles the tension at its reference speed
    assert float(POWER.growth(1e-3)) == pytest.approx(1.0, rel=1e-6, abs=0)
    assert float(BONDS.growth(1e-3)) == pytest.approx(0.2 * np.log(2000), rel=1e-6, abs=0)


@laws
def test_growth_and_stiffness_are_the_derivatives_of_the_tension(law):
    tension = np.maximum(law.at_rest.traction(GAPS), 0)
    # down to speeds at which the power law has become a proportional one
    for speed in (1e-11, 1e-9, 1e-6, 1e-3, 1.0):
        d = 1e-4 * speed
        by_speed = (law.traction(GAPS, speed + d) - law.traction(GAPS, speed - d)) / (2 * d)
        found = tension * law.growth_slope(speed)
        np.testing.assert_allclose(by_speed, found, rtol=1e-5, atol=1e-5 * found.max())
    d = 1e-5 * GAPS
    by_gap = (law.traction(GAPS + d, 1e-3) - law.traction(GAPS - d, 1e-3)) / (2 * d)
    np.testing.assert_allclose(law.stiffness(GAPS, 1e-3), by_gap, rtol=1e-6)
    assert law.growth_slope(-1e-3) == 0


@laws
def test_a_reduced_law_counts_speeds_in_gaps_per_unit_of_time(law):
    small = reduced(law, 0.02)
    speed = 3e-4
    np.testing.assert_allclose(
        small.traction(GAPS / 200e-9, speed * 0.02 / 200e-9),
        law.traction(GAPS, speed) * 200e-9 / 0.1523,
        rtol=1e-12,
    )
    back = small.scaled(0.1523, 200e-9, 0.02)
    assert back.reference_speed == pytest.approx(law.reference_speed, rel=1e-15, abs=0)


# --- limits
def test_a_rigid_sphere_pulls_off_with_bradleys_force_and_the_growth_of_its_speed():
    # mu -> 0: all gaps open with the speed of the sphere
    for law in (vt.GentSchultz(1, 1, 0.5, 0.4), vt.Eyring(1, 1, 0.1, 0.3)):
        result = unloaded(law, tabor=1e-5, depth=0.2, accuracy=1e-2)
        bradley = 4 / 3 * (1 + float(law.growth(1.0)))
        assert vt.pull_off_force(result) == pytest.approx(bradley, rel=1e-2, abs=0)
        assert result.energy_residual < 5e-3


def test_slow_or_weak_growth_is_the_law_at_rest():
    plain = vt.pull_off_force(unloaded(vt.LennardJones(1, 1), material=SOLID))
    for law in (vt.GentSchultz(1, 1, 1e14, 1.0), vt.Eyring(1, 1, 1.0, 1e-9)):
        found = vt.pull_off_force(unloaded(law, material=SOLID))
        assert found == pytest.approx(plain, rel=5e-4, abs=0)


# --- energy, order, stability
def test_energy_is_conserved_with_the_heat_of_the_interface():
    law = vt.GentSchultz(1, 1, 1.0, 0.5)
    result = unloaded(law, material=SOLID, until="detached", accuracy=5e-3)
    energy = result.energy
    assert np.all(np.diff(energy.interface_heat) >= 0) and energy.interface_heat[-1] > 0
    spent = energy.elastic + energy.interface + energy.spring + energy.heat
    spent = spent + energy.interface_heat + energy.jumps + energy.transfer
    missing = energy.drive - (spent - spent[0])
    assert np.max(np.abs(missing)) < 2e-3 * energy.interface_heat[-1]
    assert result.energy_residual < 1e-3
    # what would jump runs: nothing is lost in it
    assert abs(energy.jumps[-1]) < 1e-3 * energy.interface_heat[-1]


def test_an_elastic_contact_that_would_jump_runs_at_a_finite_speed():
    plain = unloaded(vt.LennardJones(1, 1), tabor=2.0, until="detached", accuracy=1e-2)
    grown = unloaded(vt.GentSchultz(1, 1, 10.0, 0.5), tabor=2.0, until="detached", accuracy=1e-2)
    assert [event.kind for event in plain.events] == ["jump out of contact"]
    assert not grown.events
    assert np.nanmax(grown.edge_speed) > 10 * grown.edge_speed[np.argmin(grown.force)]


def test_steps_are_of_second_order():
    usual = Settings.for_accuracy(2e-3)

    def force(part):
        settings = replace(
            usual,
            travel=usual.travel * part,
            first_travel=usual.first_travel * part,
            force_change=usual.force_change * part,
            imbalance=usual.imbalance * part**2,
            step_error=usual.step_error * part**2,
        )
        return vt.pull_off_force(unloaded(vt.GentSchultz(1, 1, 1.0, 0.5), settings=settings))

    coarse, middle, fine = force(2.0), force(1.0), force(0.5)
    order = np.log2(abs((coarse - middle) / (middle - fine)))
    assert 1.6 < order < 2.8


def test_a_finer_run_confirms_the_stated_error():
    law = vt.GentSchultz(1, 1, 1.0, 0.5)
    usual = unloaded(law, tabor=2.0, depth=5.0, estimate_error=True)
    fine = vt.pull_off_force(unloaded(law, tabor=2.0, depth=5.0, accuracy=6e-4))
    off = abs(vt.pull_off_force(usual) / fine - 1)
    assert off < usual.error_estimate["force"] < 1e-2
