import errno
import json
import os
import random
import subprocess
import sys

import numpy as np
import pyarrow as pa
import pytest
from scipy.io import loadmat

from campaign_work import finished, plan_of
from viscotack.campaign import CaseSettings, Store, export
from viscotack.campaign.parts import Ledger, Parts, table_of
from viscotack.files.lock import FolderInUse, locked


class Book:
    """Keeps a ledger, as the provenance does; `notes` are all that it was told."""

    def __init__(self, ledger=None):
        self.ledger, self.notes = ledger or Ledger(), []

    def note(self, ledger):
        self.ledger = ledger
        self.notes.append(ledger)


def table_in(folder, book=None):
    """Return a growing table with a ledger of its own."""
    book = book or Book()
    parts = Parts(folder, lambda: book.ledger, book.note)
    parts.book = book
    return parts


def read(parts, columns=None):
    """Read all rows as one table."""
    tables = [pa.table({}), *parts.tables(columns)]
    return pa.concat_tables(tables, promote_options="permissive")


def names(parts):
    return read(parts).column("name").to_pylist()


def appended(parts, count, begin=0):
    for i in range(begin, begin + count):
        parts.append([{"name": f"case {i}", "value": float(i)}])


def files(parts):
    return sorted(path.name for path in parts.folder.iterdir())


def test_rows_come_back_in_the_order_in_which_they_came(tmp_path):
    parts = table_in(tmp_path / "results")
    assert read(parts).num_rows == 0
    parts.append([])
    assert not (tmp_path / "results").exists()
    appended(parts, 5)
    assert names(parts) == [f"case {i}" for i in range(5)]
    assert read(parts, ["value"]).to_pydict() == {"value": [0, 1, 2, 3, 4]}


class Killed(BaseException):
    """A run ends here, with all that it had not done."""


def stopping_after(count, monkeypatch, parts):
    """Let the process end at the change number `count`, of those to files and to the ledger."""
    left = [count]

    def counted(function):
        def replacement(*arguments, **options):
            left[0] -= 1
            if left[0] < 0:
                raise Killed
            return function(*arguments, **options)

        return replacement

    for name in ("fsync", "link", "rename", "replace", "unlink"):
        monkeypatch.setattr(os, name, counted(getattr(os, name)))
    monkeypatch.setattr(parts.book, "note", counted(parts.book.note))
    monkeypatch.setattr(parts, "_note", parts.book.note)


def test_a_kill_at_any_instant_of_a_merge_changes_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    for instant in range(40):
        folder = tmp_path / str(instant)
        parts = table_in(folder)
        appended(parts, 3)
        with monkeypatch.context() as patch:
            stopping_after(instant, patch, parts)
            try:
                appended(parts, 1, begin=3)
                ended = True
            except Killed:
                ended = False
        # the row that was on its way is stored, or is not; all others are there, once
        found = names(table_in(folder, parts.book))
        assert found in ([f"case {i}" for i in range(3)], [f"case {i}" for i in range(4)])
        again = table_in(folder, parts.book)
        again.settle()
        appended(again, 5 - len(found), begin=len(found))
        assert names(again) == [f"case {i}" for i in range(5)]
        assert files(again) == ["000001-000004.parquet", "000005-000005.parquet"]
        assert not again.strangers()
        if ended:
            break
    assert ended and instant > 8


def test_a_damaged_part_is_named(tmp_path):
    parts = table_in(tmp_path)
    appended(parts, 2)
    path = tmp_path / "000002-000002.parquet"
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(ValueError, match="000002-000002.parquet is damaged.*run the campaign"):
        read(parts)
    parts.settle()
    path.unlink()
    with pytest.raises(ValueError, match="000002-000002.parquet is missing.*run the campaign"):
        read(parts)
    assert [part.name for part in parts.forget_missing()] == [path.name]
    assert names(parts) == ["case 0"]


def test_a_full_disk_is_named_and_leaves_the_table_as_it_was(tmp_path, monkeypatch):
    parts = table_in(tmp_path)
    appended(parts, 3)

    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(OSError, match="no space left for .*free space and repeat"):
            appended(parts, 1, begin=3)
    assert len(files(parts)) == 3 and names(parts) == [f"case {i}" for i in range(3)]
    appended(parts, 1, begin=3)
    assert names(parts) == [f"case {i}" for i in range(4)]


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


def test_a_store_keeps_its_plan(tmp_path):
    plan = plan_of(tmp_path / "a", text="settings.accuracy = 1e-3")
    store = Store.create(tmp_path / "a", plan)
    again = Store(tmp_path / "a").plan()
    assert again.cases == plan.cases and again.settings == plan.settings
    assert again.kind is plan.kind
    assert [again.problem(case) for case in again.cases] == [plan.problem(c) for c in plan.cases]
    assert (tmp_path / "a/plan.toml").read_text() == plan.source
    assert store.settings == CaseSettings(accuracy=1e-3)


