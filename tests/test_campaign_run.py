import importlib
import os
import random
import signal
import subprocess
import sys
from itertools import count
from pathlib import Path

import pytest

import synthetic
from campaign_work import Inline, dangerous, interrupting, picky, plan_of, stand_in, told
from viscotack.campaign import CannotRun, CaseSettings, Store, measure, run
from viscotack.campaign.running import attempt
from viscotack.model.problem.rows import kind_of_problem

HERE = Path(__file__).parent
PACKAGES = [path for path in [os.environ.get("PYTHONPATH")] if path]


@pytest.fixture
def inline():
    return Inline()


def rates(folder):
    return [row["rate"] for row in Store(folder).results()]


def test_every_case_is_run_once_and_stored_and_not_run_again(tmp_path, inline):
    options = {"work": stand_in, "executor": inline}
    end = run(plan_of(tmp_path, cases=7), tmp_path / "c", **options)
    assert (end.cases, end.done, end.failed, end.stopped) == (7, 7, 0, False)
    assert sorted(inline.done) == rates(tmp_path / "c") == [float(i + 1) for i in range(7)]
    row = list(Store(tmp_path / "c").results())[3]
    assert row["pull_off_force"] == 0.25 and row["tabor"] == 1.0 and len(row["trajectory_force"])
    inline.done.clear()
    end = run(plan_of(tmp_path, cases=10), tmp_path / "c", **options)
    assert sorted(inline.done) == [8, 9, 10] and end.done == 10
    inline.done.clear()
    # a smaller plan in the same folder: there is nothing to do, and nothing is lost
    end = run(plan_of(tmp_path, cases=3), tmp_path / "c", **options)
    assert not inline.done and (end.cases, end.done) == (3, 3)
    assert sorted(rates(tmp_path / "c")) == [float(i + 1) for i in range(10)]


def test_failures_have_their_own_table_and_are_tried_again_on_demand(tmp_path, inline):
    folder, plan = tmp_path / "c", plan_of(tmp_path)
    end = run(plan, folder, work=picky, executor=inline)
    assert (end.done, end.failed) == (16, 4) == Store(folder).counts()[1:]
    failures = list(Store(folder).failures())
    assert [row["rate"] for row in failures] == [5, 10, 15, 20]
    assert failures[0]["reason"] == "no contact at a rate of 5"
    assert not set(rates(folder)) & {5, 10, 15, 20}
    inline.done.clear()
    assert run(plan, folder, work=stand_in, executor=inline).failed == 4 and not inline.done
    end = run(None, folder, work=stand_in, retry=True, executor=inline)
    assert (end.done, end.failed) == (20, 0) and len(inline.done) == 4
    assert not list(Store(folder).failures())


def test_ctrl_c_finishes_the_cases_in_flight(tmp_path, inline):
    folder, plan = tmp_path / "c", plan_of(tmp_path)
    before = signal.getsignal(signal.SIGINT)
    end = run(plan, folder, work=interrupting, executor=inline)
    assert end.stopped and 0 < end.done < 20
    assert len(rates(folder)) == end.done == len(inline.done)
    assert signal.getsignal(signal.SIGINT) is before
    assert run(plan, folder, work=stand_in, executor=inline).done == 20
    run(plan, tmp_path / "undisturbed", work=stand_in, executor=inline)
    assert told(folder) == told(tmp_path / "undisturbed")


def test_a_case_that_kills_its_workers_is_found(tmp_path):
    inline = Inline(deaths=[7.0])
    end = run(plan_of(tmp_path), tmp_path / "c", work=stand_in, executor=inline)
    assert (end.done, end.failed) == (19, 1)
    (row,) = Store(tmp_path / "c").failures()
    assert row["rate"] == 7 and row["failure"] == "worker died"
    # once among others, twice alone, and all of the others once
    assert inline.lost[-2:] == [[7.0], [7.0]] and len(inline.lost) == 3
    assert sorted(inline.done) == rates(tmp_path / "c")
    # and is tried again by the next run, which may be on a better machine
    assert run(plan_of(tmp_path), tmp_path / "c", work=stand_in, executor=Inline()).done == 20


def test_a_run_in_which_every_worker_dies_ends(tmp_path):
    inline = Inline(deaths=[float(i + 1) for i in range(100)])
    with pytest.raises(CannotRun):
        run(plan_of(tmp_path, cases=100), tmp_path / "c", work=stand_in, executor=inline)


def test_a_case_that_marches_too_long_ends_by_itself(monkeypatch):
    # on a clock that goes on by a hundredth of a second whenever somebody looks at it
    ticks = count(100.0, 0.01)
    for module in ("campaign.running", "clock"):
        monkeypatch.setattr(
            importlib.import_module(f"viscotack.{module}"), "perf_counter", ticks.__next__
        )
    kind = kind_of_problem(synthetic.GROUPS, {"tabor"})
    settings = CaseSettings(accuracy=2e-4, time_limit=0.2)
    answer = attempt(measure, kind, {"tabor": synthetic.GROUPS.tabor}, settings)
    assert (answer.failure, answer.reason) == ("time limit", "took more than 0.2 s")
    assert 0.2 <= answer.wall_time_s < 0.3


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited on Linux only")
def test_processes_die_hang_and_are_full_and_the_others_are_as_without_them(tmp_path, inline):
    plan = plan_of(tmp_path, text='settings = {time_limit = 2.0, memory_limit = "400 MB"}')
    end = run(plan, tmp_path / "c", workers=2, work=dangerous)
    assert (end.done, end.failed) == (17, 3)
    failures = {row["rate"]: row["failure"] for row in Store(tmp_path / "c").failures()}
    assert failures == {2: "worker died", 3: "time limit", 4: "memory limit"}
    run(plan, tmp_path / "here", work=stand_in, executor=inline)
    expected = [row for row in told(tmp_path / "here")[0] if row["rate"] not in failures]
    assert told(tmp_path / "c")[0] == expected


CHILD = """
import sys
from pathlib import Path
from campaign_work import plan_of, slow
from viscotack.campaign import run

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    run(plan_of(folder, cases=400), folder / "c", workers=2, work=slow,
        report=lambda now: print(now.done, flush=True))
"""


def child(folder):
    """Start a run of 400 cases in a process of its own."""
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
def test_kills_lose_nothing_and_duplicate_nothing(tmp_path, inline):
    folder, reported, chance = tmp_path / "c", 0, random.Random(3)
    for _ in range(3):
        started = child(tmp_path)
        reported = int(news(started, reported))
        assert reported > 0
        # all processes at once, or the runner alone, at a drawn moment
        with pytest.raises(subprocess.TimeoutExpired):
            started.wait(chance.random() / 2)
        chance.choice([os.kill, os.killpg])(started.pid, signal.SIGKILL)
        started.communicate()
        found = rates(folder)
        assert reported <= len(found) == len(set(found)) < 400
    plan = plan_of(tmp_path, cases=400)
    assert run(plan, folder, workers=2, work=stand_in).done == 400
    run(plan, tmp_path / "undisturbed", work=stand_in, executor=inline)
    assert told(folder) == told(tmp_path / "undisturbed")


@pytest.mark.slow
def test_ctrl_c_in_a_terminal_ends_a_run_in_order(tmp_path):
    started = child(tmp_path)
    assert int(news(started, 0)) > 0
    os.killpg(started.pid, signal.SIGINT)
    _, err = started.communicate(timeout=60)
    assert started.returncode == 0 and "Traceback" not in err
    assert 0 < len(rates(tmp_path / "c")) < 400
