"""One problem with some of its numbers replaced: every door gives the same rows."""

import csv
import json

import pytest

from command_line import exit_status, rows_of
from stated import case_text
from viscotack import AtDepth, Groups, InputError, StandardSolid
from viscotack.app.operations import ask
from viscotack.model.problem.case_file import read_case

ROWS = [
    {"sphere.radius": 1e-3, "protocol.speed": 1e-5},
    {"sphere.radius": 2e-3, "protocol.speed": 1e-5},
    {"sphere.radius": 1e-3, "protocol.speed": -1.0},
]
REDUCED = Groups(
    tabor=1.0,
    material=StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0),
    start=AtDepth(5.0),
    rate=10.0,
)


@pytest.fixture
def case(tmp_path):
    (tmp_path / "lens.toml").write_text(case_text())
    with (tmp_path / "cases.csv").open("w", newline="") as stream:
        table = csv.DictWriter(stream, list(ROWS[0]))
        table.writeheader()
        table.writerows(ROWS)
    return tmp_path / "lens.toml"


@pytest.fixture
def quick(monkeypatch):
    """Solve no problem: its numbers stand for the answer."""

    def numbers(problem, settings):
        return {"rate": problem.groups().rate, "curve": [1.0], "accuracy": settings.accuracy}

    monkeypatch.setattr("viscotack.campaign.measure", numbers)


def timeless(record):
    """Return rows without the time that they took."""
    for row in record["rows"]:
        row.pop("wall_time_s")
        (row["outputs"] or {}).pop("wall_time_s", None)
    return record


def test_the_command_and_python_give_the_same_rows(case, tmp_path, capsys):
    command = ["sweep", case, tmp_path / "cases.csv", "--accuracy", 0.02]
    assert exit_status([*command, "--json", "--csv", tmp_path / "rows.csv"]) == 4
    told = timeless(json.loads(capsys.readouterr().out))
    asked = ask("sweep", problem=read_case(case), cases=ROWS, accuracy=0.02)
    assert told == timeless(json.loads(json.dumps(asked.record())))
    first, second, bad = told["rows"]
    assert [row["inputs"] for row in told["rows"]] == ROWS and told["failed"] == 1
    # the pull-off force grows with the radius as in the elastic theories
    forces = [row["outputs"]["pull_off_force_N"] for row in (first, second)]
    assert forces[1] == pytest.approx(2 * forces[0], rel=0.05)
    assert bad["outputs"] is None and "speed" in bad["reason"]
    written = rows_of(tmp_path / "rows.csv")
    assert [float(row["sphere.radius"]) for row in written] == [1e-3, 2e-3, 1e-3]
    assert [row["pull_off_force_N"] for row in written] == [*map(str, forces), ""]


@pytest.mark.parametrize(
    ("cases", "words"),
    [
        ([{"rate": 1.0}, {"tabor": 1.0}], "the same numbers"),
        ([{"rate": 1.0, "material.speed": 1.0}], "material.speed"),
    ],
)
def test_cases_that_say_nothing_are_refused(cases, words):
    with pytest.raises(InputError, match=words):
        ask("sweep", problem=REDUCED, cases=cases)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("protocol.speed\n1e-5\nfast\n", "case 2: protocol.speed"),
        ("speed;radius\n1.000;1,5\n", "decimal"),
        ("radius\n5.19\n", "unit"),
        ("radius,sphere.radius\n5 mm,5 mm\n", "sphere.radius"),
        ("radius [N]\n5\n", "radius"),
    ],
)
def test_tables_that_would_be_misread_are_refused(case, tmp_path, text, words):
    (tmp_path / "wrong.csv").write_text(text)
    with pytest.raises(InputError, match=words):
        ask("sweep", problem=case, cases=tmp_path / "wrong.csv")


def test_a_workbook_has_units_in_headings_or_cells_names_and_empty_rows(case, quick, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (
        ["Lens", "Radius [mm]", "speed_um_per_s", "Preload depth"],
        ["a", 1, 10, "1 um"],
        [None] * 4,
        ["b", 2000, 20, "500 nm"],
        [None] * 4,
    ):
        book.active.append(row)
    book.save(tmp_path / "cases.xlsx")
    plain = tmp_path / "cases.csv"
    plain.write_text(
        "Lens;Radius [mm];speed_um_per_s;Preload depth\na;1,0;10;1 um\n;;;\nb;2000;20;500 nm\n"
    )
    given = ["sphere.radius", "protocol.speed", "protocol.preload_depth"]
    expected = [dict(zip(given, (1e-3, 1e-5, 1e-6), strict=True)), None]
    expected += [dict(zip(given, (2.0, 2e-5, 5e-7), strict=True))]
    for table in (plain, tmp_path / "cases.xlsx"):
        answer = ask("sweep", problem=case, cases=table)
        rows = answer.record()["rows"]
        assert [row["inputs"] for row in rows] == expected
        assert (rows[1]["reason"], answer.status) == ("empty row", 0)
        assert any("case 3: Radius [mm] of 2 m" in note for note in answer.notes)
        answer.write("csv", tmp_path / "rows.csv")
        written = rows_of(tmp_path / "rows.csv")
        assert [row["Lens"] for row in written] == ["a", "", "b"]
        assert [float(row["Radius [mm]"] or 0) for row in written] == [1, 0, 2000]
