"""The history of what the package costs, `benchmarks/history.jsonl`."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))

import history  # noqa: E402

LINE = {
    "date": "2026-11-24",
    "commit": "abc",
    "processor": "one",
    "times": {"sphere": 0.15},
    "instructions": {"sphere": 0.70},
}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"times": {"sphere": 0.18}}, []),
        ({"times": {"sphere": 0.19}}, ["times, sphere: 0.15 -> 0.19 (+27 %)"]),
        ({"times": {"punch": 9.0}}, []),
        ({"instructions": {"sphere": 0.73}}, []),
        ({"instructions": {"sphere": 0.77}}, ["instructions, sphere: 0.7 -> 0.77 (+10 %)"]),
        ({"instructions": {"sphere": 0.77}, "processor": "another"}, []),
    ],
    ids=str,
)
def test_what_has_risen_by_more_than_its_share_is_named(change, words):
    assert history.slipped(LINE, LINE | change) == words


def test_every_line_has_all_quantities():
    lines = history.read()
    assert lines
    for line in lines:
        assert set(line) == set(LINE) and line["times"].keys() >= {"sphere over the plain twin"}
        assert all(value > 0 for kind in history.SHARES for value in line[kind].values())


def test_a_figure_is_drawn(tmp_path, monkeypatch):
    monkeypatch.setattr(history, "FIGURE", tmp_path / "history.png")
    history.draw([LINE, LINE | {"commit": "abd"}])
    assert (tmp_path / "history.png").stat().st_size > 2000
