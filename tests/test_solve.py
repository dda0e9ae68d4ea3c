"""What the solver says when it is asked for something it cannot do, and what it keeps."""

from dataclasses import replace

import numpy as np
import pytest

from viscotack.model.geometry import FlatPunch, Layer
from viscotack.model.materials import Elastic, Material, RelaxationPowerLaw, StandardSolid
from viscotack.model.problem import Groups
from viscotack.model.protocol import Apart, Approach, AtDepth, AtForce, AtRadius, LoadTo
from viscotack.model.traction import Exponential, Eyring, LennardJones
from viscotack.result.observables import (
    depth_at_pull_off,
    pull_off_force,
    summary,
    work_of_separation,
    work_to_pull_off,
)
from viscotack.simulate import Settings, SimulationError, solve

SOLID = StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)

ELASTIC = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)


def case(start=None, tabor=1.0, rate=10.0, material: Material = SOLID):
    return Groups(tabor=tabor, material=material, start=start or AtDepth(1.0), rate=rate)


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (AtDepth(-9.0), "no relaxed contact exists at a depth of -9 h0"),
        (AtForce(-1.5), "no relaxed contact has a force of -1.5"),
        (AtRadius(1e-3), "no relaxed contact has a contact radius of 0.001"),
    ],
    ids=["depth", "force", "radius"],
)
def test_a_start_that_does_not_exist_is_refused(start, words):
    with pytest.raises(ValueError, match=words):
        solve(case(start))


def soft_law(start, *moves, **changes):
    """Return a test with a law that repels with no more than 4 exp(2) dg0/h0, at a gap of 0."""
    return Groups(
        tabor=0.1,
        material=ELASTIC,
        start=start,
        rate=1.0,
        traction=Exponential(1.0, 1.0, decay=0.5),
        moves=moves,
        **changes,
    )


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (AtDepth(4.0), "at a depth of 4 h0 .* presses with up to 31.8"),
        (AtForce(45.0), "a force of 45 .dimensionless. is not reached: .* presses with up to 29.5"),
    ],
    ids=str,
)
def test_a_start_that_presses_harder_than_the_law_repels_is_told_so(start, words):
    with pytest.raises(ValueError, match=words + ".*repels with 29.56 dg0/h0 at most, at a gap of"):
        solve(soft_law(start))


@pytest.mark.parametrize("start", [AtDepth(3.5), AtRadius(5.0)], ids=str)
def test_a_start_that_presses_nearly_as_hard_as_the_law_repels_exists(start):
    # Bradley's force and that of DMT: such a contact is nearly rigid
    found = pull_off_force(solve(soft_law(start), until="pull-off", estimate_error=False))
    assert found == pytest.approx(4 / 3, rel=0.02)


@pytest.mark.parametrize(
    "changes",
    [
        {"moves": (Approach(speed=1.0, to=AtDepth(6.0)),), "start": Apart(3.0)},
        {"moves": (LoadTo(force=80.0, duration=10.0),)},
    ],
    ids=["from apart", "loaded"],
)
def test_a_march_that_presses_harder_than_the_law_repels_says_where_it_stopped(changes):
    result = solve(replace(soft_law(AtDepth(1.0)), **changes), throw=False)
    assert result.outcome == "stopped"
    # where the start by depth ends too
    assert "beyond a depth of 3.6" in result.status
    assert "repels with 29.56 dg0/h0 at most, at a gap of 0" in result.status


def test_a_run_that_meets_its_bound_says_so_and_can_be_kept():
    from dataclasses import replace

    settings = replace(Settings.for_accuracy(2e-3), most_steps=5)
    with pytest.raises(SimulationError, match="bound of 5 steps was met at a depth of") as failure:
        solve(case(), settings=settings)
    kept = solve(case(), settings=settings, throw=False)
    assert kept.status == str(failure.value)
    assert kept.outcome == "stopped"
    assert kept.error_estimate is None
    assert len(kept.time) == 6


def test_a_run_that_loses_energy_has_no_numbers():
    from dataclasses import replace

    careless = replace(
        Settings.for_accuracy(0.02), imbalance=1e3, step_error=1e3, force_change=1e3, travel=2.0,
        first_travel=0.5,
    )  # fmt: skip
    with pytest.raises(SimulationError, match="of the energy is not accounted for"):
        solve(case(AtDepth(5.0)), settings=careless)


@pytest.mark.march
def test_the_same_problem_gives_the_same_bytes():
    first, second = (solve(case(), until="pull-off") for _ in range(2))
    for name in ("time", "depth", "force", "contact_radius", "edge_speed"):
        assert np.array_equal(getattr(first, name), getattr(second, name), equal_nan=True)
    assert first.error_estimate == second.error_estimate


@pytest.mark.parametrize(
    ("tabor", "depth", "material"),
    [(0.01, 0.0, ELASTIC), (0.1, -0.03, SOLID)],
    ids=["elastic", "viscoelastic"],
)
def test_the_stated_error_covers_that_of_a_small_work(tabor, depth, material):
    # the way to the force minimum is short, and the minimum is flat
    groups = case(AtDepth(depth), tabor, rate=1.0, material=material)
    coarse = solve(groups, until="pull-off")
    fine = solve(groups, accuracy=2e-4, until="pull-off", estimate_error=False)
    work, estimate = work_to_pull_off(coarse), coarse.error_estimate["work"]
    # the fine run has about half of the error: the minimum moves with that of the force
    error = 1.7 * abs(work - work_to_pull_off(fine)) / work
    assert error < estimate < 5 * error


