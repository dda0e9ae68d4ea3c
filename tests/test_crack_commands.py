"""The steady crack at the command line: JSON, SI, words, wrong input."""

import json

import pytest

from command_line import exit_status

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
