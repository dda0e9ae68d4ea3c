"""python -m research.replication.learning: files, words, and the same numbers each time."""

import json
import sys
from contextlib import redirect_stdout
from io import StringIO

import numpy as np
import pytest

pytest.importorskip("sklearn", reason="comes with viscotack[replication]")
pytest.importorskip("xgboost", reason="comes with viscotack[replication]")

from research.replication.learning.__main__ import app  # noqa: E402
from research.replication.learning.study import study  # noqa: E402
from research.replication.learning.thesis import TABLES  # noqa: E402
from research.replication.learning.validation import Trial, scores  # noqa: E402
from research.replication.table import read_detachments  # noqa: E402

from .rows import made_rows, write_rows  # noqa: E402


def run(*arguments):
    with pytest.raises(SystemExit) as stop:
        app([*map(str, arguments)])
    return stop.value.code


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    data = write_rows(folder / "rows.csv", made_rows(60, points=True, noise=0.01))
    with redirect_stdout(StringIO()) as said:
        assert run("--table", data, "--out", folder / "out", "--quick", "--json") == 0
    (folder / "said.json").write_text(said.getvalue())
    return folder


@pytest.mark.slow
def test_every_part_is_in_the_files(done):
    out = done / "out"
    numbers = json.loads((out / "numbers.json").read_text())
    parts = "tables repeated bands noise grid forest rows architectures extrapolation insight"
    assert set(parts.split()) <= set(numbers)
    tables = {path.stem for path in (out / "tables").iterdir()}
    assert {"table_5_1", "table_5_2", "table_5_3", "table_5_4", "table_A_1"} <= tables
    assert {"reductions", "groups", "trajectories", "architectures_trajectories"} <= tables
    assert len(list((out / "figures").glob("*.png"))) == 10
    times = json.loads((out / "times.json").read_text())
    assert len(times) == len(numbers["tables"]["entries"]) == 30


@pytest.mark.slow
def test_json_is_one_object_with_what_was_found_and_written(done):
    found = json.loads((done / "said.json").read_text())
    assert "of 16 entries of Tables 5.1 to 5.4" in " ".join(found["said"])
    assert found["files"][-1].endswith("report.html")


@pytest.mark.slow
def test_the_thesis_stands_beside_each_entry_of_its_tables(done):
    entries = json.loads((done / "out/numbers.json").read_text())["tables"]["entries"]
    for table in TABLES:
        found = {e["model"]: e["thesis"] for e in entries if e["table"] == table.number}
        for model, entry in table.entries.items():
            assert found[model]["mse_1e-3"] == entry.mse
            assert found[model]["size"] == entry.size
        assert found["Network"] is None


@pytest.mark.slow
def test_r2_by_group_is_in_the_same_table(done):
    head = (done / "out/tables/table_5_2.csv").read_text().splitlines()[0]
    for words in ("a new input", '"R2, a new (mu, k, n)"', "a new mu", "a new n", "a new k"):
        assert words in head


@pytest.mark.slow
def test_the_page_stands_alone_and_says_that_it_was_quick(done):
    page = (done / "out/report.html").read_text()
    assert page.count("data:image/png;base64,") == 10
    assert "its numbers mean nothing" in page and "Table 5.1" in page
    assert "http" not in page and 'src="figures' not in page


@pytest.mark.slow
def test_the_same_table_and_seed_give_the_same_bytes(done):
    again = study(read_detachments(done / "rows.csv"), quick=True)
    text = json.dumps(again.numbers, indent=1, allow_nan=False) + "\n"
    assert text == (done / "out/numbers.json").read_text()


@pytest.mark.slow
def test_two_processes_give_the_same_scores_as_one():
    from research.replication.learning.features import Descriptor, Target
    from research.replication.learning.learners import LEARNERS
    from research.replication.learning.splits import random_split

    rows = made_rows()
    split = random_split(len(rows), 1)
    trials = [(Trial(Target.FORCE, Descriptor.PUBLISHED, m), split) for m in LEARNERS]
    one, two = (scores(rows, trials, seed=1, jobs=jobs, quick=True) for jobs in (1, 2))
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a.predicted, b.predicted)


def test_wrong_input_is_a_sentence(tmp_path, capsys):
    assert run("--table", tmp_path / "none.csv", "--out", tmp_path / "out") == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "there is no file" in said and "github.com/alimaghamii/ML4Adh" in said
    data = write_rows(tmp_path / "rows.csv", made_rows(10))
    assert run("--table", data, "--out", tmp_path / "out", "--quick") == 2
    assert "at least 50 rows, got 10" in " ".join(capsys.readouterr().err.split())


def test_a_missing_library_is_a_sentence_too(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "xgboost", None)
    data = write_rows(tmp_path / "rows.csv", made_rows(60))
    assert run("--table", data, "--out", tmp_path / "out", "--quick") == 2
    assert "pip install --editable '.[replication]'" in " ".join(capsys.readouterr().err.split())
