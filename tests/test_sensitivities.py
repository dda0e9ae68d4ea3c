"""Elasticities of a simulation: relations of scale, limits, finer differences, and refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from dimensionless import SOLID, punch
from solids import standard_solid
from viscotack.simulate.sensitivities import changed_inputs

ARMS = vt.Prony(rubbery_modulus=1.0, branches=[(4.0, 0.03), (5.0, 1.0)], poisson_ratio=0.0)
PULL = vt.Groups(tabor=1.5, material=ARMS, start=vt.AtDepth(6.0), rate=8.0)
FORCE, WORK, DEPTH = "pull_off_force", "work_to_pull_off", "depth_at_pull_off"


def found(problem, names=True, **options):
    result = vt.solve(
        problem, until="pull-off", estimate_error=False, sensitivities=names, **options
    )
    return result.sensitivities


def lens(**changes):
    rubber = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=8e6, tau0=0.1, poisson_ratio=0.49)
    parts = {
        "material": rubber,
        "traction": vt.LennardJones(0.1, 1e-6),
        "geometry": vt.Sphere(3e-3),
        "protocol": vt.Retraction(start=vt.AtForce(2e-3), speed=3e-5),
    }
    return vt.Problem(**(parts | changes))


@pytest.fixture(scope="module")
def pulled():
    return found(PULL)


def test_inputs_have_the_paths_of_campaigns():
    case = vt.read_case(Path(__file__).parents[1] / "examples" / "from_toml" / "lens.toml")
    for problem in (PULL, case):
        names = changed_inputs(problem)
        assert names and names.keys() <= vt.campaign.inputs_of(problem).keys()
    # reduced numbers of a dimensionless problem cannot change
    assert "material.rubbery_modulus" not in changed_inputs(PULL)


def test_an_input_is_changed_to_both_sides_within_its_range():
    at_end = lens(material=replace(lens().material, poisson_ratio=0.5))
    assert list(changed_inputs(lens())["material.tau0"]) == [-0.02, 0.02]
    sides = changed_inputs(at_end)["material.poisson_ratio"]
    values = [problem.material.poisson_ratio for problem in sides.values()]
    assert values == pytest.approx(0.5 * np.exp([-0.04, -0.02]), rel=1e-14)


@pytest.mark.parametrize("output", [FORCE, WORK, DEPTH])
def test_only_the_product_of_rate_and_times_matters(pulled, output):
    by, off = pulled.elasticities[output], pulled.errors[output]
    times = [f"material.branches.{arm}.1" for arm in range(2)]
    error = sum(off[name] for name in [*times, "rate"])
    assert error < 0.02
    assert sum(by[name] for name in times) == pytest.approx(by["rate"], abs=error)


@pytest.mark.parametrize("name", ["material.branches.0.0", "preload"])
def test_elasticities_are_slopes_through_finer_simulations(pulled, name):
    steps = np.array([-0.02, 0.02])
    value = vt.campaign.inputs_of(PULL)[name].value
    outputs = []
    for step in steps:
        other = value * np.exp(step)
        if name == "preload":
            case = replace(PULL, start=vt.AtDepth(other))
        else:
            arms = [(other, 0.03), (5.0, 1.0)]
            case = replace(PULL, material=replace(ARMS, branches=arms))
        result = vt.solve(case, until="pull-off", accuracy=5e-4, estimate_error=False)
        outputs.append([vt.summary(result)[output] for output in (FORCE, WORK, DEPTH)])
    slopes = np.diff(np.log(outputs), axis=0)[0] / 0.04
    for output, slope in zip((FORCE, WORK, DEPTH), slopes, strict=True):
        error = pulled.errors[output][name]
        assert error < 0.03
        assert pulled.elasticities[output][name] == pytest.approx(slope, abs=error + 1e-3)


def test_a_move_to_a_force_and_a_dwell_scale_with_time():
    moves = vt.Approach(to=vt.AtForce(6.0), speed=3.0), vt.Dwell(0.5)
    test = vt.Groups(tabor=1.0, material=SOLID, start=vt.AtForce(1.0), rate=5.0, moves=moves)
    names = ["rate", "moves.0.speed", "material.tau0", "moves.1.duration"]
    by = found(test, names, accuracy=0.01)
    by = by.elasticities[FORCE]
    # every time of the problem scaled by one factor changes nothing
    assert by["rate"] + by["moves.0.speed"] == pytest.approx(
        by["material.tau0"] + by["moves.1.duration"], rel=3e-3
    )


@pytest.mark.slow
def test_in_si_units_of_stress_length_and_time_do_not_matter():
    case = found(lens())
    by, off = case.elasticities[FORCE], sum(case.errors[FORCE].values())
    assert off < 0.02
    stresses = by["material.rubbery_modulus"] + by["material.glassy_modulus"]
    work, load = by["interface.work_of_adhesion"], by["protocol.preload_force"]
    # of force = stress times length squared, work of adhesion = stress times length
    assert stresses + work + load == pytest.approx(1.0, abs=off)
    lengths = by["interface.equilibrium_gap"] + by["sphere.radius"] + by["protocol.speed"]
    assert lengths + work + 2 * load == pytest.approx(2.0, abs=off)
    assert by["protocol.speed"] == pytest.approx(by["material.tau0"], abs=off)


@pytest.mark.slow
def test_the_force_of_an_elastic_contact_is_that_of_jkr():
    # at a Tabor number of 8
    soft = lens(
        material=vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.49),
        traction=vt.LennardJones(0.1, 1e-7),
        geometry=vt.Sphere(1e-4),
        protocol=vt.Retraction(start=vt.AtForce(1e-4), speed=3e-5),
    )
    jkr = {"sphere.radius": 1.0, "interface.work_of_adhesion": 1.0, "material.rubbery_modulus": 0.0}
    by = found(soft, jkr, accuracy=3e-3).elasticities[FORCE]
    assert by == pytest.approx(jkr, abs=0.02)


def test_only_named_inputs_are_computed_and_saved(tmp_path):
    done = []
    result = vt.solve(
        PULL, until="pull-off", accuracy=0.02, sensitivities=["rate"], progress=done.append
    )
    assert set(result.sensitivities.inputs) == {"rate"}
    assert done == sorted(done) and done[-1] == pytest.approx(1.0)
    vt.save(result, tmp_path / "run.npz")
    assert vt.load(tmp_path / "run.npz").sensitivities == result.sensitivities
    with pytest.raises(ValueError, match="thickness"):
        found(PULL, ["thickness"])


def test_inputs_that_move_the_pull_off_to_another_peak_have_no_elasticity():
    # two peaks are equal at a rate of about 0.804 of the depth (tests/ladder/test_simulation.py)
    solid = standard_solid(1.0, 1 / 2.4e-4, 1.0, 0.0)
    start = vt.AtDepth(78.9)
    two = vt.Groups(tabor=2.1, material=solid, start=start, rate=0.804 * 78.9)
    case = found(two, ["rate"], accuracy=0.02)
    assert "rate" in case.refused and not case.elasticities
    one = found(replace(two, rate=0.7 * 78.9), ["rate"], accuracy=0.02)
    assert "rate" in one.elasticities[FORCE]


def test_an_elasticity_below_the_numerical_error_is_refused():
    solid = vt.Elastic(rubbery_modulus=1, poisson_ratio=0)
    test = vt.Groups(tabor=5.0, material=solid, start=vt.AtDepth(5.0), rate=5.0)
    case = found(test, accuracy=0.02)
    for output, each in case.elasticities.items():
        for name, slope in each.items():
            assert case.errors[output][name] <= 0.1 * (1 + abs(slope))
    assert any(key.startswith(DEPTH) for key in case.refused)


def test_growing_interfaces_and_punches_have_elasticities():
    growing = vt.Eyring.of(vt.LennardJones(1.0, 1.0), reference_speed=1.0, sensitivity=0.1)
    aged = replace(PULL, traction=growing)
    by = found(aged, ["interface.sensitivity", "interface.reference_speed"], accuracy=0.01)
    by = by.elasticities[FORCE]
    assert by["interface.sensitivity"] > 0 > by["interface.reference_speed"]
    short = punch(vt.AtDepth(1.0), size=20.0, thickness=3.0, rate=1.0)
    by = found(short, ["rate", "material.tau0"], accuracy=0.01).elasticities["pull_off_stress"]
    assert by["rate"] == pytest.approx(by["material.tau0"], rel=1e-6)
