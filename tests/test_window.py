"""Tests of two contacts in series: which opens first, and maps of speed and preload."""

from dataclasses import replace
from math import gamma, pi, sqrt

import numpy as np
import pytest

import viscotack as vt
from viscotack.theory import lennard_jones

RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5)
ELASTIC = vt.Elastic(rubbery_modulus=3e6, poisson_ratio=0.5)


def contact(
    material=RUBBER, *, work=0.15, radius=5e-3, speed=1e-4, force=2e-3, stiffness=None, gap=6e-7
):
    return vt.Problem(
        material=material,
        traction=vt.LennardJones(work, gap),
        geometry=vt.Sphere(radius),
        protocol=vt.Retraction(start=vt.AtForce(force), speed=speed, stiffness=stiffness),
    )


def elastic_pull_off(problem):
    return problem.scales().force * float(lennard_jones.pull_off_ratio(problem.tabor))


def edge_of_work(donor, stamp):
    """Return the work of the stamp's interface at which both pull-off forces are equal."""
    low, high = 0.1 * donor.traction.work_of_adhesion, 10 * donor.traction.work_of_adhesion
    for _ in range(60):
        middle = np.sqrt(low * high)
        weak = elastic_pull_off(with_work(stamp, middle)) < elastic_pull_off(donor)
        low, high = (middle, high) if weak else (low, middle)
    return low


def with_work(problem, work):
    return replace(problem, traction=replace(problem.traction, work_of_adhesion=work))


@pytest.mark.parametrize("side", [-1, 1])
def test_the_weaker_of_two_elastic_contacts_opens(side):
    # a stamp of half the radius and another range of its forces
    donor, stamp = contact(ELASTIC, work=0.1), contact(ELASTIC, radius=2.5e-3, gap=4e-7)
    stamp = with_work(stamp, edge_of_work(donor, stamp) * (1 + side * 1e-3))
    weaker = 1 if side < 0 else 0
    # 0.1 % beside the edge is inside the bands, but the nominal answer is that of the forces
    found = vt.which_opens(donor, stamp)
    # either opens if it is weakened and the other strengthened
    assert (found.nominal, found.corners, found.opened) == (weaker, (0, 1), None)
    assert vt.simulate_in_series(donor, stamp, accuracy=1e-3).opened == weaker


@pytest.mark.parametrize("gap", [2.1e-8, 1e-9])
def test_a_slender_elastic_tip_of_any_short_range_is_that_of_jkr(gap):
    """Sneddon's cubic tip with the singular edge of JKR: its largest tension over the radius."""
    A, w, E = 2e4, 0.05, 3e6 / 0.75
    tip = replace(contact(ELASTIC, work=w, gap=gap), geometry=vt.PowerLawProfile(A, 3))
    assert tip.groups().effective_tabor > 94
    a, depth = np.geomspace(1e-5, 1e-2, 100_001), A * sqrt(pi) * gamma(2.5) / gamma(2)
    tension = np.max(np.sqrt(8 * pi * w * E * a**3) - 2 * E * depth * 3 / 4 * a**4)
    sphere = contact(ELASTIC, gap=1e-8)
    found = [
        vt.which_opens(tip, with_work(sphere, part * tension / (1.5 * pi * 5e-3)))
        for part in (0.98, 1.02)
    ]
    assert [each.opened for each in found] == [1, 0]
    assert found[1].tension == pytest.approx(tension, rel=1e-3)


# With a spring the steps of both runs differ, and so do their errors.
@pytest.mark.parametrize(
    "stiffness, tolerance", [(None, 1e-6), pytest.param(400.0, 1e-3, marks=pytest.mark.slow)]
)
def test_two_equal_contacts_pull_off_as_one_at_half_the_speed(stiffness, tolerance):
    pair = contact(stiffness=stiffness)
    double = None if stiffness is None else 2 * stiffness
    half = vt.Retraction(start=vt.AtForce(2e-3), speed=0.5e-4, stiffness=double)
    single = vt.solve(replace(pair, protocol=half), estimate_error=False, until="pull-off")
    result = vt.simulate_in_series(pair, pair)
    expected = -single.force.min() * pair.scales().force
    assert result.tension == pytest.approx(expected, rel=tolerance)


def test_two_equal_steady_cracks_pull_off_as_one_at_half_the_speed():
    pair = contact(speed=1e-5)
    half = replace(pair, protocol=replace(pair.protocol, speed=0.5e-5))
    expected = vt.crack_contact(half).pull_off_force * pair.scales().force
    found = vt.which_opens(pair, pair)
    assert found.tension == pytest.approx(expected, rel=1e-3)
    assert (found.opened, found.nominal, found.corners) == (None, None, (0, 1))
    assert vt.which_opens(pair, with_work(pair, 0.15 * 1.001)).nominal == 0


