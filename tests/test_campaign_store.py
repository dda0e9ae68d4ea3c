import os
import resource
import subprocess
import sys

import pytest

from campaign_work import Inline, picky, plan_of, stand_in, told
from command_line import rows_of
from viscotack import InputError
from viscotack.campaign import FolderInUse, Store, export, merge, run, shard_of
from viscotack.campaign.store import locked

HOLD = (
    "import sys, time; from pathlib import Path\n"
    "from viscotack.campaign.store import locked\n"
    "with locked(Path(sys.argv[1])):\n    print('held', flush=True)\n    time.sleep(60)\n"
)


def test_a_second_run_on_a_folder_is_refused_until_the_first_has_ended(tmp_path):
    plan, options = plan_of(tmp_path), {"work": stand_in, "executor": Inline()}
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None and holder.stdout.readline() == "held\n"
        with pytest.raises(FolderInUse):
            run(plan, tmp_path, **options)
        holder.kill()
        holder.wait()
    assert run(plan, tmp_path, **options).done == 20
    with locked(tmp_path):
        assert Store(tmp_path).counts() == (20, 20, 0), "it may be read meanwhile"
        with pytest.raises(FolderInUse):
            run(plan, tmp_path, **options)


@pytest.mark.parametrize("changed", ["accuracy = 1e-3", 'until = "detached"'])
def test_a_plan_may_grow_but_not_change_its_numbers(tmp_path, changed):
    store, failed = Store.create(tmp_path, plan_of(tmp_path / "p", cases=3)), {"failure": "refused"}
    for row in ({"name": "x", **failed}, {"name": "x"}, {"name": "x", **failed}):
        store.add([row])  # a result counts more than a failure before or after it
    grown = Store.create(tmp_path, plan_of(tmp_path / "p", cases=5, text="settings.time_limit = 9"))
    assert len(grown.plan().cases) == 5 and [row["name"] for row in grown.results()] == ["x"]
    with pytest.raises(InputError, match=changed.split()[0]):
        Store.create(tmp_path, plan_of(tmp_path / "p", text=f"settings.{changed}"))


def test_a_full_disk_ends_a_run_with_the_reason_and_a_file_that_goes_on(tmp_path):
    plan, folder = plan_of(tmp_path, cases=300), tmp_path / "c"
    run(plan_of(tmp_path / "few", cases=30), folder, work=stand_in, executor=Inline())
    before = told(folder)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(OSError, match=r"study\.db"):
            run(plan, folder, work=stand_in, executor=Inline())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert told(folder)[0][:30] == before[0]
    assert run(plan, folder, work=stand_in, executor=Inline()).done == 300


def test_a_folder_that_may_only_be_read_is_read_and_not_run(tmp_path):
    folder = tmp_path / "c"
    run(plan_of(tmp_path / "few", cases=3), folder, work=stand_in, executor=Inline())
    for path in (*folder.iterdir(), folder):
        path.chmod(path.stat().st_mode & ~0o222)
    try:
        if os.access(folder, os.W_OK):
            pytest.skip("root may write everywhere")
        assert len(told(folder)[0]) == 3
        with pytest.raises(OSError, match="c"):
            run(plan_of(tmp_path, cases=5), folder, work=stand_in, executor=Inline())
        assert merge([folder], tmp_path / "copy").counts() == (3, 3, 0)
    finally:
        folder.chmod(0o755)


def test_a_file_that_is_no_campaign_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError):
        Store(tmp_path / "none")
    with pytest.raises(InputError, match=r"study\.db"):
        Store(tmp_path)
    (tmp_path / "study.db").write_bytes(b"something else" * 1000)
    with pytest.raises(InputError, match="damaged"):
        Store(tmp_path)


TABLE = [
    {"name": "a", "rate": 0.1 + 0.2, "status": "detached", "steps": 7, "trajectory": [0.1, None]},
    {"name": "b", "rate": None, "status": None, "steps": 9, "trajectory": [3.0, 4.0], "late": 1.0},
]


def test_tables_give_the_very_numbers_back(tmp_path):
    export(TABLE, tmp_path / "t.csv")
    first, second = rows_of(tmp_path / "t.csv")
    assert list(first) == "name rate status steps trajectory_01 trajectory_02 late".split()
    assert list(first.values()) == ["a", repr(0.1 + 0.2), "detached", "7", "0.1", "", ""]
    export(TABLE, tmp_path / "t.csv", trajectories=False)
    assert (tmp_path / "t.csv").read_text().splitlines()[2] == "b,,,9,1.0"
    parquet = pytest.importorskip("pyarrow.parquet")
    export(TABLE, tmp_path / "t.parquet")
    assert parquet.read_table(tmp_path / "t.parquet").to_pylist() == [
        {**TABLE[0], "late": None},
        TABLE[1],
    ]


def shards(tmp_path, plan, count=3, work=picky):
    """Run a plan in parts; return their folders."""
    folders = [tmp_path / f"shard-{k}" for k in range(1, count + 1)]
    for k, folder in enumerate(folders, 1):
        run(shard_of(plan, f"{k}/{count}"), folder, work=work, executor=Inline())
    return folders


def test_merged_shards_are_the_whole_campaign(tmp_path):
    plan, inline = plan_of(tmp_path, cases=20), Inline()
    folders = shards(tmp_path, plan)
    run(plan, tmp_path / "whole", work=picky, executor=inline)
    merge([*reversed(folders)], tmp_path / "merged")
    assert told(tmp_path / "merged") == told(tmp_path / "whole")
    # and goes on as one
    inline.done.clear()
    end = run(plan, tmp_path / "merged", work=stand_in, retry=True, executor=inline)
    assert end.done == 20 and len(inline.done) == 4


def test_what_does_not_belong_together_is_not_merged(tmp_path, monkeypatch):
    plan = plan_of(tmp_path, cases=6)
    one, _ = shards(tmp_path, plan, count=2)
    finer = plan_of(tmp_path / "finer", cases=6, text="settings.accuracy = 1e-3")
    run(finer, tmp_path / "d", work=stand_in, executor=Inline())
    with pytest.raises(InputError, match="accuracy"):
        merge([one, tmp_path / "d"], tmp_path / "m")
    monkeypatch.setattr("viscotack.campaign.store.identity", lambda: {"viscotack": "9"})
    run(plan, tmp_path / "newer", work=stand_in, executor=Inline())
    with pytest.raises(InputError, match="another program"):
        merge([one, tmp_path / "newer"], tmp_path / "m")
    with pytest.raises(InputError, match="another `out`"):
        merge([one], one)
