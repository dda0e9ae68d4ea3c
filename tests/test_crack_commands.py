"""The steady crack at the command line: JSON, SI, words, wrong input."""

import json

import pytest

from command_line import exit_status
from viscotack.model.materials import RetardationPowerLaw
from viscotack.model.traction import Exponential
from viscotack.theory import SteadyCrack

SI = [
    *("--contact-modulus", "2 MPa", "--work-of-adhesion", "50 mJ/m^2"),
    *("--equilibrium-gap", "1 nm", "--tau0", "1 ms"),
]


def asked(arguments, capsys):
    assert exit_status(["theory", "steady-crack", *arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_crack_opens_and_closes_in_json(capsys):
    answer = asked(["--modulus-ratio", 0.1, "--speed", 10, "--speed", -10], capsys)
    assert answer["speed"] == [10, -10]
    assert answer["amplification"] == pytest.approx([3.96, 0.3354], rel=1e-3)
    assert answer["zone_length"] == pytest.approx([3.76, 4.80], rel=1e-2)
    assert answer["persson_brener_off"][1] is None
    assert answer["persson_brener_off"][0] == pytest.approx(0.064, abs=1e-3)
    assert max(answer["error_estimate"]) < 1e-3


def test_another_solid_and_law(capsys):
    flags = ["--modulus-ratio", 0.1, "--exponent", 0.8, "--law", "exponential:0.25", "--speed", 1]
    solid = RetardationPowerLaw(
        rubbery_modulus=1, glassy_modulus=10, exponent=0.8, tau0=1, poisson_ratio=0
    )
    crack = SteadyCrack(solid, Exponential(1, 1, 0.25))
    assert asked(flags, capsys)["amplification"] == [crack.amplification(1.0)]


def test_a_speed_in_si_is_one_over_its_unit(capsys):
    answer = asked(["--modulus-ratio", 0.1, "--speed", "1 um/s", *SI], capsys)
    # 2e6 Pa (1 nm)^2/(50 mJ/m^2) is 4e-11 m, in 1 ms
    assert answer["speed"] == pytest.approx([25.0])
    assert answer["speed_m_per_s"] == pytest.approx([1e-6])
    assert answer["zone_length_m"][0] == pytest.approx(answer["zone_length"][0] * 4e-11)


def test_a_contact_with_a_crack_for_its_edge_in_json_csv_and_a_picture(capsys, tmp_path):
    curve, picture = tmp_path / "curve.csv", tmp_path / "curve.png"
    problem = ["--tabor", 1e4, "--material", "sls", "--modulus-ratio", 0.1]
    problem += ["--preload", 2e5, "--rate", 1e3]
    files = ["--curve", curve, "--plot", picture]
    assert exit_status(["theory", "crack-contact", *problem, *files, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert 1 < answer["pull_off_force"] < 10
    low, high = answer["interval"]
    assert low < answer["pull_off_force"] < high
    assert answer["method"] == "crack contact"
    header, *rows = curve.read_text().splitlines()
    assert header.split(",") == [
        *("time", "depth", "force", "contact_radius"),
        *("edge_speed", "amplification", "move"),
    ]
    force = [float(row.split(",")[2]) for row in rows]
    assert -min(force) == pytest.approx(answer["pull_off_force"], rel=1e-3)
    assert picture.stat().st_size > 1000


def test_a_contact_in_si_units_is_printed_in_si_units_and_as_text(capsys):
    # dg with mu = 500: (mu^3 E*^2 h0^3/R)^(1/2)
    work = (500**3 * 4e12 * 1e-27 / 1e-3) ** 0.5
    scales = ["--radius", "1 mm", "--contact-modulus", "2 MPa", "--equilibrium-gap", "1 nm"]
    scales += ["--tau0", "1 ms", "--work-of-adhesion", f"{work!r} J/m^2", "--preload", "10 um"]
    problem = ["--material", "sls", "--modulus-ratio", 0.1, "--speed", "100 um/s"]
    command = ["theory", "crack-contact", *problem, *scales]
    assert exit_status(command) == 0
    words = capsys.readouterr().out
    assert exit_status([*command, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert f"{answer['pull_off_force_N'] * 1e3:.5g} mN" in words
    unit = 1.5 * 3.141592653589793 * 1e-3 * work
    assert answer["pull_off_force_N"] == pytest.approx(answer["pull_off_force"] * unit, rel=1e-6)


def test_a_contact_that_the_theory_does_not_hold_for_is_refused(capsys):
    problem = ["--tabor", 0.5, "--material", "sls", "--modulus-ratio", 0.1]
    assert exit_status(["theory", "crack-contact", *problem, "--preload", 20, "--rate", 1]) == 2
    assert "cohesive zone is too large" in capsys.readouterr().err
