"""The steady crack at the command line: JSON, SI, words, wrong input."""

import json

import pytest

from command_line import exit_status
from viscotack.materials import RetardationPowerLaw
from viscotack.theory import SteadyCrack
from viscotack.traction import Exponential

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


def test_words_and_picture_of_the_range_that_matters(capsys, tmp_path):
    picture = tmp_path / "crack.png"
    assert exit_status(["theory", "steady-crack", "--modulus-ratio", 0.3, "--plot", picture]) == 0
    assert picture.stat().st_size > 1000
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[:2] == ["speed", "amplification"]
    assert len(lines) == 42


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["--modulus-ratio", 0.1, "--speed", "1 um/s"], "has a unit; it needs --contact-modulus"),
        (["--modulus-ratio", 0.1, *SI[:4]], "--equilibrium-gap and --tau0 missing"),
        (["--material", "elastic"], "amplification of 1"),
        (["--speed", 1], "--modulus-ratio missing"),
    ],
)
def test_wrong_input_is_refused_in_words(flags, words, capsys):
    assert exit_status(["theory", "steady-crack", *flags]) == 2
    assert words in capsys.readouterr().err
