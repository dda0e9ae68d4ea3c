"""Worker processes that wait, die, grow or stop, and their supervisor, who trusts none of them."""

import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager, nullcontext
from pathlib import Path

import pytest

import synthetic
from campaign_work import (
    at_rest,
    bare,
    gated,
    growing,
    holding,
    last_words,
    plan_of,
    stand_in,
    stubborn,
    waiting,
)
from processes import LONG, children, lives, state, until
from viscotack import to_dict
from viscotack.campaign import CaseSettings, NoWorker, Store, run
from viscotack.campaign import local as local_module
from viscotack.campaign.case import Answer
from viscotack.campaign.local import local
from viscotack.pool import supervisor
from viscotack.system import peak_memory, resident_memory

HERE = Path(__file__).parent
PROBLEM = json.dumps(to_dict(synthetic.GROUPS))
LINUX = pytest.mark.skipif(not resident_memory(), reason="only Linux tells of other processes")


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Let cases have little time beyond their limit."""
    monkeypatch.setattr(local_module, "GRACE", 0.3)


@pytest.fixture
def began(tmp_path, monkeypatch):
    """Return whether so many cases have begun that tell of it."""
    monkeypatch.setenv("CAMPAIGN_TEST_BEGAN", str(tmp_path))
    return lambda count=1: len([*tmp_path.glob("[0-9]*")]) == count


def ready(crew):
    """Wait until all workers of a crew have begun."""
    until(lambda: crew.collect(0.0) or crew.room() == crew.workers())


def answer_of(crew):
    """Return what comes back of the case that was handed in."""
    ((_, answer),) = until(lambda: crew.collect(0.0))
    return answer


@contextmanager
def one(work, **settings):
    """Hold a crew of one worker, ready."""
    with local(work, CaseSettings(**settings), 1) as crew:
        ready(crew)
        yield crew


@pytest.mark.slow
@pytest.mark.parametrize(
    "work",
    [waiting, holding, pytest.param(stubborn, marks=pytest.mark.slow)],
)
def test_a_case_that_never_comes_back_is_ended_with_its_process(work, clock, began):
    with one(work, time_limit=1.0) as crew:
        (before,) = crew.processes()
        crew.hand(7, PROBLEM)
        until(began)
        clock.now += 1.29
        assert crew.collect(0.0) == [] and lives(before), "limit and grace are not over"
        clock.now += 0.02
        answer = answer_of(crew)
        assert isinstance(answer, Answer) and answer.failure == "time limit"
        assert answer.reason == "took more than 1 s and did not end by itself"
        assert answer.wall_time_s == pytest.approx(1.31)
        assert not crew.processes() and not lives(before)
        ready(crew)
        assert crew.processes() != [before]


def suspend(process):
    os.kill(process, signal.SIGSTOP)
    until(lambda: state(process) == "T")


@LINUX
def test_a_suspended_worker_is_killed_at_the_time_limit(clock):
    with one(waiting, time_limit=1.0) as crew:
        suspend(crew.processes()[0])
        crew.hand(0, PROBLEM)
        clock.now += 1.4
        assert answer_of(crew).failure == "time limit"


@pytest.mark.slow
@LINUX
def test_a_case_that_takes_too_much_memory_is_ended():
    # what the worker has at rest is not counted, nor what an earlier case has left there
    with one(at_rest, memory_limit=100e6) as crew:
        for number in range(2):
            crew.hand(number, PROBLEM)
            answer = answer_of(crew)
            assert answer.row is not None and answer.peak_memory > 150e6
        assert resident_memory(crew.processes()[0]) > 150e6
    with one(growing, memory_limit=100e6) as crew:
        base = resident_memory(crew.processes()[0])
        crew.hand(0, PROBLEM)
        answer = answer_of(crew)
        assert answer.failure == "memory limit" and "more than 100 MB" in answer.reason
        assert base + 100e6 < answer.peak_memory < base + 300e6
    assert peak_memory() > 1e6


def test_workers_end_by_themselves_when_the_run_has_ended_and_at_once_when_it_has_failed(
    tmp_path, monkeypatch
):
    # as long as a busy machine needs: the state is waited for, not a time
    monkeypatch.setattr(supervisor, "_PATIENCE", 120.0)
    for name, end in (("peace", nullcontext()), ("failure", pytest.raises(RuntimeError))):
        (tmp_path / name).mkdir()
        monkeypatch.setenv("CAMPAIGN_TEST_LAST_WORDS", str(tmp_path / name))
        with end, local(last_words, CaseSettings(), 1) as crew:
            ready(crew)
            crew.hand(0, PROBLEM)
            assert answer_of(crew).failure == ""
            if name == "failure":
                raise RuntimeError("the run has failed")
        assert not crew.processes()
    assert [path.name for path in tmp_path.glob("*/last words")] == ["last words"]
    assert (tmp_path / "peace/last words").exists()


def test_the_limits_of_a_case_begin_with_it(clock):
    # neither the time at rest nor what an earlier case took is counted
    with one(stand_in, time_limit=1.0) as crew:
        for number in range(3):
            clock.now += 1.2
            assert crew.collect(0.0) == []
            crew.hand(number, PROBLEM)
            clock.now += 1.2
            assert answer_of(crew).row is not None


def test_a_worker_that_dies_takes_its_own_case_along():
    with local(waiting, CaseSettings(), 2) as crew:
        ready(crew)
        crew.hand(0, PROBLEM), crew.hand(1, PROBLEM)
        first, second = crew.processes()
        os.kill(first, signal.SIGKILL)
        ((number, lost),) = until(lambda: crew.collect(0.0))
        assert number == 0 and lost.blame and "was ended by SIGKILL" in lost.reason
        assert crew.processes() == [second]


def test_a_worker_that_dies_at_rest_costs_no_case():
    with one(stand_in) as crew:
        os.kill(crew.processes()[0], signal.SIGKILL)
        until(lambda: crew.collect(0.0) or not crew.processes())
        ready(crew)
        crew.hand(0, PROBLEM)
        assert answer_of(crew).row is not None


def test_a_worker_that_cannot_begin_ends_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr(bare, "__module__", "no_such_module")
    with pytest.raises((NoWorker, Exception), match="no_such_module|bare"):
        run(plan_of(tmp_path), tmp_path / "c", work=bare)
    monkeypatch.setattr(supervisor, "_program", lambda *_: "raise SystemExit(3)")
    with pytest.raises(NoWorker, match="3 worker processes in a row.*ended with status 3"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)
    monkeypatch.setattr(supervisor, "_program", lambda *_: "import time; time.sleep(60)")
    monkeypatch.setattr(supervisor, "_START", 0.2)
    with pytest.raises(NoWorker, match="did not start within 0.2 s"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)


RUN = """
import sys; sys.path.insert(0, {here!r})
import campaign_work
from viscotack.campaign import local, read_plan, run