def test_a_work_that_is_lost_in_its_error_is_not_told():
    result = solve(case(AtDepth(0.0), 1e-3, material=ELASTIC), until="pull-off")
    with pytest.raises(ValueError, match="is half of it or more.*start deep"):
        work_to_pull_off(result)
    answer = summary(result)
    assert answer["work_to_pull_off"] is None
    assert "is half of it or more" in answer["work_to_pull_off_note"]
    assert answer["error_estimate"]["work"] > 0.5
    assert answer["pull_off_force"] == pytest.approx(4 / 3, rel=0.06)
    assert pull_off_force(result) == answer["pull_off_force"]


def test_fields_are_kept_on_request_and_agree_with_the_force():
    result = solve(case(), until="pull-off", fields=True, estimate_error=False)
    fields = result.fields
    assert fields is not None
    assert fields["radius"].shape == fields["pressure"].shape == fields["gap"].shape
    assert len(fields["time"]) == len(result.time) == len(fields["radius"])
    for i in (0, len(result.time) // 2, -1):
        r, p = fields["radius"][i], fields["pressure"][i]
        known = np.isfinite(r)
        beta = r[known] * np.pi ** (1 / 3)
        force = np.trapezoid(p[known] * 2 * np.pi * beta, beta) * 2 * 1.0 / (3 * np.pi)
        # trapezoid on this mesh against hats and tail: a few per cent of the unit force
        assert force == pytest.approx(result.force[i], abs=0.05)
    assert solve(case(), until="pull-off", estimate_error=False).fields is None


def test_what_watches_a_run_is_told_its_curve_and_ends_it():
    steps = []
    result = solve(case(), watch=lambda *step: steps.append(step))
    told = np.array(steps).T
    for name, seen in zip(("time", "depth", "force", "contact_radius"), told, strict=True):
        np.testing.assert_array_equal(seen, getattr(result, name)[1:])

    def enough(*step):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solve(case(), watch=enough)


@pytest.mark.march
def test_an_elastic_jump_is_found_and_booked():
    elastic = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    result = solve(case(AtDepth(-5.0), 3.24, 1.0, elastic), estimate_error=False)
    assert result.status.startswith("jumped at depth -5.3")
    out = [event for event in result.events if event.kind == "jump out of contact"]
    assert len(out) == 1
    # 0.3666 from runs refined in mesh and steps
    assert result.energy.jumps[-1] == pytest.approx(0.3666, rel=0.02, abs=0)
    assert result.energy.heat[-1] == 0.0


@pytest.mark.parametrize(
    "problem",
    [
        case(AtDepth(20.0), tabor=3.0, rate=30.0),
        case(AtDepth(3.0), tabor=0.5, rate=300.0),
        Groups(
            tabor=None,
            cohesion=0.05,
            geometry=FlatPunch(64.85),
            body=Layer(3.24),
            material=SOLID,
            start=AtDepth(1),
            rate=10,
        ),
    ],
    ids=["sphere", "small Tabor number", "punch"],
)
def test_the_stated_errors_hold_the_errors_at_the_pull_off(problem):
    result = solve(problem, accuracy=0.01, until="pull-off")
    finer = solve(problem, accuracy=0.001, until="pull-off", estimate_error=False)
    stated = result.error_estimate
    assert abs(pull_off_force(result) / pull_off_force(finer) - 1) < stated["force"] < 0.05
    assert abs(work_to_pull_off(result) / work_to_pull_off(finer) - 1) < stated["work"] < 0.1
    # of the travel in tension, about the work over the force
    off = abs(depth_at_pull_off(result) - depth_at_pull_off(finer))
    assert off < stated["depth"] < 0.1 * work_to_pull_off(finer) / pull_off_force(finer)


def test_a_runaway_behind_a_soft_spring_adds_no_work():
    """Steps before the jump have one time to the last digit; F0^2/2K is 63,000."""
    law = Eyring(1.0, 1.0, reference_speed=10.0, sensitivity=0.5, base=LennardJones(1.0, 1.0))
    start = case(AtDepth(1.0), tabor=0.2, rate=1e5, material=ELASTIC)
    groups = replace(start, traction=law, stiffness=2e-5)
    result = solve(groups, accuracy=0.01, estimate_error=False, throw=False)
    assert work_to_pull_off(result) < work_of_separation(result) < 10


def test_the_stated_error_of_the_work_holds_under_a_growing_load():
    """Companions may detach at the same depth by chance, and finer runs elsewhere."""
    solid = RelaxationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=5.0, exponent=1.0, tau0=1.0, poisson_ratio=0.0
    )
    rest = case(AtForce(0.0), tabor=0.18, material=solid)
    pulled = replace(rest, rate=None, moves=(LoadTo(force=-5.8, duration=0.055),))
    runs = [solve(pulled, accuracy=accuracy) for accuracy in (0.01, 0.005, 0.0025, 0.001)]
    work = np.array([work_to_pull_off(each) for each in runs])
    error = work * [each.error_estimate["work"] for each in runs]
    depth = np.array([depth_at_pull_off(each) for each in runs])
    shift = np.array([each.error_estimate["depth"] for each in runs])
    assert np.all(np.abs(work - work[-1]) <= error)
    assert np.all(np.abs(depth - depth[-1]) <= shift)
    assert np.all(error < 0.2 * work)
