"""How long a simulation may take."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import viscotack as vt
from command_line import exit_status
from dimensionless import SOLID
from viscotack import clock

SPHERE = vt.Groups(tabor=1.0, material=SOLID, start=vt.AtDepth(1.0), rate=10.0)
EXAMPLES = Path(__file__).parents[1] / "examples"
WORDS = "simulate sphere --tabor 3 --modulus-ratio 0.1 --exponent 0.8 --preload 5".split()


class Clock:
    """A clock that is moved by hand."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def hand(monkeypatch):
    """Return the clock that time limits are read on."""
    made = Clock()
    monkeypatch.setattr(clock, "perf_counter", made)
    return made


def slow(monkeypatch, hand, seconds=0.01):
    """Let every balance of the surface take a while on the clock."""
    from viscotack.simulate import body

    quick = body.descend

    def late(*arguments, **options):
        hand.now += seconds
        return quick(*arguments, **options)

    monkeypatch.setattr(body, "descend", late)


def test_a_run_that_meets_its_time_limit_stops_and_keeps_what_there_is(monkeypatch, hand):
    slow(monkeypatch, hand, 0.03)
    result = vt.solve(SPHERE, time_limit=1.0, throw=False)
    # of more than a hundred steps
    assert 2 < len(result.time) < 60
    assert result.outcome is vt.Outcome.STOPPED
    assert result.status.startswith("stopped because the time limit of 1 s was met at a depth of ")
    assert "give more time" in result.status
    assert result.error_estimate is None
    with pytest.raises(vt.SimulationError, match="time limit of 1 s") as failure:
        vt.solve(SPHERE, time_limit=1.0)
    assert len(failure.value.result.time) > 2


LIMITED = {
    "predict": "sphere --tabor 3 --modulus-ratio 0.1 --exponent 0.8 --preload 5 --rate 10 --exact",
    "sweep": "lens.toml cases.csv --csv -",
}


@pytest.mark.parametrize("command", LIMITED)
def test_every_command_that_simulates_ends_in_time(command, monkeypatch, tmp_path, capsys, hand):
    shutil.copy(EXAMPLES / "from_toml/lens.toml", tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.csv").write_text("protocol.speed\n1e-4\n")
    slow(monkeypatch, hand, 1.0)
    status = exit_status([command, *LIMITED[command].split(), "--time-limit", "2 s"])
    said = "".join(capsys.readouterr())
    assert status in (2, 4) and "time limit of 2 s was met" in said


def test_the_command_line_stops_in_time_with_exit_status_one(monkeypatch, hand, capsys, tmp_path):
    slow(monkeypatch, hand)
    saved = tmp_path / "part.npz"
    flags = ["--rate", "10", "--time-limit", "0.01 min", "--json", "--save", str(saved)]
    assert exit_status([*WORDS, *flags]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert answer["status"].startswith("stopped because the time limit of 0.6 s was met")
    assert answer["pull_off_force"] is None
    assert len(vt.load(saved).time) > 2


def test_progress_counts_time_depth_and_edge_and_ends_with_the_companion():
    seen = []
    moves = (vt.Approach(10.0, vt.AtDepth(5.0)), vt.Dwell(10.0))
    vt.solve(replace(SPHERE, start=vt.Apart(8.0), moves=moves), progress=seen.append)
    assert all(later >= before - 1e-12 for before, later in zip(seen[:-1], seen[1:], strict=True))
    # of three legs, before a companion that is a fifth: the approach moves it all the way
    assert sum(0.02 < share < 0.8 / 3 - 0.02 for share in seen) > 10
    assert sum(0.8 / 3 + 0.02 < share < 1.6 / 3 - 0.02 for share in seen) > 3
    assert sum(0.8 < share < 1 for share in seen) > 10
