"""Worker processes that wait, die, grow or stop, and their supervisor, who trusts none of them."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, nullcontext
from pathlib import Path

import pytest

import synthetic
from campaign_work import (
    at_rest,
    bare,
    brief,
    deadly,
    growing,
    holding,
    last_words,
    plan_of,
    stand_in,
    stubborn,
    threads,
    waiting,
)
from viscotack import to_dict
from viscotack.campaign import CaseSettings, NoWorker, Store, run, supervisor
from viscotack.campaign.case import Answer
from viscotack.campaign.crew import Lost
from viscotack.campaign.memory import peak_memory, resident_memory
from viscotack.campaign.supervisor import local
from viscotack.campaign.worker import Line

HERE = Path(__file__).parent
PROBLEM = json.dumps(to_dict(synthetic.GROUPS))
LINUX = pytest.mark.skipif(not resident_memory(), reason="only Linux tells of other processes")


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Let limits be kept to a fraction of a second."""
    monkeypatch.setattr(supervisor, "GRACE", 0.3)


def ready(crew, seconds=30.0):
    """Wait until all workers of a crew have begun."""
    until = time.monotonic() + seconds
    while crew.room() < crew.workers():
        assert time.monotonic() < until, "no worker has begun"
        crew.collect(0.05)


def answer_of(crew, seconds=20.0):
    """Return what comes back of the case that was handed in."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if found := crew.collect(0.1):
            ((_, answer),) = found
            return answer
    raise AssertionError("nothing has come back")


@contextmanager
def one(work, **settings):
    """Hold a crew of one worker, ready."""
    with local(work, CaseSettings(**settings), 1) as crew:
        ready(crew)
        yield crew


def lives(process):
    """Return whether a process is there, and no corpse that nobody has buried."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.parametrize("work", [waiting, holding, stubborn])
def test_a_case_that_never_comes_back_is_ended_with_its_process(work):
    with one(work, time_limit=1.0) as crew:
        (before,) = crew.processes()
        began = time.monotonic()
        crew.hand(7, PROBLEM)
        answer = answer_of(crew)
        took = time.monotonic() - began
        assert isinstance(answer, Answer) and answer.failure == "time limit"
        assert answer.reason == "took more than 1 s and did not end by itself"
        # limit and grace, neither much less nor a multiple
        assert 1.3 <= took < 2.0 and answer.wall_time_s == pytest.approx(took, abs=0.3)
        assert not crew.processes()
        ready(crew)
        assert crew.processes() != [before]


def test_a_worker_that_is_stopped_is_ended_too(monkeypatch):
    with one(waiting, time_limit=1.0) as crew:
        os.kill(crew.processes()[0], signal.SIGSTOP)
        crew.hand(0, PROBLEM)
        assert answer_of(crew).failure == "time limit"
    monkeypatch.setattr(supervisor, "_SILENCE", 1.5)
    with one(waiting, time_limit=600.0) as crew:
        crew.hand(0, PROBLEM)
        crew.collect(1.2)
        assert crew.processes(), "it gives signs of life"
        os.kill(crew.processes()[0], signal.SIGSTOP)
        assert answer_of(crew) == Lost("its worker process gave no sign of life for 1.5 s")


def test_a_run_that_was_halted_takes_no_case_for_slow(monkeypatch):
    now = [time.monotonic()]
    monkeypatch.setattr(supervisor, "monotonic", lambda: now[0])
    monkeypatch.setattr(supervisor, "_LONGEST", 0.01)
    with local(waiting, CaseSettings(time_limit=1.0), 1) as crew:
        while not crew.room():
            crew.collect(0.0)
        crew.hand(0, PROBLEM)
        for _ in range(20):
            now[0] += 100.0  # ctrl-Z, or a machine that slept
            assert not crew.collect(0.0)


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
        # it is looked at every 50 ms, in which the case may take some more
        assert base + 100e6 < answer.peak_memory < base + 900e6
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


def test_the_memory_of_a_process_that_is_not_there_is_none(monkeypatch):
    assert resident_memory(99_999_999) == 0.0
    assert resident_memory() > 1e7 and peak_memory() >= 0.9 * resident_memory()
    monkeypatch.setattr(Path, "read_text", lambda _: "no such line")
    assert peak_memory() == resident_memory() == 0.0


def test_the_limits_of_a_case_begin_with_it(monkeypatch):
    # neither the time at rest nor what an earlier case took is counted
    now = [1000.0]
    monkeypatch.setattr(supervisor, "monotonic", lambda: now[0])
    monkeypatch.setattr(supervisor, "_LONGEST", 0.5)
    with local(brief, CaseSettings(time_limit=1.0), 1) as crew:
        while not crew.room():
            crew.collect(0.0)
            time.sleep(0.02)
        for number in range(3):
            for _ in range(4):
                now[0] += 0.4
                assert crew.collect(0.0) == []
            crew.hand(number, PROBLEM)
            found = []
            while not found:
                found = crew.collect(0.0)
                time.sleep(0.02)
            assert found[0][1].row is not None


