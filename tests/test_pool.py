"""Pools of worker processes: progress, cancellation, limits, crashes."""

from contextlib import contextmanager
from math import inf

import pytest

from processes import lives, until
from viscotack.pool import Limits, Pool, Setup

FREE = Limits()


@contextmanager
def pool_of(workers=1, prepare="prepare", **setup):
    """Hold a pool whose workers are ready."""
    pool = Pool(Setup(f"pool_tasks:{prepare}", {"a": 1}, **{"code": "json", **setup}), workers)
    try:
        until(lambda: pool.collect(0.0) or pool.room() == workers)
        yield pool
    finally:
        pool.dismiss(at_once=True)


@pytest.fixture
def began(tmp_path):
    return tmp_path / "began"


def outcome(pool, told=None):
    """Wait for the outcome of the only task; progress goes into a list."""
    news = [] if told is None else told

    def found():
        events = [event for _, event in pool.collect(0.0)]
        news.extend(event.what for event in events if event.kind == "told")
        return [event for event in events if event.kind != "told"]

    (event,) = until(found)
    return event


def done(pool, task, asked=None, told=None):
    pool.hand(0, f"pool_tasks:{task}", asked, FREE)
    return outcome(pool, told)


@pytest.mark.parametrize("code", ["json", "pickle"])
def test_a_task_gets_what_was_asked_and_prepared_and_reports_progress(code):
    with pool_of(code=code) as pool:
        answer = done(pool, "echo", [1, "two"]).what
        assert answer["asked"] == [1, "two"] and answer["context"] == {"a": 1}
        assert [answer["process"]] == pool.processes()
        told = []
        assert done(pool, "report", [0.1, 0.5, 1.0], told).what == "over"
        assert told == [0.1, 0.5, 1.0]


@pytest.mark.parametrize("task", ["loop", "spin"])
def test_a_task_that_is_stopped_is_interrupted_and_its_process_is_kept(clock, began, task):
    with pool_of() as pool:
        (before,) = pool.processes()
        for number in range(3):
            began.unlink(missing_ok=True)
            pool.hand(number, f"pool_tasks:{task}", str(began), Limits(grace=inf))
            until(lambda: pool.collect(0.0) is not None and began.exists())
            pool.stop(number)
            assert outcome(pool).kind == "stopped"
        assert done(pool, "echo", 7).what["process"] == before


def test_a_task_is_interrupted_at_its_time_limit_and_killed_after_the_grace(clock, began):
    with pool_of() as pool:
        (before,) = pool.processes()
        pool.hand(0, "pool_tasks:spin", str(began), Limits(10.0, grace=inf))
        until(began.exists)
        clock.now += 9.9
        assert pool.collect(0.0) == [] and pool.busy()
        clock.now += 0.2
        ended = outcome(pool)
        assert ended.kind == "time limit"
        assert ended.seconds == pytest.approx(10.1) and pool.processes() == [before]
        began.unlink()
        pool.hand(1, "pool_tasks:hang", str(began), Limits(10.0, grace=0.2))
        until(began.exists)
        clock.now += 10.1
        assert pool.collect(0.0) == [] and lives(before)
        clock.now += 0.2
        ended = outcome(pool)
        assert ended.kind == "time limit" and "did not end by itself" in ended.what
        assert not lives(before) and pool.processes() == []
        until(lambda: pool.collect(0.0) or pool.room() == 1)


def test_a_crash_costs_its_own_task_only_and_the_process_is_replaced(began):
    with pool_of(workers=2) as pool:
        first, second = pool.processes()
        pool.hand(0, "pool_tasks:die", None, FREE)
        pool.hand(1, "pool_tasks:spin", str(began), FREE)
        ((number, lost),) = until(lambda: pool.collect(0.0))
        assert (number, lost.kind, lost.what) == (0, "lost", "ended with status 3")
        assert pool.processes() == [second]
        until(lambda: pool.collect(0.0) or pool.room())
        assert len(pool.processes()) == 2 and first not in pool.processes()
