"""Worker processes that wait, die, grow or stop, and their supervisor, who trusts none of them."""

import json
from contextlib import contextmanager

import pytest

import synthetic
from campaign_work import (
    at_rest,
    growing,
    holding,
    stubborn,
    waiting,
)
from processes import lives, until
from viscotack import to_dict
from viscotack.campaign import CaseSettings
from viscotack.campaign import local as local_module
from viscotack.campaign.case import Answer
from viscotack.campaign.local import local
from viscotack.system import peak_memory, resident_memory

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
