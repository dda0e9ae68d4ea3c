import pytest

from campaign_work import Inline
from command_line import answered, exit_status, refused, rows_of
from viscotack.campaign.store import locked

ROWS = [("0.3", "0.1", "0.8", "2.0", "100.0"), ("1.0", "0.1", "0.6", "3.0", "1000.0")]
INPUTS = ("tabor", "modulus_ratio", "exponent", "preload", "rate")


@pytest.fixture
def inline(monkeypatch):
    """Let cases run in this process."""
    monkeypatch.setattr("viscotack.campaign.running._processes", lambda *_: Inline())


@pytest.fixture
def cases(tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text("\n".join(map(",".join, (INPUTS, *ROWS))) + "\n")
    return path


def test_a_bare_csv_file_is_run_and_gives_its_columns_back(cases, inline, tmp_path, capsys):
    folder, table = tmp_path / "study", tmp_path / "table.csv"
    quick = ["--accuracy", 0.02, "--until", "pull-off"]
    answer = answered(["campaign", "run", cases, "--out", folder, *quick], capsys)
    assert (answer["cases"], answer["done"], answer["failed"], answer["left"]) == (2, 2, 0, 0)
    assert exit_status(["campaign", "export", folder, "--csv", table]) == 0
    found = rows_of(table)
    assert [tuple(row[name] for name in INPUTS) for row in found] == ROWS
    for row in found:
        assert float(row["pull_off_force"]) > 1 and float(row["work_to_pull_off"]) > 0
        assert 0 < float(row["error_estimate"]) < 0.1
        assert row["status"].startswith("still in contact just past the pull-off")
    assert exit_status(["campaign", "status", folder]) == 0
    assert "2 of 2 cases done, 0 failed, 0 left" in capsys.readouterr().out


def test_a_folder_in_use_is_refused(cases, tmp_path, capsys):
    with locked(tmp_path):
        message = refused(["campaign", "run", cases, "--out", tmp_path], capsys)
    assert "in use" in message and str(tmp_path) in message
