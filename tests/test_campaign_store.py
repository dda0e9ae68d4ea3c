import os
import subprocess
import sys

import pytest

from campaign_work import finished, plan_of
from viscotack.campaign import Store, export
from viscotack.campaign.parts import table_of
from viscotack.files.lock import FolderInUse, locked

HOLD = (
    "import sys, time; from pathlib import Path\n"
    "from viscotack.files.lock import locked\n"
    "with locked(Path(sys.argv[1])):\n    print('held', flush=True)\n    time.sleep(60)\n"
)


def test_a_second_run_on_a_folder_is_refused_until_the_first_has_ended(tmp_path):
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None and holder.stdout.readline() == "held\n"
        with pytest.raises(FolderInUse, match=f"in use by process {holder.pid} on "):
            with locked(tmp_path):
                pass
        holder.kill()
        holder.wait()
        with locked(tmp_path):
            assert (tmp_path / "lock").read_text().startswith(f"process {os.getpid()} on ")


def test_a_plan_may_grow_but_not_change_its_accuracy(tmp_path):
    Store.create(tmp_path, plan_of(tmp_path / "p", cases=3)).add([{"name": "x"}], [])
    grown = Store.create(tmp_path, plan_of(tmp_path / "p", cases=5, text="settings.time_limit = 9"))
    assert len(grown.plan().cases) == 5 and finished(grown) == ({"x"}, {})
    with pytest.raises(ValueError, match=r"accuracy = 0.002, the plan asks for 0.001; .*--out"):
        Store.create(tmp_path, plan_of(tmp_path / "p", text="settings.accuracy = 1e-3"))
    with pytest.raises(ValueError, match=r"until = pull-off, the plan asks for detached; .*--out"):
        Store.create(tmp_path, plan_of(tmp_path / "p", text='settings.until = "detached"'))


TABLE = [
    {"name": "a", "rate": 1.5, "status": "detached", "steps": 7, "trajectory": [0.1, None]},
    {"name": "b", "rate": None, "status": None, "steps": 9, "trajectory": [3.0, 4.0]},
]


def test_a_csv_table_gives_the_very_numbers_back(tmp_path):
    export(table_of([row | {"rate": 0.1 + 0.2} for row in TABLE]), tmp_path / "t.csv")
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[0] == "name,rate,status,steps,trajectory_01,trajectory_02"
    assert lines[1].split(",") == ["a", repr(0.1 + 0.2), "detached", "7", "0.1", ""]
    export(table_of(TABLE), tmp_path / "t.csv", trajectories=False)
    assert (tmp_path / "t.csv").read_text().splitlines()[2] == "b,,,9"