def test_a_far_stiffer_and_stronger_contact_leaves_that_of_the_other():
    weak = contact()
    strong = contact(vt.Elastic(rubbery_modulus=3e9, poisson_ratio=0.5), work=5.0)
    single = vt.solve(weak, estimate_error=False, until="pull-off")
    result = vt.simulate_in_series(strong, weak)
    expected = -single.force.min() * weak.scales().force
    assert result.opened == 1
    assert result.tension == pytest.approx(expected, rel=2e-3)
    assert vt.which_opens(strong, weak).tension == pytest.approx(expected, rel=0.05)


def test_energy_is_balanced_over_both_contacts_and_the_spring():
    first = contact(ELASTIC, work=0.25, stiffness=300.0)
    result = vt.simulate_in_series(first, contact(work=0.12, stiffness=300.0))
    assert result.energy_residual < 1e-3


@pytest.mark.parametrize(
    "speed, opened", [pytest.param(1e-5, 1, marks=pytest.mark.slow), (1e-3, 0)]
)
def test_a_slow_stamp_opens_and_a_fast_one_picks_from_an_elastic_donor(speed, opened):
    donor, stamp = contact(ELASTIC, work=0.4, speed=speed), contact(speed=speed)
    cheap, result = vt.which_opens(donor, stamp), vt.simulate_in_series(donor, stamp)
    assert (cheap.opened, result.opened) == (opened, opened)
    assert cheap.tension == pytest.approx(result.tension, rel=max(cheap.bands))
    assert cheap.method == "steady cracks"


def test_a_contact_on_a_layer_is_undecided_without_a_simulation():
    layer = vt.Layer(thickness=1e-3, base=vt.Bonded(poisson_ratio=0.5))
    donor, stamp = contact(ELASTIC, work=0.1), replace(contact(), body=layer)
    found = vt.which_opens(donor, stamp)
    assert found.opened is None
    simulated = vt.which_opens(donor, stamp, simulate=True)
    assert simulated.opened == 0
    assert simulated.method == "simulation"


def test_an_interface_that_grows_with_speed_is_simulated_only():
    law = vt.GentSchultz(0.15, 6e-7, reference_speed=1e-5, exponent=0.4)
    donor, at_rest = contact(ELASTIC, work=0.4, speed=1e-5), contact(speed=1e-5)
    grown = replace(at_rest, traction=law)
    found = vt.which_opens(donor, grown)
    assert found.opened is None
    results = [vt.simulate_in_series(donor, stamp, accuracy=0.02) for stamp in (at_rest, grown)]
    assert [result.opened for result in results] == [1, 0]


@pytest.mark.parametrize(
    "change, words",
    [
        ({"protocol": vt.Retraction(start=vt.AtDepth(1e-6), speed=1e-4)}, "common force"),
        (
            {"protocol": vt.Retraction(vt.AtForce(2e-3), 1e-4, moves=(vt.Dwell(1.0),))},
            "without other moves",
        ),
        ({"protocol": vt.Retraction(vt.AtForce(2e-3), 2e-4)}, "the same protocol"),
        ({"geometry": vt.FlatPunch(1e-4), "body": vt.Layer(1e-4)}, "take a disc"),
    ],
)
def test_pairs_that_are_not_one_object_in_one_machine_are_refused(change, words):
    with pytest.raises(ValueError, match=words):
        vt.which_opens(contact(), replace(contact(), **change))


def test_critical_speeds_are_where_the_tension_is_the_pull_off_force_of_an_elastic_donor():
    donor = contact(ELASTIC, work=0.4)
    found = vt.window(contact(), donor=donor, speeds=[1e-5, 1e-3], preloads=[2e-3])
    (critical,) = found.critical_speeds
    base = contact(ELASTIC, work=0.4, speed=critical.speed, force=critical.preload)
    stamp = contact(speed=critical.speed, force=critical.preload)
    assert vt.which_opens(base, stamp).tension == pytest.approx(elastic_pull_off(base), rel=2e-3)
    low, high = critical.interval
    assert low < critical.speed < high
    assert (critical.below, critical.above) == ("stamp", "donor")


def test_cells_without_a_relaxed_contact_are_undecided_with_the_reason():
    donor = contact(ELASTIC, work=0.4)
    found = vt.window(contact(), donor=donor, speeds=[1e-5], preloads=[-1.0, 2e-3])
    assert found.cells[0].word == "undecided"
