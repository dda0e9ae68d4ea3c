"""Plans over any number of a problem: bodies, tips, laws, and what the machine does."""

import numpy as np
import pytest

from campaign_work import InlineCrew, employ
from command_line import exit_status
from viscotack import (
    Approach,
    AtDepth,
    AtForce,
    Bonded,
    Cone,
    Dwell,
    FlatPunch,
    Groups,
    InputError,
    Layer,
    LennardJones,
    PowerLawProfile,
    Problem,
    Retraction,
    StandardSolid,
    read_case,
)
from viscotack.campaign import (
    CaseSettings,
    Store,
    every_combination,
    inputs_of,
    read_plan,
    run,
    space_filling,
)

RUBBER = StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.02, poisson_ratio=0.45)
LAW = LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
PAD = Problem(
    material=RUBBER,
    traction=LAW,
    geometry=FlatPunch(half_width=1e-3),
    body=Layer(thickness=5e-5, base=Bonded(poisson_ratio=0.45)),
    protocol=Retraction(start=AtForce(2e3), speed=1e-4),
)
MOVES = (Approach(speed=1e-5, to=AtForce(1.5e-3)), Dwell(duration=60.0), Dwell(10.0, hold="force"))
CONE = Problem(
    material=RUBBER,
    traction=LAW,
    geometry=Cone(slope=0.1),
    protocol=Retraction(start=AtDepth(2e-6), speed=1e-4, moves=MOVES),
)
TIP = Problem(
    material=RUBBER,
    traction=LAW,
    geometry=PowerLawProfile(coefficient=200.0, exponent=2.0),
    protocol=Retraction(start=AtDepth(2e-6), speed=1e-4),
)
PAD_FILE = """
[material]
model = "sls"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
tau0 = "20 ms"
poisson_ratio = 0.45
[interface]
law = "lennard-jones"
work_of_adhesion = "0.15 J/m^2"
equilibrium_gap = "1.5 um"
[punch]
half_width = "1 mm"
[layer]
thickness = "50 um"
base = "bonded"
[protocol]
preload_stress = "2 kPa"
speed = "100 um/s"
"""
OVER_PAD = {
    "geometry.half_width": {"log": ["0.1 mm", "10 mm"]},
    "body.thickness": {"log": ["10 um", 1e-4]},
    "material.poisson_ratio": {"linear": [0.2, 0.49]},
    "protocol.start.force": {"linear": ["1 kPa", "3 kPa"]},
}


def problems(plan):
    return [plan.kind.problem(case.inputs) for case in plan.cases]


def shares(values, low, high):
    """Return in which of so many parts of a logarithmic range each value lies, in order."""
    places = np.log(np.array(values) / low) / np.log(high / low)
    return np.sort(np.floor(places * len(values))).tolist()


def test_a_fill_over_a_punch_and_its_layer_has_units_and_covers_them_evenly():
    plan = space_filling(PAD, OVER_PAD, cases=32)
    found = problems(plan)
    assert shares([p.geometry.half_width for p in found], 1e-4, 1e-2) == list(range(32))
    assert shares([p.body.thickness for p in found], 1e-5, 1e-4) == list(range(32))
    stresses = [p.protocol.start.force for p in found]
    assert 1e3 <= min(stresses) < 1.1e3 and 2.9e3 < max(stresses) <= 3e3
    # a bonded layer is of one piece with its material
    assert {p.body.base.poisson_ratio == p.material.poisson_ratio for p in found} == {True}
    assert len({p.material.poisson_ratio for p in found}) == 32


def test_a_file_and_python_state_the_same_cases(tmp_path):
    (tmp_path / "pad.toml").write_text(PAD_FILE)
    lines = [f"{path} = {str(given).replace(':', ' =')}" for path, given in OVER_PAD.items()]
    text = "\n".join(lines).replace("'log'", "log").replace("'linear'", "linear")
    text = f'problem = "pad.toml"\n[[fill]]\ncases = 20\nmethod = "latin-hypercube"\n{text}\n'
    (tmp_path / "plan.toml").write_text(text)
    assert read_case(tmp_path / "pad.toml") == PAD
    ours = space_filling(PAD, OVER_PAD, cases=20, method="latin-hypercube")
    assert read_plan(tmp_path / "plan.toml").cases == ours.cases and len(ours.cases) == 20
    assert ours.base == read_plan(tmp_path / "plan.toml").base


