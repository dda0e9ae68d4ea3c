"""A run is killed again and again: its parent, its workers, all of them, and between two writes."""

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from itertools import islice
from pathlib import Path

import pytest

from campaign_work import InlineCrew, employ, finished, plan_of, stand_in, told, trouble
from viscotack.campaign import Store, local, run, verify
from viscotack.system import resident_memory

HERE = Path(__file__).parent
CASES = 160
CHILD = f"""
import os, signal, sys
sys.path.insert(0, {str(HERE)!r})
from campaign_work import trouble
from viscotack.campaign import local, parts, read_plan, run

# the case that never ends is not ended here: no run is over before it is killed
local.GRACE, parts._MERGED = 1e9, 3
left = int(sys.argv[3])
for name in ("fsync", "link", "replace", "unlink"):
    def change(*arguments, before=getattr(os, name), **options):
        global left
        left -= 1
        if left == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return before(*arguments, **options)
    setattr(os, name, change)
run(read_plan(sys.argv[1]), sys.argv[2], workers=2, store_every=0.05, work=trouble,
    report=lambda now: print(now.done + now.failed, flush=True))
"""


def strike_a_worker(process, chance):
    """Kill one of the workers of a run, if there is one."""
    with suppress(OSError, IndexError):
        found = Path(f"/proc/{process}/task/{process}/children").read_text().split()
        os.kill(int(chance.choice(found)), signal.SIGKILL)


@pytest.mark.slow
@pytest.mark.skipif(not resident_memory(), reason="only Linux tells of other processes")
def test_fifteen_kills_lose_nothing_and_duplicate_nothing(tmp_path, monkeypatch):
    plan = plan_of(tmp_path, cases=CASES, text="settings.time_limit = 1.0")
    folder, chance, reported = tmp_path / "c", random.Random(22), 0
    for end in ("parent", "instant", "group", "instant", "parent"):
        instant = chance.randrange(15, 60) if end == "instant" else -1
        words = [str(tmp_path / "plan.toml"), str(folder), str(instant)]
        started = subprocess.Popen(
            [sys.executable, "-c", CHILD, *words],
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        numbers = (int(line) for line in started.stdout)
        new = (n for n in numbers if n > reported or n >= CASES - 2)
        reported = max(reported, next(new, 0))
        for _ in range(2):
            time.sleep(chance.uniform(0.0, 0.15))
            strike_a_worker(started.pid, chance)
        time.sleep(chance.uniform(0.0, 0.3))
        if end == "group":
            os.killpg(started.pid, signal.SIGKILL)
        if end == "instant":  # it kills itself, if there are so many changes to files
            reported = max([reported, *islice(numbers, 100)])
        started.kill()
        reported = max([reported, *numbers])
        assert started.wait() == -signal.SIGKILL
        started.stdout.close()
        store = Store(folder)
        done, failed = finished(store)
        assert not verify(store).wrong
        assert store.results().num_rows == len(done) and len(done) + len(failed) >= reported
    assert reported >= 3

    monkeypatch.setattr(local, "GRACE", 4.0)  # in which all others end, beside other work too
    end = run(plan, folder, workers=2, work=trouble)
    assert (end.done, end.failed) == (CASES - 2, 2) and not verify(Store(folder)).wrong
    results, failures, *_ = told(folder)
    assert {(row["rate"], row["failure"]) for row in failures} == {
        (7.0, "worker died"),
        (11.0, "time limit"),
    }
    assert all("viscotack" in row["versions"] for row in failures)
    employ(monkeypatch, InlineCrew())
    run(plan, tmp_path / "undisturbed", work=stand_in)
    undisturbed = told(tmp_path / "undisturbed")[0]
    assert results == [row for row in undisturbed if row["rate"] not in (7.0, 11.0)]
