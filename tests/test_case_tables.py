"""Tables whose rows change one problem: every row is answered as its own problem would be."""

import csv
from pathlib import Path

import pytest

import viscotack as vt
from command_line import exit_status, rows_of
from viscotack.app.operations import ask

EXAMPLES = Path(__file__).parents[1] / "examples" / "from_toml"
LENS, PAD = (EXAMPLES / "lens.toml").read_text(), EXAMPLES / "pad.toml"
HEADINGS = ["lens", "Radius [mm]", "speed", "note"]
ROWS = [
    ["a", "5", "10 um/s", "x, y"],
    ["", "", "", ""],
    ["b", "5", "100 m/s", ""],
    ["c", "5", "10", ""],
    ["d", "-5", "10 um/s", ""],
    ["e", "5", "10 um/s", "again"],
]
NUMBERS = ["pull_off_force [N]", "pull_off_force_low [N]", "pull_off_force_high [N]"]


@pytest.fixture
def case(tmp_path):
    (tmp_path / "lens.toml").write_text(LENS)
    with (tmp_path / "cases.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows([HEADINGS, *ROWS])
    return tmp_path / "lens.toml"


def test_each_row_has_the_answer_of_its_own_problem(case, tmp_path, capsys):
    answers = tmp_path / "answers.csv"
    assert exit_status(["predict", case, tmp_path / "cases.csv", "--csv", answers]) == 0
    said = capsys.readouterr()
    rows = rows_of(answers)
    assert [[row[name] for name in HEADINGS] for row in rows] == ROWS
    one = LENS.replace("5.19 mm", "5 mm").replace("100 um/s", "10 um/s")
    (tmp_path / "one.toml").write_text(one)
    alone = vt.prediction_summary(vt.predict(vt.read_case(tmp_path / "one.toml")))
    expected = [alone["pull_off_force_N"], *alone["interval_N"]]
    assert [float(rows[0][name]) for name in NUMBERS] == pytest.approx(expected, rel=1e-12, abs=0)
    told = ask("predict", problem=tmp_path / "one.toml").record()
    assert rows[0]["cautions"] == " ".join(told["cautions"])
    assert float(rows[0]["work_to_pull_off [J]"]) == pytest.approx(alone["work_to_pull_off_J"])
    assert rows[5] == {**rows[0], "lens": "e", "note": "again"}
    why = [row["why"] for row in rows]
    assert why[0] == "" and why[1] == "empty row"
    assert why[2].startswith("speed of 100 m/s is improbable; check its unit")
    assert "'10' has no unit; write it in the heading, 'speed [um/s]'" in why[3]
    assert "radius must be positive, got -5 mm" in why[4]
    assert [bool(row[NUMBERS[0]]) for row in rows] == [True, False, True, False, False, True]
    assert "carried along: lens, note" in said.err
    assert "unanswered  2" in said.out
    assert "e, sphere.radius 5 mm, protocol.speed 10 um/s   3.9249 mN" in said.out
