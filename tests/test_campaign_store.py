import errno
import json
import os
import random
import subprocess
import sys
from dataclasses import replace
from hashlib import sha256

import numpy as np
import pyarrow as pa
import pytest
from scipy.io import loadmat

from campaign_work import finished, plan_of
from processes import POSIX
from viscotack.campaign import CaseSettings, Store, export
from viscotack.campaign.cases import Case, Cases
from viscotack.campaign.parts import Ledger, Part, Parts, parquet, table_of
from viscotack.files.lock import FolderInUse, locked
from viscotack.files.parquet import read_parquet


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


def test_columns_of_parts_need_not_be_equal(tmp_path):
    parts = table_in(tmp_path)
    parts.append([{"name": "a", "x": None, "curve": [1.0, None]}])
    parts.append([{"name": "b", "x": 2.0, "steps": 3, "word": "w"}, {"name": "c", "x": 3}])
    rows = read(parts).to_pylist()
    assert [row["x"] for row in rows] == [None, 2.0, 3.0]
    assert [row["steps"] for row in rows] == [None, 3, None]
    assert rows[0]["curve"] == [1.0, None] and rows[1]["word"] == "w"


def test_many_appends_leave_few_files(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    parts = table_in(tmp_path)
    appended(parts, 4**3 + 4 + 1)
    assert names(parts) == [f"case {i}" for i in range(4**3 + 4 + 1)]
    assert files(parts) == [
        "000001-000064.parquet",
        "000065-000068.parquet",
        "000069-000069.parquet",
    ]


def test_a_large_part_is_not_merged_again(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    monkeypatch.setattr("viscotack.campaign.parts._LARGEST", 10.0)
    parts = table_in(tmp_path)
    appended(parts, 9)
    assert len(files(parts)) == 9 == len(names(parts))


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


@POSIX
def test_old_parts_go_only_when_the_merged_one_is_safe(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    parts, done = table_in(tmp_path), []
    appended(parts, 3)

    def told(name):
        function = getattr(os, name)

        def replacement(*arguments, **options):
            done.append((name, parts.book.ledger.kept, {*os.listdir(tmp_path)}))
            return function(*arguments, **options)

        return replacement

    for name in ("fsync", "link", "unlink"):
        monkeypatch.setattr(os, name, told(name))
    appended(parts, 1, begin=3)
    merged = "000001-000004.parquet"
    linked = [i for i, (name, _, _) in enumerate(done) if name == "link"][-1]
    # the draft is on the disk before it has its name, and the name before anything else
    assert done[linked - 1][0] == "fsync" and done[linked - 1][2] & {merged} == set()
    removals = [i for i, (name, _, there) in enumerate(done) if name == "unlink" and i > linked]
    draft, *old = removals
    assert "fsync" in [name for name, _, _ in done[draft : old[0]]]
    assert len(old) == 4
    for i in old:
        _, kept, there = done[i]
        assert merged in there and [part.name for part in kept] == [merged]


@pytest.mark.parametrize("read", [1, 2, 3])
def test_a_reader_follows_a_merge(tmp_path, monkeypatch, read):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    parts, rows = table_in(tmp_path), [{"name": f"case {i}"} for i in range(12)]
    for begin in (0, 3, 6):
        parts.append(rows[begin : begin + 3])
    tables = parts.tables()
    told = [name for _ in range(read) for name in next(tables).column("name").to_pylist()]
    table_in(tmp_path, parts.book).append(rows[9:])
    assert len(files(parts)) == 1
    # every row once, whatever was read before and in however large a part the others are now
    told += [name for table in tables for name in table.column("name").to_pylist()]
    assert told == [f"case {i}" for i in range(12 if read < 3 else 9)]


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


def test_pages_have_checksums_of_their_own(tmp_path):
    # of a copy in another place nobody has a hash
    rows = [{"name": f"{i}", "rate": 1000.0 + i} for i in range(50)]
    content = bytearray(parquet(lambda: iter([table_of(rows)])).to_pybytes())
    content[len(content) // 3] ^= 4
    file = tmp_path / "a.parquet"
    file.write_bytes(content)
    with pytest.raises(ValueError, match="a.parquet is damaged"):
        read_parquet(file, sha256(content).hexdigest())


@pytest.mark.parametrize(
    "name", ["notes.txt", "000002-000001.parquet", "1-2.parquet", "000001-000001.parquet.bak"]
)
def test_a_part_has_the_name_of_one(name):
    with pytest.raises(ValueError, match=f"{name}' is no name of a part"):
        Part(name, "", 1).span  # noqa: B018
    assert Part("000002-000031.parquet", "", 1).span == (2, 31)


def test_rows_that_were_not_written_are_missed(tmp_path):
    parts = table_in(tmp_path)
    appended(parts, 1)
    (part,) = parts.kept()
    assert parts.checked(part).num_rows == 1
    with pytest.raises(ValueError, match="has 1 rows, 2 were written"):
        parts.checked(Part(part.name, part.sha256, 2))
    (tmp_path / part.name).unlink()
    (tmp_path / part.name).mkdir()
    with pytest.raises(ValueError, match="cannot be read: Is a directory"):
        read(parts)


def test_a_column_is_of_one_type(tmp_path):
    rows = [{"a": True, "b": 1, "c": 1, "d": "w", "e": [1], "f": None}, {"b": 2, "c": 0.5}]
    table = table_of(rows)
    types = [str(field.type) for field in table.schema]
    assert types == ["bool", "int64", "double", "string", "list<item: double>", "null"]
    assert table.to_pylist()[0] == {**rows[0], "c": 1.0, "e": [1.0]}
    kept = pa.parquet.read_table(pa.BufferReader(parquet(lambda: iter([table]))))
    assert kept.equals(table)


def test_a_store_that_has_lost_its_cases_says_so(tmp_path):
    Store.create(tmp_path, plan_of(tmp_path / "p", cases=3))
    (tmp_path / "cases.parquet").unlink()
    with pytest.raises(ValueError, match="has lost its cases.parquet; run again with the plan"):
        Store(tmp_path).plan()
    assert len(Store.create(tmp_path, plan_of(tmp_path / "p", cases=3)).plan().cases) == 3


def test_drafts_are_tidied_away_and_nothing_else(tmp_path):
    store = Store.create(tmp_path, plan_of(tmp_path / "p", cases=3))
    store.add([{"name": "x"}], [])
    strangers = [tmp_path / "notes.txt", tmp_path / "results/.viscotack-1.draft"]
    drafts = [
        tmp_path / ".viscotack-0123abcd.draft",
        tmp_path / "results/.viscotack-0123abcd.draft",
    ]
    for path in (*strangers, *drafts):
        path.write_text("")
    store.tidy()
    assert all(path.exists() for path in strangers) and not any(path.exists() for path in drafts)


def test_many_cases_are_kept_in_several_blocks(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.cases._BLOCK", 3)
    monkeypatch.setattr("viscotack.campaign.store._WRITTEN", 4)
    stated = [Case(f"{i:016x}", {"a": float(i)} | ({"b": 2.0} if i > 4 else {})) for i in range(11)]
    cases = Cases.of(iter(stated))
    assert [*cases] == stated and len(cases) == 11 and cases[3] == stated[3]
    assert [*cases[2:4]] == stated[2:4] and [*cases[np.array([7, 1])]] == [stated[7], stated[1]]
    assert [*Cases.of([*stated[:2], *stated]).first_of_each()] == stated
    wanted = [stated[10].name, "of nobody", stated[0].name]
    assert cases.places(wanted).tolist() == [10, -1, 0]
    assert Cases.of(()).places(wanted).tolist() == [-1] * 3 and not [*Cases.of(())]
    assert cases == Cases.of(stated) and cases != stated
    for other in (stated[1:], [*stated[:-1], Case(stated[-1].name, {"a": 0.0, "b": 2.0})]):
        assert cases != Cases.of(other)
    plan = replace(plan_of(tmp_path / "p"), cases=cases)
    assert Store.create(tmp_path, plan).plan().cases == cases


@pytest.mark.parametrize(
    "name",
    [
        "000001-000001 (copy).parquet",
        "000001-999999.parquet",
        "000003-000003.parquet",
        "000009-000001.parquet",
        "notes.txt",
        "-.parquet",
    ],
)
def test_a_stranger_among_the_parts_is_named_and_left_alone(tmp_path, name):
    parts = table_in(tmp_path)
    appended(parts, 2)
    (tmp_path / name).write_bytes((tmp_path / "000001-000001.parquet").read_bytes())
    assert [path.name for path in parts.strangers()] == [name]
    parts.settle()
    appended(parts, 2, begin=2)
    assert names(parts) == [f"case {i}" for i in range(4)]
    assert (tmp_path / name).exists()


def test_a_stranger_in_the_way_of_a_merge_is_not_written_over(tmp_path, monkeypatch):
    monkeypatch.setattr("viscotack.campaign.parts._MERGED", 4)
    parts = table_in(tmp_path)
    tmp_path.joinpath("000001-000004.parquet").write_text("precious")
    appended(parts, 5)
    assert names(parts) == [f"case {i}" for i in range(5)]
    assert tmp_path.joinpath("000001-000004.parquet").read_text() == "precious"


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


def test_a_file_that_may_not_grow_is_named_too(tmp_path):
    # The bound of the system on a file's size stands for a quota; it holds for a whole process.
    code = (
        "import resource, signal; from pathlib import Path\n"
        "from viscotack.campaign.parts import Ledger, Parts\n"
        "kept = [Ledger()]\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        f"parts = Parts(Path({str(tmp_path)!r}), lambda: kept[-1], kept.append)\n"
        "parts.append([{'name': 'a'}])\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))\n"
        "try:\n    parts.append([{'name': 'b'}])\n"
        "except OSError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "no space left" in done.stdout
    assert len(files(table_in(tmp_path))) == 1


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


def test_an_export_says_what_it_cannot_do(tmp_path):
    with pytest.raises(ValueError, match="ending must be one of .csv"):
        export(table_of(TABLE), tmp_path / "t.xls")
    with pytest.raises(ValueError, match="has no rows"):
        export(pa.table({}), tmp_path / "t.csv")


def test_a_matlab_file_has_an_end(tmp_path, monkeypatch):
    # two rows of four numbers and a list of two
    monkeypatch.setattr("viscotack.campaign.exporting._MOST_MAT", 8 * 2 * (4 + 2))
    export(table_of(TABLE), tmp_path / "t.mat")
    monkeypatch.setattr("viscotack.campaign.exporting._MOST_MAT", 8 * 2 * (4 + 2) - 1)
    with pytest.raises(ValueError, match="2 rows are 0 MB, more than the 0 MB .*--parquet or"):
        export(table_of(TABLE), tmp_path / "u.mat")
    assert not (tmp_path / "u.mat").exists()
