"""Worker processes that wait, die, grow or stop, and their supervisor, who trusts none of them."""

import json
import os
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager, nullcontext
from pathlib import Path

import pytest

import synthetic
from campaign_work import (
    at_rest,
    bare,
    deadly,
    gated,
    growing,
    holding,
    last_words,
    plan_of,
    stand_in,
    stubborn,
    threads,
    waiting,
)
from processes import LONG, children, lives, state, until
from viscotack import to_dict
from viscotack.campaign import CaseSettings, NoWorker, Store, run
from viscotack.campaign import local as local_module
from viscotack.campaign.case import Answer, Lost
from viscotack.campaign.local import local
from viscotack.pool import supervisor
from viscotack.pool.line import Line
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
def test_a_suspended_worker_is_killed_when_it_gives_no_sign_of_life(clock, began, monkeypatch):
    heard, receive = [], Line.receive

    def listened(line):
        found = receive(line)
        heard.extend(found)
        return found

    monkeypatch.setattr(Line, "receive", listened)
    with one(waiting, time_limit=600.0) as crew:
        crew.hand(0, PROBLEM)
        until(began)
        for _ in range(2):
            heard.clear()
            clock.now += 59.0
            assert crew.collect(0.0) == []
            until(lambda: crew.collect(0.0) or ("alive", None) in heard)
        assert lives(crew.processes()[0]), "it gives signs of life"
        suspend(crew.processes()[0])
        assert crew.collect(0.0) == []
        clock.now += 60.1
        assert answer_of(crew) == Lost("its worker process sent no heartbeat for 60 s")


def test_a_run_that_was_halted_takes_no_case_for_slow(clock, monkeypatch):
    monkeypatch.setattr(supervisor, "_LONGEST", 0.01)
    with one(waiting, time_limit=1.0) as crew:
        crew.hand(0, PROBLEM)
        for _ in range(20):
            clock.now += 100.0  # ctrl-Z, or a machine that slept
            assert not crew.collect(0.0)


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


def test_the_memory_of_a_process_that_is_not_there_is_none():
    assert resident_memory(99_999_999) == 0.0
    assert resident_memory() > 1e7 and peak_memory() >= 0.9 * resident_memory()


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


def test_a_message_that_nobody_takes_does_not_hold_the_supervisor():
    ours, theirs = socket.socketpair()
    with theirs:
        line = Line(ours)
        with pytest.raises(TimeoutError):
            line.send(b"x" * 10_000_000, 0.2)
        line.close()
    ours, theirs = socket.socketpair()
    with theirs:
        line, other = Line(ours), Line(theirs)
        line.send(line.packed("one"), 5.0)
        # the next one has all the time of the world
        assert ours.gettimeout() is None
        line.send(line.packed("two"))
        assert other.receive() == ["one", "two"]
        line.close()


def test_workers_are_deaf_to_what_ends_their_parent_and_have_one_thread():
    with one(threads) as crew:
        for number in (signal.SIGINT, signal.SIGTERM):
            os.kill(crew.processes()[0], number)
        crew.hand(0, PROBLEM)
        row = answer_of(crew).row
        assert row["OMP_NUM_THREADS"] == row["OPENBLAS_NUM_THREADS"] == "1"
        assert row["MKL_NUM_THREADS"] == "1" and row["blas"] == 1


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


def test_three_starts_in_a_row_that_come_to_nothing_end_a_run(monkeypatch):
    good, wanted, asked = supervisor._program, ["bad", "bad", "good", "bad", "bad", "bad"], []

    def program(*line):
        asked.append(wanted[len(asked)])
        return good(*line) if asked[-1] == "good" else "raise SystemExit(3)"

    monkeypatch.setattr(supervisor, "_program", program)
    with local(stand_in, CaseSettings(), 1) as crew:
        ready(crew)
        assert asked == wanted[:3]
        os.kill(crew.processes()[0], signal.SIGKILL)
        until(lambda: crew.collect(0.0) or not crew.processes())
        with pytest.raises(NoWorker, match="3 worker processes in a row.*ended with status 3"):
            ready(crew)
    assert asked == wanted


def test_a_worker_of_another_program_is_given_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(local_module, "identity", lambda: {"viscotack": "0.0"})
    with pytest.raises(NoWorker, match=r"viscotack \S+ and not 0.0.*changed while this run"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)
    assert Store(tmp_path / "c").results().num_rows == 0


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


def test_the_death_of_a_worker_is_in_the_words(tmp_path):
    with one(deadly) as crew:
        crew.hand(0, PROBLEM.replace(f'"rate": {synthetic.GROUPS.rate}', '"rate": 7.0'))
        assert answer_of(crew) == Lost("its worker process ended with status 1")