def test_tips_of_every_exponent_have_the_height_that_was_given():
    over = {
        "geometry.exponent": {"linear": [1.0, 4.0]},
        "geometry.height": "10 um",
        "geometry.at_radius": {"log": ["0.1 mm", "1 mm"]},
    }
    plan = space_filling(TIP, over, cases=32)
    for case, problem in zip(plan.cases, problems(plan), strict=True):
        assert problem.geometry.exponent == case.inputs["geometry.exponent"]
        radius = case.inputs["geometry.at_radius"]
        assert problem.geometry.gap(radius) == pytest.approx(1e-5, rel=1e-12)


def test_a_fill_goes_over_what_the_machine_does():
    over = {
        "protocol.moves.0.speed": {"log": ["1 um/s", "1 mm/s"]},
        "protocol.moves.0.to.force": {"linear": ["1 mN", "2 mN"]},
        "protocol.moves.1.duration": {"log": ["1 s", "1 h"]},
        "protocol.moves.2.duration": {"choose": ["1 s", "2 min"], "weights": [3, 1]},
        "protocol.stiffness": {"log": ["10 N/m", "1000 N/m"]},
        "geometry.slope": {"log": [0.02, 0.2]},
    }
    plan = space_filling(CONE, over, cases=32)
    found = [p.protocol for p in problems(plan)]
    assert shares([p.moves[0].speed for p in found], 1e-6, 1e-3) == list(range(32))
    assert shares([p.moves[1].duration for p in found], 1.0, 3600.0) == list(range(32))
    # what the base has left out is given
    assert CONE.protocol.stiffness is None and shares(
        [p.stiffness for p in found], 10, 1000
    ) == list(range(32))
    assert sum(p.moves[2].duration == 1.0 for p in found) == 24
    assert {(p.moves[2].hold, type(p.moves[0].to)) for p in found} == {("force", AtForce)}
    assert len({p.geometry.slope for p in problems(plan)}) == 32


def test_points_whose_numbers_do_not_go_together_are_left_out_and_counted(tmp_path, capsys):
    over = {
        "material.rubbery_modulus": {"log": ["0.1 MPa", "10 MPa"]},
        "material.glassy_modulus": {"log": ["1 MPa", "100 MPa"]},
    }
    plan = space_filling(CONE, over, cases=64)
    assert len(plan.cases) == 64 and 2 < plan.rejected < 20 and "modulus" in plan.refusal
    assert all(p.material.glassy_modulus >= p.material.rubbery_modulus for p in problems(plan))
    # but a grid is meant
    with pytest.raises(InputError, match="block 1 .*modulus"):
        every_combination(CONE, {path: ["1 MPa", "3 MPa"] for path in over})
    (tmp_path / "pad.toml").write_text(PAD_FILE)
    text = 'problem = "pad.toml"\n[[fill]]\ncases = 16\nmaterial.glassy_modulus = '
    (tmp_path / "plan.toml").write_text(text + '{ log = ["0.5 MPa", "50 MPa"] }\n')
    assert exit_status(["campaign", "plan", tmp_path / "plan.toml"]) == 0
    out = capsys.readouterr().out
    assert "points without a contact" in out and "first skipped point: " in out and "modulus" in out


