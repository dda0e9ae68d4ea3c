"""The published table beside the simulation: what is decided, what is written."""

import re
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("pyarrow", reason="comes with viscotack[campaign]")

from research.replication import __main__ as replicated  # noqa: E402
from research.replication.published.__main__ import app, drawn  # noqa: E402
from research.replication.published.compare import APART, INPUTS, compare, inputs_of  # noqa: E402
from research.replication.published.corrected import COLUMNS, corrected  # noqa: E402
from research.replication.published.page import changed, page  # noqa: E402
from research.replication.table import Detachments  # noqa: E402
from viscotack import (  # noqa: E402
    AtDepth,
    Groups,
    RetardationPowerLaw,
    predict_table,
    pull_off_force,
    solve,
)
from viscotack.campaign import CaseSettings  # noqa: E402

from .rows import write_rows  # noqa: E402

OFF = 1.1
# Tabor number, modulus ratio, exponent, preload, rate.
TWICE = (1.0, 0.1, 0.8, 5.0, 10.0)
IN_TENSION = (0.5, 0.1, 0.6, 0.05, 50.0)
CASES = [TWICE, TWICE, (0.3, 0.3, 1.2, 2.0, 100.0), IN_TENSION]


def solved(tabor, modulus_ratio, exponent, preload, rate):
    material = RetardationPowerLaw(
        rubbery_modulus=1.0,
        glassy_modulus=1 / modulus_ratio,
        exponent=exponent,
        tau0=1.0,
        poisson_ratio=0.0,
    )
    groups = Groups(tabor=tabor, material=material, start=AtDepth(preload), rate=rate)
    return solve(groups, accuracy=CaseSettings.accuracy, until="pull-off")


@pytest.fixture(scope="module")
def table():
    """Return rows of the simulation itself, the second of them off by a tenth; no work in one."""
    columns = np.array(CASES).T
    force = np.array([pull_off_force(solved(*case)) for case in CASES])
    force[1] *= OFF
    return Detachments(
        *columns,
        pull_off_force=force,
        work_to_pull_off=np.ones(len(CASES)),
        work_known=np.array([True, True, False, True]),
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("published")


@pytest.fixture(scope="module")
def rows(table, folder):
    return compare(table, folder / "runs", workers=1)


@pytest.mark.slow
def test_what_the_simulation_says_itself_is_not_off(rows, table):
    assert [inputs_of(row) for row in rows] == CASES
    off = [row["force_difference"] for row in rows]
    assert off == pytest.approx([0, OFF - 1, 0, 0], abs=1e-12)
    assert [row["force"] for row in rows] == table.pull_off_force.tolist()


@pytest.mark.slow
def test_only_what_is_apart_is_decided_by_a_converged_run(rows, folder):
    decided = [row for row in rows if "table_error" in row]
    assert [row is rows[1] for row in decided] == [True]
    assert rows[1]["table_error"] == pytest.approx(OFF - 1, abs=2e-3)
    assert abs(rows[1]["our_error"]) < CaseSettings.accuracy < APART
    # a repeated case is simulated once
    for name, count in (("default", 3), ("converged", 1)):
        assert len((folder / "runs" / name / "cases.csv").read_text().splitlines()) == 1 + count


@pytest.mark.slow
def test_work_that_is_not_known_is_not_compared(rows):
    known = [np.isfinite(row["work_difference"]) for row in rows]
    assert known == [True, True, False, True]
    for row in (rows[0], rows[3]):
        ours = row["ours"]["work_to_pull_off"]
        assert row["work_difference"] == pytest.approx(1 / ours - 1, rel=1e-12)
    assert [row["in_tension"] for row in rows] == [False, False, False, True]


@pytest.mark.slow
def test_the_page_names_the_row_that_is_off(rows):
    text = page(rows)
    assert "1 rows are off by more than 2 %, 25.00 % of the table" in text
    (line,) = [line for line in text.splitlines() if line.startswith("| 1 | 0.1 | 0.8 | 5 | 10 |")]
    assert re.search(r"\+(9\.9|10\.0|10\.1) %", line)
    assert "1 inputs are stated more than once, 2 rows" in text
    assert "1 rows hold 0.01" in " ".join(text.split())
    assert changed(rows, text) == []
    assert changed(rows, text.replace("25.00 %", "24.00 %")) != []


@pytest.mark.slow
def test_a_replication_from_nothing_names_the_lines_that_differ(
    rows, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(replicated, "file_of", lambda archive, name: archive / name)
    monkeypatch.setattr(replicated, "read_detachments", lambda path: path)
    monkeypatch.setattr(
        "research.replication.published.compare.compare", lambda *given, workers: rows
    )
    replicated._published(tmp_path, tmp_path, 1)
    said = capsys.readouterr().out
    assert "the published table: 4 rows" in said and "lines of its page differ" in said
    assert "  1 rows are off by more than 2 %" in said


@pytest.mark.slow
def test_the_command_writes_the_page_and_its_pictures(table, folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    source = write_rows(tmp_path / "rows.csv", table)
    arguments = ["--table", source, "--out", folder / "runs", "--workers", 1]
    with pytest.raises(SystemExit) as stop:
        app([*map(str, arguments), "--write", "page"])
    assert stop.value.code == 0
    written = {path.name for path in (tmp_path / "page").iterdir()}
    assert written == {"README.md", "differences.png", "regions.png"}
    assert "4 rows of the table of detachments" in (tmp_path / "page/README.md").read_text()


def test_a_table_that_is_not_there_is_a_sentence(tmp_path, capsys):
    with pytest.raises(SystemExit) as stop:
        app(["--table", str(tmp_path / "none.csv")])
    assert stop.value.code == 2
    assert "there is no file" in capsys.readouterr().err


def test_no_page_is_written_of_the_sample(tmp_path, capsys):
    with pytest.raises(SystemExit) as stop:
        app(["--write", str(tmp_path / "page")])
    assert stop.value.code == 2
    assert "give its path by --table" in capsys.readouterr().err
    assert not (tmp_path / "page").exists()


def test_rows_are_drawn_once_each_and_the_same_again(table):
    some = drawn(replace(table, rate=np.arange(1.0, 5.0)), 3, 7)
    assert len(set(some.rate.tolist())) == 3
    again = drawn(replace(table, rate=np.arange(1.0, 5.0)), 3, 7)
    assert again.rate.tolist() == some.rate.tolist()
    assert drawn(table, None, 7) is table


def test_the_answer_at_once_tells_the_published_rows(published):
    some = published.chosen(slice(None, None, 10))
    said = predict_table({name: getattr(some, name) for name in INPUTS})
    told = said["method"] == "surrogate"
    assert told.mean() > 0.95
    off = said["pull_off_force"][told] / some.pull_off_force[told] - 1
    assert np.median(np.abs(off)) < 5e-3


@pytest.mark.slow
def test_the_corrected_table_has_ours_beside_theirs(rows, table):
    """Rows that are apart have their converged run; others are there if they are in the sample."""
    found = corrected(rows, table, accuracy=2e-3)
    lines = [dict(zip(COLUMNS, line, strict=True)) for line in found]
    assert len(lines) == len(CASES)
    apart = [line for line in lines if line["accuracy"] == "0.0001"]
    assert len(apart) == 1
    assert float(apart[0]["force_difference"]) == pytest.approx(OFF - 1, abs=3e-3)
    assert 0 < float(apart[0]["force_error"]) < 1e-3
    assert lines[2]["published_work"] == "" and lines[2]["work_difference"] == ""
    none = table.chosen(np.zeros(len(table), dtype=bool))
    assert len(corrected(rows, none, accuracy=2e-3)) == 1
