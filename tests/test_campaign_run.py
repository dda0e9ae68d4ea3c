import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from campaign_work import (
    InlineCrew,
    employ,
    interrupting,
    picky,
    plan_of,
    stand_in,
)
from viscotack.campaign import Store, run

HERE = Path(__file__).parent
PACKAGES = [path for path in [os.environ.get("PYTHONPATH")] if path]


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


def table(folder):
    """Return what two runs must agree on."""
    return Store(folder).results().drop(["wall_time_s"])


def rates(folder):
    return Store(folder).results().column("rate").to_pylist()


def test_every_case_is_run_once_and_stored(tmp_path, crew):
    plan = plan_of(tmp_path)
    end = run(plan, tmp_path / "c", work=stand_in)
    assert (end.cases, end.done, end.failed, end.stopped) == (20, 20, 0, False)
    assert sorted(crew.done) == rates(tmp_path / "c") == [float(i + 1) for i in range(20)]
    row = Store(tmp_path / "c").results().to_pylist()[3]
    assert row["pull_off_force"] == 0.25 and row["tabor"] == 1.0 and len(row["trajectory_force"])


def test_what_is_stored_is_not_run_again(tmp_path, crew):
    run(plan_of(tmp_path, cases=7), tmp_path / "c", work=stand_in)
    crew.done.clear()
    end = run(plan_of(tmp_path, cases=10), tmp_path / "c", work=stand_in)
    assert sorted(crew.done) == [8, 9, 10] and end.done == 10
    crew.done.clear()
    # a smaller plan in the same folder: there is nothing to do, and nothing is lost
    end = run(plan_of(tmp_path, cases=3), tmp_path / "c", work=stand_in)
    assert not crew.done and (end.cases, end.done) == (3, 3)
    assert len(rates(tmp_path / "c")) == 10


def test_failures_have_their_own_table_and_are_tried_again_on_demand(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path)
    end = run(plan, folder, work=picky)
    assert (end.done, end.failed) == (16, 4)
    failures = Store(folder).failures()
    assert failures.column("rate").to_pylist() == [5, 10, 15, 20]
    assert failures.column("reason").to_pylist()[0] == "no contact at a rate of 5"
    assert not set(rates(folder)) & {5, 10, 15, 20}
    crew.done.clear()
    assert run(plan, folder, work=stand_in).failed == 4 and not crew.done
    end = run(plan, folder, work=stand_in, retry=True)
    assert (end.done, end.failed) == (20, 0) and len(crew.done) == 4
    assert Store(folder).failures().num_rows == 0


def table_of_undisturbed(tmp_path):
    run(plan_of(tmp_path), tmp_path / "undisturbed", work=stand_in)
    return table(tmp_path / "undisturbed")


def test_ctrl_c_finishes_the_cases_in_flight(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path)
    before = signal.getsignal(signal.SIGINT)
    end = run(plan, folder, work=interrupting)
    assert end.stopped and 7 <= end.done < 15
    assert len(rates(folder)) == end.done == len(crew.done)
    assert signal.getsignal(signal.SIGINT) is before
    assert run(plan, folder, work=stand_in).done == 20
    assert table(folder).equals(table_of_undisturbed(tmp_path))


def test_a_case_that_kills_its_workers_is_found(tmp_path, monkeypatch):
    crew = employ(monkeypatch, InlineCrew(deaths=[7.0] * 9))
    end = run(plan_of(tmp_path), tmp_path / "c", work=stand_in)
    assert (end.done, end.failed) == (19, 1)
    (row,) = Store(tmp_path / "c").failures().to_pylist()
    assert row["rate"] == 7 and row["failure"] == "worker died"
    # twice among others, once alone
    assert crew.alone == [False, False, True] and len(crew.deaths) == 6


def test_processes_give_the_same_table(tmp_path, monkeypatch):
    end = run(plan_of(tmp_path), tmp_path / "c", workers=2, work=picky)
    assert (end.done, end.failed) == (16, 4) and 0 < end.worker_use < 1
    employ(monkeypatch, InlineCrew())
    run(plan_of(tmp_path), tmp_path / "d", work=picky)
    assert table(tmp_path / "c").equals(table(tmp_path / "d"))


CHILD = """
import sys
from pathlib import Path
from campaign_work import plan_of, slow
from viscotack.campaign import run

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    run(plan_of(folder, cases=400), folder / "c", workers=2, work=slow, store_every=0.1,
        report=lambda now: print(now.done, flush=True))
"""


def child(folder):
    """Start a run of 400 cases in a process of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "child.py"
    script.write_text(CHILD)
    return subprocess.Popen(
        [sys.executable, str(script), str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(HERE), *PACKAGES])},
        start_new_session=True,
    )


def news(started, told):
    """Return the first number that a child reports above what was told; "0" if it ends before."""
    return next((line for line in started.stdout if int(line) > told), "0")


@pytest.mark.slow
def test_kills_lose_nothing_and_duplicate_nothing(tmp_path, monkeypatch):
    folder, reported = tmp_path / "c", 0
    for _ in range(3):
        started = child(tmp_path)
        reported = int(news(started, reported))
        assert reported > 0
        os.killpg(started.pid, signal.SIGKILL)
        started.communicate()
        found = rates(folder)
        assert reported <= len(found) == len(set(found)) < 400
    assert run(plan_of(tmp_path, cases=400), folder, workers=2, work=stand_in).done == 400
    employ(monkeypatch, InlineCrew())
    run(plan_of(tmp_path, cases=400), tmp_path / "undisturbed", work=stand_in)
    assert table(folder).equals(table(tmp_path / "undisturbed"))


@pytest.mark.slow
def test_ctrl_c_in_a_terminal_ends_a_run_in_order(tmp_path):
    started = child(tmp_path)
    assert int(news(started, 0)) > 0
    started.send_signal(signal.SIGINT)
    out, err = started.communicate(timeout=60)
    assert started.returncode == 0 and "Traceback" not in err
    last = int(out.split()[-1])
    assert last == Store(tmp_path / "c").results().num_rows < 400
    assert Store(tmp_path / "c").provenance["runs"][0]["stopped"] is True