@pytest.mark.parametrize(
    ("base", "over", "words"),
    [
        (CONE, {"geometry.slope": {"log": [-0.1, 1]}}, "geometry.slope must be positive, got -0.1"),
        (CONE, {"geometry.slope": {"linear": [0.9, 2]}}, "only 0 of the first .*too steep"),
        (CONE, {"geometry.height": {"log": [1, 2]}}, "no number 'geometry.height'.*there is slope"),
        (CONE, {"protocol.moves.7.speed": {"log": [1, 2]}}, "at '7' there is 0, 1, 2"),
        (CONE, {"protocol.moves.1": {"log": [1, 2]}}, "is not a number of the problem but"),
        (CONE, {"protocol.moves.2.hold": {"log": [1, 2]}}, "is not a number .* but 'force'"),
        (
            CONE,
            {"protocol.speed": {"log": ["1 um", "2 um"]}},
            "protocol.speed: '1 um' has the wrong dimension",
        ),
        (CONE, {"protocol.speed": {"log": ["1", "2"]}}, "protocol.speed: '1' has no unit"),
        (CONE, {"protocol.speed": ["1 um/s"]}, "at least one range|must be a number"),
        (TIP, {"geometry.exponent": {"linear": [1, 2]}}, "another shape with every exponent"),
        (TIP, {"geometry.height": {"log": [1e-6, 1e-5]}}, "add geometry.at_radius"),
        (
            TIP,
            {
                "geometry.height": 1e-6,
                "geometry.at_radius": 1e-4,
                "geometry.coefficient": {"log": [1, 2]},
            },
            "define the same; remove one",
        ),
        (
            PAD,
            {"body.base.poisson_ratio": {"linear": [0.1, 0.2]}},
            "must have the Poisson ratio of its",
        ),
        (PAD, {"material.poisson_ratio": {"linear": [0.1, 0.7]}}, "poisson_ratio must lie .*0.7"),
    ],
)
def test_a_fill_that_cannot_be_is_refused_with_its_place(base, over, words):
    with pytest.raises(InputError, match=words):
        space_filling(base, over, cases=8)


def test_dimensionless_tests_with_moves_are_filled_from_python():
    reduced = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    shape = PowerLawProfile(coefficient=0.5, exponent=2.0)
    base = Groups(
        tabor=1.0,
        material=reduced,
        start=AtDepth(5.0),
        rate=10.0,
        moves=(Dwell(3.0),),
        geometry=shape,
    )
    over = {
        "tabor": {"log": [0.1, 10]},
        "geometry.exponent": {"linear": [1, 4]},
        "moves.0.duration": {"log": [1, 1000]},
    }
    plan = space_filling(base, over, cases=16)
    found = problems(plan)
    assert shares([p.moves[0].duration for p in found], 1, 1000) == list(range(16))
    assert all(p.geometry.flank(1.0) == pytest.approx(1.0, abs=1e-12) for p in found)
    assert inputs_of(base)["moves.0.duration"].unit == "tau0"
    assert inputs_of(base)["material.glassy_modulus"].unit == "1"
    with pytest.raises(InputError, match="moves.0.duration must be a number, .*dimensionless"):
        space_filling(base, {"moves.0.duration": {"log": ["1 s", "2 s"]}}, cases=4)


def test_such_a_plan_is_run_stored_and_goes_on(tmp_path, monkeypatch):
    employ(monkeypatch, InlineCrew())
    over = {
        "geometry.exponent": {"linear": [1.0, 4.0]},
        "geometry.height": "10 um",
        "geometry.at_radius": "0.5 mm",
    }
    plan = space_filling(TIP, over, cases=8, settings=CaseSettings(accuracy=0.01))

    def exponent_of(problem, settings):
        return {"pull_off_force": problem.geometry.exponent}

    run(plan, tmp_path / "c", work=exponent_of)
    stored = Store(tmp_path / "c")
    assert stored.plan().cases == plan.cases and stored.settings.accuracy == 0.01
    assert problems(stored.plan()) == problems(plan)
    forces = stored.results().column("pull_off_force").to_pylist()
    assert forces == [p.geometry.exponent for p in problems(plan)]
    more = space_filling(TIP, over, cases=12, settings=plan.settings)
    assert run(more, tmp_path / "c", work=exponent_of).done == 12


def test_a_case_of_such_a_plan_is_solved(tmp_path, monkeypatch):
    employ(monkeypatch, InlineCrew())
    settings = CaseSettings(accuracy=0.02)
    over = {"body.thickness": {"log": ["20 um", "60 um"]}, "geometry.half_width": "1 mm"}
    plan = space_filling(PAD, over, cases=2, settings=settings)
    assert run(plan, tmp_path / "c").done == 2
    for row in Store(tmp_path / "c").results().to_pylist():
        assert row["pull_off_stress_Pa"] > 0 and 2e-5 <= row["body.thickness"] <= 6e-5
