"""The commands of the punch: flags and files in, numbers, words and pictures out."""

import numpy as np
import pytest

import stated
import viscotack as vt
from command_line import answered, refused

PUNCH = ["simulate", "punch"]
# The keys that the command line promises, with what they are in SI.
KEYS = {
    "pull_off_stress": "Pa",
    "work_of_separation": "J_per_m2",
    "ligament_at_pull_off": "m",
    "crack_speed_at_pull_off": "m_per_s",
    "effective_surface_energy": "J_per_m2",
}
PAD = [
    *("--half-width", "1 mm", "--contact-modulus", "1 MPa", "--work-of-adhesion", "50 mJ/m^2"),
    *("--strength", "50 kPa", "--modulus-ratio", "0.1", "--tau0", "1 ms"),
]


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "pad.toml"
    path.write_text(stated.PAD)
    return path


def test_a_test_with_a_history_and_another_law_is_stated_in_words(capsys):
    flags = "--size 20 --thickness 2 --cohesion 0.05 --modulus-ratio 0.1 --apart 15 --law dugdale"
    moves = ["--move", "approach 5 to depth 1", "--move", "dwell 2"]
    answer = answered([*PUNCH, *flags.split(), *moves, "--rate", "10", "--stiffness", "5"], capsys)
    problem = vt.from_dict(answer["problem"])
    assert problem.moves == (vt.Approach(speed=5.0, to=vt.AtDepth(1.0)), vt.Dwell(2.0))
    assert problem.start == vt.Apart(15.0) and problem.stiffness == 5.0
    # the strength, with the overshoot of a parabola at the corner of a flat maximum
    assert answer["pull_off_stress"] == pytest.approx(1.0, abs=0.01)
    assert answer["energy_residual"] < 2e-3


def test_a_case_in_si_comes_from_a_file(case_file, capsys, tmp_path):
    problem = vt.read_case(case_file)
    assert isinstance(problem, vt.Problem)
    assert problem.body.base == vt.Bonded(poisson_ratio=0.4)
    assert problem.protocol.start == vt.AtForce(2000.0)
    answer = answered([*PUNCH, case_file, "-o", tmp_path / "pad.npz"], capsys)
    for name, unit in KEYS.items():
        assert answer[f"{name}_{unit}"] > 0, name
    unit = problem.scales()
    assert answer["pull_off_stress_Pa"] == pytest.approx(answer["pull_off_stress"] * unit.stress)
    assert answer["crack_speed_at_pull_off_m_per_s"] == pytest.approx(
        answer["crack_speed_at_pull_off"] * 1.5e-6 / 0.1
    )
    result = vt.load(tmp_path / "pad.npz")
    assert result.problem == problem
    table = vt.columns(result)
    names = ("time", "depth", "stress", "ligament", "crack_speed")
    tails = ("_s", "_m", "_Pa", "_m", "_m_per_s")
    assert list(table) == [*names, *(n + t for n, t in zip(names, tails, strict=True))]
    np.testing.assert_allclose(table["stress"], -result.force)
    assert table["stress_Pa"].max() == pytest.approx(answer["pull_off_stress_Pa"], rel=2e-3)
    assert np.nanmax(table["ligament_m"]) == pytest.approx(1e-3, rel=1e-6)


def test_a_sphere_and_a_punch_are_not_taken_for_each_other(case_file, capsys):
    assert "contains a punch" in refused(["simulate", "sphere", case_file], capsys)
    assert "contains a punch" in refused(["advise", case_file], capsys)
    assert "leave out --size" in refused([*PUNCH, case_file, "--size", 3], capsys)


def test_theory_says_how_thick_a_pad_must_be(capsys):
    ask = ["theory", "punch", *PAD, "--speed", "100 um/s"]
    answer = answered([*ask, "--stress", "30 kPa"], capsys)
    assert answer["cohesive_below_m"] == pytest.approx(4e-5)
    assert answer["cohesive_when_fast_below_m"] == pytest.approx(4e-4)
    assert answer["half_plane_above_m"] == pytest.approx(4e-3 / np.pi)
    thickness = answer["thickness_m"]
    back = answered([*ask, "--thickness", f"{thickness!r} m"], capsys)
    assert back["pull_off_stress_Pa"] == pytest.approx(3e4, rel=1e-4)
    assert back["regime"] == "thin layer"
    assert back["slowest_pull_off_stress_Pa"] < 3e4 < back["fastest_pull_off_stress_Pa"]


def test_an_elastic_pad_has_an_answer_and_no_map(capsys, tmp_path):
    pad = ["theory", "punch", *PAD[:8], "--material", "elastic"]
    answer = answered([*pad, "--thickness", "200 um", "--speed", "1 mm/s"], capsys)
    assert answer["pull_off_stress_Pa"] == pytest.approx(answer["slowest_pull_off_stress_Pa"])
    assert answer["crack_speed_at_pull_off_m_per_s"] is None
    assert "no regime map" in refused([*pad, "--plot", tmp_path / "map.png"], capsys)
