"""Interfaces whose tension grows with the time in contact: laws, limits, energies, order."""

import numpy as np
import pytest

import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.model.protocol import Apart, Approach, AtDepth, Dwell, Retract
from viscotack.model.traction.growing import reduced

REST = vt.LennardJones(0.05, 20e-9)
LOG = vt.LogarithmicAgeing.of(REST, reference_time=2.0, sensitivity=0.1)
ENDS = vt.SaturatingAgeing.of(REST, reference_time=2.0, largest_growth=0.5)
laws = pytest.mark.parametrize("law", [LOG, ENDS], ids=["logarithmic", "saturating"])
GAPS = np.array([0.9, 0.99, 1.01, 1.2, 1.7, 4.0]) * 20e-9


def run(law, *, moves=(), start=None, material=ELASTIC, tabor=3.0, rate=3.0, **given):
    start = AtDepth(10.0) if start is None else start
    groups = vt.Groups(tabor, material, start, rate, traction=law, moves=moves)
    return vt.solve(groups, **({"until": "pull-off", "estimate_error": False} | given))


def pressed(law, *dwells, speed=1e3, **given):
    """Approach, dwell and retract fast; in between detach, where there are several dwells."""
    moves = ()
    for dwell in dwells:
        back = (Retract(speed, to=AtDepth(-30.0)),) if moves else ()
        moves += (*back, Approach(speed, to=AtDepth(10.0)), Dwell(dwell))
    return run(law, start=Apart(6.0), moves=moves, rate=speed, **given)


# --- the law
@laws
def test_only_surfaces_that_attract_feel_the_time(law):
    at_rest = REST.traction(GAPS)
    np.testing.assert_array_equal(law.traction(GAPS), at_rest)
    old, attracts = law.traction(GAPS, 7.0), at_rest > 0
    np.testing.assert_array_equal(old[~attracts], at_rest[~attracts])
    np.testing.assert_allclose(
        old[attracts], at_rest[attracts] * (1 + law.growth_after(7.0)), rtol=1e-14
    )
    d = 1e-5 * GAPS
    by_gap = (law.traction(GAPS + d, 7.0) - law.traction(GAPS - d, 7.0)) / (2 * d)
    np.testing.assert_allclose(law.stiffness(GAPS, 7.0), by_gap, rtol=1e-6)


def test_growth_has_the_stated_values():
    assert float(LOG.growth_after(2.0)) == pytest.approx(0.1 * np.log(2), rel=1e-14)
    decade = float(LOG.growth_after(2e9) - LOG.growth_after(2e8))
    assert decade == pytest.approx(0.1 * np.log(10), rel=1e-7)
    assert float(ENDS.growth_after(2.0)) == pytest.approx(0.5 * (1 - np.exp(-1)), rel=1e-14)
    assert float(ENDS.growth_after(ENDS.settled)) == pytest.approx(0.5, rel=1e-15)


@laws
def test_a_reduced_law_counts_times_in_the_unit_of_time(law):
    small = reduced(law, 0.02)
    np.testing.assert_allclose(
        small.traction(GAPS / 20e-9, 7.0 / 0.02), law.traction(GAPS, 7.0) * 20e-9 / 0.05, rtol=1e-12
    )
    back = small.scaled(0.05, 20e-9, 0.02)
    assert back.reference_time == pytest.approx(law.reference_time, rel=1e-15)


# --- limits
@pytest.mark.parametrize("growth", [0.5, 2.0])
def test_an_old_contact_holds_like_one_of_the_work_that_it_has_reached(growth):
    # between JKR of the bonds, whose last percent breaks, and all forces that much stronger: those
    # beyond the first edge, and of broken bonds, are not
    old = vt.pull_off_force(run(vt.SaturatingAgeing(1, 1, 1.0, growth)))
    more = 1 + growth
    strong = vt.pull_off_force(run(vt.LennardJones(1, 1), tabor=3.0 * more ** (2 / 3)))
    assert 1 + 0.985 * growth < old < more * strong
    assert old == pytest.approx(more * strong, rel=0.012)


def test_weak_growth_is_the_law_at_rest():
    plain = vt.pull_off_force(run(vt.LennardJones(1, 1), material=SOLID))
    found = vt.pull_off_force(run(vt.SaturatingAgeing(1, 1, 1.0, 1e-9), material=SOLID))
    assert found == pytest.approx(plain, rel=1e-4)


def test_the_force_follows_the_dwell():
    # elastic: the dwell changes nothing but the bonds
    law = vt.LogarithmicAgeing(1, 1, 0.01, 0.08)
    for dwell in (0.1, 10.0):
        grown = 1 + float(law.growth_after(dwell))
        strong = vt.pull_off_force(run(vt.LennardJones(1, 1), tabor=3.0 * grown ** (2 / 3)))
        found = vt.pull_off_force(pressed(law, dwell, speed=1e5))
        assert found == pytest.approx(grown * strong, rel=6e-3)


# --- energy, order
def test_energy_is_conserved_with_the_heat_of_the_interface():
    law = vt.SaturatingAgeing(1, 1, 1.0, 1.0)
    result = pressed(law, 1.0, speed=10.0, material=SOLID, until="detached")
    energy = result.energy
    total = energy.elastic + energy.interface + energy.heat + energy.interface_heat
    missing = energy.drive - (total - total[0]) - energy.jumps - energy.transfer
    heat = energy.interface_heat[-1]
    assert heat > 0 and np.max(np.abs(missing)) < 2e-3 * np.ptp(total)
    assert result.energy_residual < 1e-3
    # bonds of age t cost growth times the area that they held, 1.5 to 0.5 per unit at most
    assert np.min(np.diff(energy.interface_heat[energy.interface_heat.argmin() :])) > -1e-3 * heat


def test_a_crack_that_turns_creates_no_energy():
    law = vt.SaturatingAgeing(1, 1, 0.5, 1.0)
    turns = tuple(
        move
        for _ in range(4)
        for move in (Retract(2.0, to=AtDepth(-2.0)), Approach(2.0, to=AtDepth(4.0)))
    )
    result = run(law, start=Apart(6.0), moves=(Approach(2.0, to=AtDepth(4.0)), *turns), rate=2.0)
    assert result.energy_residual < 1e-3
    heat, move = result.energy.interface_heat, np.asarray(result.move)
    ends = [heat[move == 1 + 2 * k][-1] for k in range(5)]
    assert np.all(np.diff(ends) > 0)


def test_a_finer_run_confirms_the_stated_error():
    law = vt.SaturatingAgeing(1, 1, 1.0, 1.0)
    usual = pressed(law, 0.5, material=SOLID, speed=30.0, estimate_error=True)
    fine = vt.pull_off_force(pressed(law, 0.5, material=SOLID, speed=30.0, accuracy=5e-4))
    assert usual.error_estimate is not None
    assert abs(vt.pull_off_force(usual) / fine - 1) < usual.error_estimate["force"] < 1e-2