def test_a_worker_that_dies_takes_its_own_case_along():
    with local(waiting, CaseSettings(), 2) as crew:
        ready(crew)
        crew.hand(0, PROBLEM), crew.hand(1, PROBLEM)
        first, second = crew.processes()
        os.kill(first, signal.SIGKILL)
        ((number, lost),) = crew.collect(5.0)
        assert number == 0 and lost.blame and "was ended by SIGKILL" in lost.reason
        assert crew.processes() == [second]


def test_a_worker_that_dies_at_rest_costs_no_case():
    with one(stand_in) as crew:
        os.kill(crew.processes()[0], signal.SIGKILL)
        assert crew.collect(0.5) == []
        ready(crew)
        crew.hand(0, PROBLEM)
        assert answer_of(crew).row is not None


def test_a_message_that_nobody_takes_does_not_hold_the_supervisor():
    ours, theirs = socket.socketpair()
    with theirs:
        line, began = Line(ours), time.monotonic()
        with pytest.raises(OSError):
            line.send("x" * 10_000_000, 0.2)
        assert 0.2 <= time.monotonic() - began < 5.0
        line.close()
    ours, theirs = socket.socketpair()
    with theirs:
        line, other = Line(ours), Line(theirs)
        line.send("one", 5.0)
        # the next one has all the time of the world
        assert ours.gettimeout() is None
        line.send("two")
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
    monkeypatch.setattr(supervisor, "_program", lambda handle: "raise SystemExit(3)")
    with pytest.raises(NoWorker, match="3 worker processes in a row.*ended with status 3"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)
    monkeypatch.setattr(supervisor, "_program", lambda handle: "import time; time.sleep(60)")
    monkeypatch.setattr(supervisor, "_START", 0.2)
    with pytest.raises(NoWorker, match="did not begin in 0.2 s"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)


def test_three_starts_in_a_row_that_come_to_nothing_end_a_run(monkeypatch):
    good, wanted, asked = supervisor._program, ["bad", "bad", "good", "bad", "bad", "bad"], []

    def program(handle):
        asked.append(wanted[len(asked)])
        return good(handle) if asked[-1] == "good" else "raise SystemExit(3)"

    monkeypatch.setattr(supervisor, "_program", program)
    with local(stand_in, CaseSettings(), 1) as crew:
        ready(crew)
        assert asked == wanted[:3]
        os.kill(crew.processes()[0], signal.SIGKILL)
        while crew.processes():
            assert crew.collect(0.1) == []
        with pytest.raises(NoWorker, match="3 worker processes in a row.*ended with status 3"):
            ready(crew)
    assert asked == wanted


def test_a_worker_of_another_program_is_given_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(supervisor, "identity", lambda: {"viscotack": "0.0"})
    with pytest.raises(NoWorker, match=r"viscotack \S+ and not 0.0.*changed while this run"):
        run(plan_of(tmp_path), tmp_path / "c", work=stand_in)
    assert Store(tmp_path / "c").results().num_rows == 0


RUN = """
import sys; sys.path.insert(0, {here!r})
import campaign_work
from viscotack.campaign import read_plan, run, supervisor

def say(now):
    print(now.done, flush=True)

supervisor.GRACE = 0.5
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


def children(process):
    """Return the processes that a process has started."""
    found = Path(f"/proc/{process}/task/{process}/children").read_text()
    return [int(word) for word in found.split()]


def until(condition, seconds=20.0):
    """Wait for something."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it has not come about"
        time.sleep(0.05)


@LINUX
def test_sigterm_to_the_group_ends_a_run_in_order(tmp_path):
    with running(tmp_path, slow_work()) as process:
        assert process.stdout is not None
        while int(process.stdout.readline()) < 3:
            pass
        os.killpg(process.pid, signal.SIGTERM)
        out, _ = process.communicate(timeout=30)
        _, done, failed, stopped = out.split()[-4:]
        assert process.returncode == 0 and stopped == "True" and failed == "0"
        assert Store(tmp_path / "c").results().num_rows == int(done) < 400


def slow_work():
    from campaign_work import slow

    return slow


@LINUX
@pytest.mark.parametrize("work", [waiting, holding])
def test_no_worker_outlives_its_parent(tmp_path, work):
    with running(tmp_path, work) as process:
        until(lambda: (tmp_path / "c/provenance.json").exists(), seconds=60.0)
        until(lambda: len([*tmp_path.glob("[0-9]*")]) == 2, seconds=60.0)
        workers = children(process.pid)
        assert {str(worker) for worker in workers} == {p.name for p in tmp_path.glob("[0-9]*")}
        time.sleep(0.3)
        process.kill()
        process.wait()
        until(lambda: not any(map(lives, workers)), seconds=5.0)


def test_the_death_of_a_worker_is_in_the_words(tmp_path):
    with one(deadly) as crew:
        crew.hand(0, PROBLEM.replace(f'"rate": {synthetic.GROUPS.rate}', '"rate": 7.0'))
        assert answer_of(crew) == Lost("its worker process ended with status 1")