def say(now):
    print(now.done, flush=True)

local.GRACE = 0.5
end = run(read_plan(sys.argv[1]), sys.argv[2], workers=2, store_every=0.0, report=say,
          work=getattr(campaign_work, sys.argv[3]))
print("end", end.done, end.failed, end.stopped, flush=True)
"""


@contextmanager
def running(tmp_path, work, cases=400, text=""):
    """Hold a run in a process group of its own; yields it and the numbers of its workers."""
    plan_of(tmp_path, cases=cases, text=text)
    code = RUN.format(here=str(HERE))
    arguments = [str(tmp_path / "plan.toml"), str(tmp_path / "c"), work.__name__]
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env=os.environ | {"CAMPAIGN_TEST_BEGAN": str(tmp_path)},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


@pytest.mark.slow
@LINUX
def test_sigterm_to_the_group_ends_a_run_in_order(tmp_path):
    # all cases but the first ten wait for a file, so that the run is not over before
    with running(tmp_path, gated) as process:
        assert process.stdout is not None
        while int(process.stdout.readline()) < 3:
            pass
        os.killpg(process.pid, signal.SIGTERM)
        (tmp_path / "go").touch()
        out, _ = process.communicate(timeout=LONG)
        _, done, failed, stopped = out.split()[-4:]
        assert process.returncode == 0 and stopped == "True" and failed == "0"
        assert Store(tmp_path / "c").results().num_rows == int(done) <= 12


@pytest.mark.slow
@LINUX
@pytest.mark.parametrize("work", [pytest.param(waiting, marks=pytest.mark.slow), holding])
def test_no_worker_outlives_its_parent(tmp_path, work):
    with running(tmp_path, work) as process:
        until(lambda: len([*tmp_path.glob("[0-9]*")]) == 2)
        workers = children(process.pid)
        assert {str(worker) for worker in workers} == {p.name for p in tmp_path.glob("[0-9]*")}
        process.kill()
        process.wait()
        until(lambda: not any(map(lives, workers)))
