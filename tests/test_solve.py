"""What the solver says when it is asked for something it cannot do, and what it keeps."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from dimensionless import ELASTIC, SOLID, punch, resized
from solids import relaxation_power_law
from viscotack.model.materials import Material
from viscotack.simulate import Settings
from viscotack.simulate.jumps import _MOST_MESHES
from viscotack.simulate.mesh import MOST_NODES


def case(start=None, tabor=1.0, rate=10.0, material: Material = SOLID):
    return vt.Groups(tabor=tabor, material=material, start=start or vt.AtDepth(1.0), rate=rate)


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (vt.AtDepth(-9.0), "no relaxed contact exists at a depth of -9 h0"),
        (vt.AtForce(-1.5), "no relaxed contact has a force of -1.5"),
        (vt.AtRadius(1e-3), "no relaxed contact has a contact radius of 0.001"),
    ],
    ids=["depth", "force", "radius"],
)
def test_a_start_that_does_not_exist_is_refused(start, words):
    with pytest.raises(ValueError, match=words):
        vt.solve(case(start))


def soft_law(start, *moves, **changes):
    """Return a test with a law that repels with no more than 4 exp(2) dg0/h0, at a gap of 0."""
    return vt.Groups(
        tabor=0.1,
        material=ELASTIC,
        start=start,
        rate=1.0,
        traction=vt.Exponential(1.0, 1.0, decay=0.5),
        moves=moves,
        **changes,
    )


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (vt.AtDepth(4.0), "at a depth of 4 h0 .* presses with up to 31.8"),
        (
            vt.AtForce(45.0),
            "a force of 45 .dimensionless. is not reached: .* presses with up to 29.5",
        ),
    ],
    ids=str,
)
def test_a_start_that_presses_harder_than_the_law_repels_is_told_so(start, words):
    with pytest.raises(ValueError, match=words + ".*repels with 29.56 dg0/h0 at most, at a gap of"):
        vt.solve(soft_law(start))


@pytest.mark.parametrize("start", [vt.AtDepth(3.5), vt.AtRadius(5.0)], ids=str)
def test_a_start_that_presses_nearly_as_hard_as_the_law_repels_exists(start):
    # Bradley's force and that of DMT: such a contact is nearly rigid
    found = vt.pull_off_force(vt.solve(soft_law(start), until="pull-off", estimate_error=False))
    assert found == pytest.approx(4 / 3, rel=0.02)


@pytest.mark.parametrize(
    "changes",
    [
        {"moves": (vt.Approach(speed=1.0, to=vt.AtDepth(6.0)),), "start": vt.Apart(3.0)},
        {"moves": (vt.LoadTo(force=80.0, duration=10.0),)},
    ],
    ids=["from apart", "loaded"],
)
def test_a_march_that_presses_harder_than_the_law_repels_says_where_it_stopped(changes):
    result = vt.solve(replace(soft_law(vt.AtDepth(1.0)), **changes), throw=False)
    assert result.outcome == "stopped"
    # where the start by depth ends too
    assert "beyond a depth of 3.6" in result.status
    assert "repels with 29.56 dg0/h0 at most, at a gap of 0" in result.status


def test_a_run_that_meets_its_bound_says_so_and_can_be_kept():
    settings = replace(Settings.for_accuracy(2e-3), most_steps=5)
    with pytest.raises(
        vt.SimulationError, match="bound of 5 steps was met at a depth of"
    ) as failure:
        vt.solve(case(), settings=settings)
    kept = vt.solve(case(), settings=settings, throw=False)
    assert kept.status == str(failure.value)
    assert kept.outcome == "stopped"
    assert kept.error_estimate is None
    assert len(kept.time) == 6


def test_a_run_that_loses_energy_has_no_numbers():
    careless = replace(
        Settings.for_accuracy(0.02), imbalance=1e3, step_error=1e3, force_change=1e3, travel=2.0,
        first_travel=0.5,
    )  # fmt: skip
    with pytest.raises(vt.SimulationError, match="of the energy is not accounted for"):
        vt.solve(case(vt.AtDepth(5.0)), settings=careless)


@pytest.mark.march
def test_the_same_problem_gives_the_same_bytes():
    first, second = (vt.solve(case(), until="pull-off") for _ in range(2))
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
    groups = case(vt.AtDepth(depth), tabor, rate=1.0, material=material)
    coarse = vt.solve(groups, until="pull-off")
    fine = vt.solve(groups, accuracy=2e-4, until="pull-off", estimate_error=False)
    work, estimate = vt.work_to_pull_off(coarse), coarse.error_estimate["work"]
    # the fine run has about half of the error: the minimum moves with that of the force
    error = 1.7 * abs(work - vt.work_to_pull_off(fine)) / work
    assert error < estimate < 5 * error


def test_fields_are_kept_on_request_and_agree_with_the_force():
    result = vt.solve(case(), until="pull-off", fields=True, estimate_error=False)
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
    assert vt.solve(case(), until="pull-off", estimate_error=False).fields is None


def test_what_watches_a_run_is_told_its_curve_and_ends_it():
    steps = []
    result = vt.solve(case(), watch=lambda *step: steps.append(step))
    told = np.array(steps).T
    for name, seen in zip(("time", "depth", "force", "contact_radius"), told, strict=True):
        np.testing.assert_array_equal(seen, getattr(result, name)[1:])

    def enough(*step):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        vt.solve(case(), watch=enough)


@pytest.mark.march
def test_an_elastic_jump_is_found_and_booked():
    result = vt.solve(case(vt.AtDepth(-5.0), 3.24, 1.0, ELASTIC), estimate_error=False)
    assert result.status.startswith("jumped at depth -5.3")
    out = [event for event in result.events if event.kind == "jump out of contact"]
    assert len(out) == 1
    # 0.3666 from runs refined in mesh and steps
    assert result.energy.jumps[-1] == pytest.approx(0.3666, rel=0.02, abs=0)
    assert result.energy.heat[-1] == 0.0


@pytest.mark.parametrize(
    "problem",
    [
        case(vt.AtDepth(20.0), tabor=3.0, rate=30.0),
        case(vt.AtDepth(3.0), tabor=0.5, rate=300.0),
        punch(vt.AtDepth(1.0), rate=10.0),
    ],
    ids=["sphere", "small Tabor number", "punch"],
)
def test_the_stated_errors_hold_the_errors_at_the_pull_off(problem):
    result = vt.solve(problem, accuracy=0.01, until="pull-off")
    finer = vt.solve(problem, accuracy=0.001, until="pull-off", estimate_error=False)
    stated = result.error_estimate
    assert abs(vt.pull_off_force(result) / vt.pull_off_force(finer) - 1) < stated["force"] < 0.05
    assert abs(vt.work_to_pull_off(result) / vt.work_to_pull_off(finer) - 1) < stated["work"] < 0.1
    # of the travel in tension, about the work over the force
    off = abs(vt.depth_at_pull_off(result) - vt.depth_at_pull_off(finer))
    assert off < stated["depth"] < 0.1 * vt.work_to_pull_off(finer) / vt.pull_off_force(finer)


def test_a_runaway_behind_a_soft_spring_adds_no_work():
    """Steps before the jump have one time to the last digit; F0^2/2K is 63,000."""
    law = vt.Eyring(1.0, 1.0, reference_speed=10.0, sensitivity=0.5, base=vt.LennardJones(1.0, 1.0))
    start = case(vt.AtDepth(1.0), tabor=0.2, rate=1e5, material=ELASTIC)
    groups = replace(start, traction=law, stiffness=2e-5)
    result = vt.solve(groups, accuracy=0.01, estimate_error=False, throw=False)
    assert vt.work_to_pull_off(result) < vt.work_of_separation(result) < 10


def test_the_stated_error_of_the_work_holds_under_a_growing_load():
    """Companions may detach at the same depth by chance, and finer runs elsewhere."""
    solid = relaxation_power_law(1.0, 5.0, 1.0, 1.0, 0.0)
    rest = case(vt.AtForce(0.0), tabor=0.18, material=solid)
    pulled = replace(rest, rate=None, moves=(vt.LoadTo(force=-5.8, duration=0.055),))
    runs = [vt.solve(pulled, accuracy=accuracy) for accuracy in (0.01, 0.005, 0.001)]
    work = np.array([vt.work_to_pull_off(each) for each in runs])
    error = work * [each.error_estimate["work"] for each in runs]
    depth = np.array([vt.depth_at_pull_off(each) for each in runs])
    shift = np.array([each.error_estimate["depth"] for each in runs])
    assert np.all(np.abs(work - work[-1]) <= error)
    assert np.all(np.abs(depth - depth[-1]) <= shift)
    assert np.all(error < 0.2 * work)


# What a simulation refuses: how many of what, how large, and numbers beyond the physical.
SPHERE, PUNCH = case(), punch(vt.AtDepth(1.0), size=20.0, thickness=3.0, rate=10.0)


# --- how many
def test_a_mesh_of_too_many_nodes_is_refused_before_there_is_a_matrix():
    tracemalloc.start()
    with pytest.raises(vt.InputError, match="nodes, and a simulation takes up to 4000: ask for"):
        vt.solve(resized(PUNCH, size=2000.0, thickness=1.0, base=vt.Bonded(poisson_ratio=0.5)))
    with pytest.raises(vt.InputError, match="the mesh would have .* nodes"):
        vt.solve(replace(SPHERE, tabor=19.0), accuracy=1e-6)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < MOST_NODES**2  # bytes: a matrix has eight times as many


@pytest.mark.march
def test_a_wide_punch_on_a_thin_bonded_layer_is_solved():
    glued = resized(PUNCH, size=60.0, thickness=0.5, base=vt.Bonded(poisson_ratio=0.5))
    result = vt.solve(glued, accuracy=0.02, estimate_error=False)
    # the last of it may go in a jump
    assert result.outcome in (vt.Outcome.DETACHED, vt.Outcome.JUMPED)
    # all of it reaches the strength at once, and the edge is where the mesh has it
    assert -result.force.min() == pytest.approx(1.0, abs=0.02)
    assert result.statistics["meshes"] < _MOST_MESHES


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (replace(SPHERE, rate=1e300), "the rate of the retraction"),
        (replace(SPHERE, stiffness=1e-300), "the stiffness of the machine"),
        (replace(PUNCH, start=vt.AtDepth(1e30)), "depth of about 1e.30 h0"),
        (replace(SPHERE, moves=(vt.Dwell(1.0), vt.MoveTo(1e300, 1.0))), "the depth of move 2"),
        (replace(SPHERE, moves=(vt.Dwell(1e18),)), "the retraction begins with steps of"),
        (resized(PUNCH, size=1e-8, thickness=1e8), "thickness over size"),
    ],
)
def test_a_number_that_no_simulation_takes_is_named(problem, said):
    with pytest.raises(vt.InputError, match=said):
        vt.solve(problem)


@pytest.mark.march
@pytest.mark.parametrize(
    ("large", "limit"),
    [
        ({"rate": 1e99}, {"rate": 1e15}),
        ({"stiffness": 1e99}, {"stiffness": 1e9}),
        ({"moves": (vt.Dwell(1e8),)}, {"moves": (vt.Dwell(1e4),)}),
    ],
)
def test_within_the_bounds_the_limits_answer(large, limit):
    one, other = (
        vt.solve(replace(SPHERE, **changes), until="pull-off", estimate_error=False)
        for changes in (large, limit)
    )
    assert one.force.min() == pytest.approx(other.force.min(), rel=2e-3)