def test_a_problem_in_si_is_stored_whole(tmp_path):
    from test_campaign_plan import LENS, written
    from viscotack.campaign import read_plan

    written(tmp_path, LENS, "lens.toml")
    text = 'problem = "lens.toml"\n[[grid]]\nprotocol.speed = [1e-6, 1e-4]\n'
    plan = read_plan(written(tmp_path, text))
    Store.create(tmp_path, plan)
    (tmp_path / "lens.toml").unlink()
    again = Store(tmp_path).plan()
    assert [again.problem(case) for case in again.cases] == [plan.problem(c) for c in plan.cases]


def test_a_plan_may_grow_but_not_change_its_accuracy(tmp_path):
    Store.create(tmp_path, plan_of(tmp_path / "p", cases=3)).add([{"name": "x"}], [])
    grown = Store.create(tmp_path, plan_of(tmp_path / "p", cases=5, text="settings.time_limit = 9"))
    assert len(grown.plan().cases) == 5 and finished(grown) == ({"x"}, {})
    with pytest.raises(ValueError, match=r"accuracy = 0.002, the plan asks for 0.001; .*--out"):
        Store.create(tmp_path, plan_of(tmp_path / "p", text="settings.accuracy = 1e-3"))
    with pytest.raises(ValueError, match=r"until = pull-off, the plan asks for detached; .*--out"):
        Store.create(tmp_path, plan_of(tmp_path / "p", text='settings.until = "detached"'))


def test_rows_that_are_too_many_to_be_held_are_sorted_on_the_disk(tmp_path, monkeypatch):
    plan = plan_of(tmp_path, cases=23)
    store = Store.create(tmp_path, plan)
    rows = [{"name": c.name, "rate": c.inputs["rate"], "curve": [1.0] * 3} for c in plan.cases]
    random.Random(3).shuffle(rows)
    for begin in range(0, 20, 5):
        store.add(rows[begin : begin + 5], [])
    store.add([{"name": "of an earlier plan", "word": "w", "curve": [2.0] * 7}], [])
    whole = store.results()
    monkeypatch.setattr("viscotack.campaign.ordering._HELD", 4)
    with store.ordered_results() as ordered:
        chunks = [*ordered.chunks()]
        assert (ordered.rows, ordered.widths) == (21, {"curve": 7})
    assert [len(chunk) for chunk in chunks] == [4, 4, 4, 4, 4, 1]
    assert pa.concat_tables(chunks).equals(whole)
    stated = [c.name for c in plan.cases if c.name in {row["name"] for row in rows[:20]}]
    assert whole.column("name").to_pylist() == [*stated, "of an earlier plan"]


def test_failures_never_enter_the_results(tmp_path):
    plan = plan_of(tmp_path, cases=4)
    store = Store.create(tmp_path, plan)
    a, b, c, d = (case.name for case in plan.cases)
    failed = {"failure": "refused", "reason": "no contact"}
    store.add([{"name": c, "x": 3.0}, {"name": a, "x": 1.0}], [{"name": b} | failed])
    store.add([], [{"name": d} | failed, {"name": b} | failed | {"reason": "still none"}])
    assert store.results().column("name").to_pylist() == [a, c]
    assert store.failures().column("name").to_pylist() == [b, d]
    assert store.failures().column("reason").to_pylist()[0] == "still none"
    store.add([{"name": b, "x": 2.0}], [])
    assert store.results().column("x").to_pylist() == [1, 2, 3]
    assert finished(store) == ({a, b, c}, {d: "refused"})
    assert store.failures().column("name").to_pylist() == [d]


def test_what_is_not_a_campaign_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError):
        Store(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="holds no campaign"):
        Store(tmp_path)
    (tmp_path / "provenance.json").write_text('{"format": "visc')
    with pytest.raises(ValueError, match=r"provenance.json is damaged"):
        Store(tmp_path)
    newer = {"format": "viscotack campaign", "format_version": 3}
    (tmp_path / "provenance.json").write_text(json.dumps(newer))
    with pytest.raises(ValueError, match="newer version"):
        Store(tmp_path)


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


def test_a_matlab_file_has_a_variable_per_column(tmp_path):
    table = table_of([{"protocol.speed": 1e-6} | row for row in TABLE])
    export(table, tmp_path / "t.mat")
    found = loadmat(tmp_path / "t.mat")
    assert found["protocol_speed"].tolist() == [[1e-6], [1e-6]]
    assert found["trajectory"].shape == (2, 2) and np.isnan(found["trajectory"][0, 1])
    assert np.isnan(found["rate"][1, 0]) and found["status"][0, 0][0] == "detached"


def test_a_parquet_file_is_the_table(tmp_path):
    export(table_of(TABLE), tmp_path / "t.parquet")
    assert pa.parquet.read_table(tmp_path / "t.parquet").to_pylist() == TABLE
