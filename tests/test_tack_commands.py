"""``viscotack test``: words, JSON, a table and a picture; a bad file does not hide the others."""

import csv
import json

import pytest

import tack_files
from command_line import exit_status
from viscotack.theory import jkr

PULL_OFF = -jkr.pull_off(**tack_files.SPHERE).force


@pytest.fixture
def probe(tmp_path):
    """Return the paths of the intervals of one test."""
    paths = [tmp_path / f"probe_Interval_{number}.csv" for number in (1, 2, 3)]
    for path, content in zip(paths, tack_files.anton_paar(tack_files.made(5e-5)), strict=True):
        path.write_bytes(content)
    return paths


def test_a_test_is_read_and_written_in_every_form(probe, tmp_path, capsys):
    table, picture = tmp_path / "cycles.csv", tmp_path / "cycles.png"
    arguments = ["test", "read", *probe, "--csv", table, "--plot", picture, "--json"]
    assert exit_status(arguments) == 0
    answer = json.loads(capsys.readouterr().out)
    (cycle,) = answer["tests"][0]["cycles"]
    assert cycle["pull_off_force_N"] == pytest.approx(PULL_OFF, rel=0.02)
    assert cycle["speed_m_s"] == pytest.approx(tack_files.SPEED, rel=1e-3)
    assert "3 intervals joined" in cycle["notes"]
    (row,) = csv.DictReader(table.read_text().splitlines())
    assert float(row["pull_off_force_N"]) == cycle["pull_off_force_N"]
    assert picture.stat().st_size > 10_000
    assert exit_status(["test", "read", *probe]) == 0
    assert f"{cycle['pull_off_force_N'] * 1e3:.4g}" in capsys.readouterr().out


def test_compliance_and_signs_are_said_by_flags(probe, capsys):
    plain = ["test", "read", *probe, "--json"]
    depths = []
    for more in ([], ["--compliance", "200 um/N"]):
        assert exit_status([*plain, *more]) == 0
        answer = json.loads(capsys.readouterr().out)
        depths.append(answer["tests"][0]["cycles"][0]["depth_at_pull_off_m"])
    assert depths[1] - depths[0] == pytest.approx(200e-6 * PULL_OFF, rel=0.1)
    assert exit_status([*plain, "--into", "up"]) == 2
    assert "--into must be + or -" in capsys.readouterr().err
    assert exit_status([*plain, "--compression", "-"]) == 2
    assert "--compression" in capsys.readouterr().err
