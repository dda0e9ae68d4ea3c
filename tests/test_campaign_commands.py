import csv
import json
import os
import subprocess
import sys

import pytest

from campaign_work import InlineCrew, employ, picky, plan_of
from command_line import exit_status
from viscotack.campaign import CaseSettings, Store, run
from viscotack.campaign.running import Progress
from viscotack.errors import install_command
from viscotack.files.lock import locked
from viscotack.operations import operation
from viscotack.operations.campaign import _progress_words
from viscotack.operations.declare.options import Here, take
from viscotack.operations.declare.study import read_study, study_text

ROWS = [("0.3", "0.1", "0.8", "2.0", "100.0"), ("1.0", "0.1", "0.6", "3.0", "1000.0")]
INPUTS = ("tabor", "modulus_ratio", "exponent", "preload", "rate")


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


@pytest.fixture
def cases(tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text("\n".join(map(",".join, (INPUTS, *ROWS))) + "\n")
    return path


def call(*arguments):
    """Return the exit status of a command."""
    return exit_status(["campaign", *arguments])


def wrong(capsys, *arguments):
    """Return the message of a refused command: one paragraph, nothing on standard output."""
    assert call(*arguments) == 2
    out, err = capsys.readouterr()
    assert out == "" and "Traceback" not in err
    return err


def test_a_bare_csv_file_is_run_and_gives_its_columns_back(cases, crew, tmp_path, capsys):
    folder, table = tmp_path / "study", tmp_path / "table.csv"
    quick = ["--accuracy", 0.02, "--until", "pull-off"]
    assert call("run", cases, "--out", folder, *quick, "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert (answer["cases"], answer["done"], answer["failed"], answer["left"]) == (2, 2, 0, 0)
    assert call("export", folder, "--csv", table) == 0
    with table.open(newline="") as file:
        found = list(csv.DictReader(file))
    assert [tuple(row[name] for name in INPUTS) for row in found] == ROWS
    for row in found:
        assert float(row["pull_off_force"]) > 1 and float(row["work_to_pull_off"]) > 0
        assert 0 < float(row["error_estimate"]) < 0.1
        assert row["status"].startswith("still in contact just past the pull-off")
    assert call("status", folder) == 0
    assert "2 of 2 cases done, 0 failed, 0 left" in capsys.readouterr().out


def test_a_plan_is_described_before_it_is_run(cases, tmp_path, capsys):
    plan = tmp_path / "plan.toml"
    plan.write_text('[settings]\nuntil = "pull-off"\n[[list]]\nfile = "cases.csv"\n')
    assert call("plan", plan) == 0
    out = capsys.readouterr().out
    assert "2 cases of kind sphere" in out and "rate" in out and "to pull-off" in out
    assert call("plan", plan, "--json", "--csv", tmp_path / "again.csv") == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["cases"] == 2 and answer["ranges"]["rate"] == [100.0, 1000.0]
    assert (tmp_path / "again.csv").read_text() == cases.read_text()


def test_failures_are_counted_by_reason(tmp_path, crew, capsys):
    run(plan_of(tmp_path, cases=10), tmp_path / "study", work=picky)
    assert call("status", tmp_path / "study", "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["failed"] == 2 and len(answer["failures"]) == 2
    assert answer["failures"][0]["failure"] == "refused"
    assert call("status", tmp_path / "study") == 0
    assert "1 refused: no contact at a rate of 5" in capsys.readouterr().out
    assert call("export", tmp_path / "study", "--failures", tmp_path / "why.csv") == 0
    assert "no contact at a rate of 10" in (tmp_path / "why.csv").read_text()


def test_a_folder_says_how_to_go_on(tmp_path, crew, capsys):
    folder = tmp_path / "study"
    folder.mkdir()
    Store.create(folder, plan_of(tmp_path, cases=3))
    assert call("status", folder) == 0
    assert f"campaign run --out {folder}" in capsys.readouterr().out


def test_a_run_that_was_stopped_has_another_exit_status(cases, tmp_path, monkeypatch, capsys):
    stopped = Progress(5, 2, 0, rate=1.0, elapsed_s=2.0, stopped=True)
    monkeypatch.setattr("viscotack.campaign.run", lambda *_, **__: stopped)
    assert call("run", cases, "--out", tmp_path / "study") == 1
    assert "2 of 5 cases done, 0 failed, 3 left" in capsys.readouterr().out

    def killed(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("viscotack.campaign.run", killed)
    assert call("run", cases, "--out", tmp_path / "study") == 1
    out, err = capsys.readouterr()
    assert out == "" and "interrupted; the stored rows in" in err and "are safe" in err
    assert call("run", cases, "--out", tmp_path / "study", "--json") == 1
    assert json.loads(capsys.readouterr().out) == {"stopped": True, "reason": "interrupted"}


def test_cases_without_a_result_have_an_exit_status(tmp_path, crew, capsys):
    rows = [",".join(INPUTS), ",".join(ROWS[0]), ",".join(ROWS[0]).replace("2.0", "-90")]
    (tmp_path / "cases.csv").write_text("\n".join(rows) + "\n")
    words = ["run", tmp_path / "cases.csv", "--out", tmp_path / "study", "--accuracy", 0.02]
    assert call(*words) == 4
    assert "1 of 2 cases done, 1 failed, 0 left" in capsys.readouterr().out


def test_progress_in_words():
    now = Progress(100, 40, 1, rate=2.04, remaining_s=61.2, elapsed_s=20)
    assert _progress_words(now) == (
        "40 of 100 stored, 1 failed, 2.0 cases/s, about 1 min 01 s left"
    )


def test_progress_is_told_now_and_then_and_at_once_when_a_run_is_to_stop(
    cases, tmp_path, monkeypatch, capsys
):
    def some(*_, report, **__):
        for done in range(3):
            report(Progress(4, done, 0, rate=1.0))
        report(Progress(4, 3, 0, rate=1.0, stopped=True))
        return Progress(4, 3, 0, elapsed_s=1.0, stopped=True)

    monkeypatch.setattr("viscotack.campaign.run", some)
    assert call("run", cases, "--out", tmp_path / "study") == 1
    stop = "3 of 4 stored, 0 failed, 1.0 cases/s; finishing the running cases"
    assert capsys.readouterr().err.splitlines() == [stop]
    monkeypatch.setattr("viscotack.app.cli.reading.LINES", -1.0)
    assert call("run", cases, "--out", tmp_path / "study") == 1
    assert len(capsys.readouterr().err.splitlines()) == 4


def test_settings_of_the_command_take_the_place_of_those_of_the_plan(cases, tmp_path, monkeypatch):
    plans = []

    def keep(plan, *_, **__):
        plans.append(plan)
        return Progress(2, 2, 0)

    monkeypatch.setattr("viscotack.campaign.run", keep)
    settings = ["--accuracy", 0.01, "--until", "detached", "--time-limit", "2 min"]
    more = ["--memory-limit", "300 MB", "--shard", "1/2"]
    assert call("run", cases, "--out", tmp_path / "study", *settings, *more) == 0
    (plan,) = plans
    assert plan.settings == CaseSettings(0.01, "detached", 120.0, 300e6)
    assert len(plan.cases) == 1 and plan.shard == "1/2"


STUDIES = {
    "campaign plan": {"plan": "cases.csv", "temperature": "20 degC"},
    "campaign run": {
        "plan": "cases.csv",
        "out": "study",
        "workers": "2",
        "scheduler": "tls://host:1",
        "tls_ca": "ca.pem",
        "shard": "1/2",
        "accuracy": "0.01",
        "until": "detached",
        "time_limit": "1 min",
        "memory_limit": "100 MB",
        "temperature": "20 degC",
        "retry": True,
    },
    "campaign status": {"folder": "study"},
    "campaign verify": {"folder": "study"},
    "campaign merge": {"folders": ["one", "two"], "out": "all"},
    "campaign export": {"folder": "study", "trajectories": True},
}


@pytest.mark.parametrize("word", STUDIES)
def test_a_study_states_what_a_command_does_and_no_request_may(word, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = take(operation(word), STUDIES[word], Here())
    (tmp_path / "study.toml").write_text(study_text(asked))
    assert read_study("study.toml", known=operation).operation == asked
    assert "folder" in asked.refused["http"] or "other files" in asked.refused["http"]


def test_what_is_wrong_is_said_in_a_paragraph(cases, tmp_path, capsys):
    assert "--out is missing" in wrong(capsys, "run", cases)
    assert "no file" in wrong(capsys, "run", tmp_path / "no.csv", "--out", tmp_path / "x")
    assert "until must be" in wrong(capsys, "run", cases, "--out", tmp_path, "--until", "later")
    assert "stored in the folder" in wrong(capsys, "run", "--out", tmp_path, "--accuracy", 1e-3)
    assert "needs the plan" in wrong(capsys, "run", "--out", tmp_path, "--shard", "1/2")
    assert "--out is missing" in wrong(capsys, "merge", tmp_path)
    assert "holds no campaign" in wrong(capsys, "status", tmp_path)
    assert "no file" in wrong(capsys, "export", tmp_path / "no", "--csv", tmp_path / "t.csv")
    assert "no output; give" in wrong(capsys, "export", tmp_path)
    assert "ending must be .mat" in wrong(capsys, "export", tmp_path, "--mat", tmp_path / "t.csv")


def test_a_folder_in_use_is_refused(cases, tmp_path, capsys):
    with locked(tmp_path):
        message = wrong(capsys, "run", cases, "--out", tmp_path)
    assert f"in use by process {os.getpid()}" in message


def test_a_missing_extra_is_named(cases, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    arguments = ["run", cases, "--out", tmp_path / "study", "--scheduler", "tcp://localhost:1"]
    assert install_command("cluster") in wrong(capsys, *arguments)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert install_command("campaign") in wrong(capsys, *arguments)


def test_the_commands_explain_themselves(capsys):
    for command in ("inputs", "plan", "run", "status", "verify", "merge", "export"):
        assert call(command, "--help") == 0
        assert "Example: viscotack campaign" in " ".join(capsys.readouterr().out.split())


THREADS = """
import sys
import psutil
from viscotack.app.cli import main
from viscotack.files.arrow import arrow
arrow()
before = psutil.Process().num_threads()
for words in sys.argv[1:]:
    try:
        main(["campaign", *words.split()])
    except SystemExit as end:
        assert not end.code, words
    print(words, psutil.Process().num_threads() - before, file=sys.stderr)
"""


def test_commands_leave_no_threads_of_arrow_that_abort_the_process(cases, crew, tmp_path):
    # under load one of seven processes ended with status 134
    folder = tmp_path / "study"
    assert call("run", cases, "--out", folder, "--accuracy", 0.02, "--until", "pull-off") == 0
    asked = ["status study", "verify study", "export study --csv a.csv", "export study --csv -"]
    asked += ["export study --parquet a.parquet", "merge study --out merged", "verify merged"]
    done = subprocess.run(
        [sys.executable, "-c", THREADS, *asked],
        cwd=tmp_path,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    counted = [line for line in done.stderr.splitlines() if line[:-2] in asked]
    assert counted == [f"{words} 0" for words in asked], done.stderr
