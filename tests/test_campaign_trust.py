"""What others do to a campaign: bits that turn, hands that edit, strangers, second runs."""

import hashlib
import json
import os
import random
import shutil
import socket
import time
from pathlib import Path

import pytest

from campaign_work import InlineCrew, employ, flipped, picky, plan_of, stand_in, told
from command_line import exit_status
from processes import POSIX
from viscotack import InputError
from viscotack.campaign import FolderInUse, Store, Verdict, read_plan, run, verify
from viscotack.campaign.provenance import read_provenance, write_provenance
from viscotack.files import lock
from viscotack.files.lock import locked
from viscotack.files.whole import write_new


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


@pytest.fixture
def study(tmp_path, crew):
    """Return the folder of a finished campaign with results and failures in several parts."""
    run(plan_of(tmp_path, cases=20), tmp_path / "c", work=picky, store_every=0.0)
    return tmp_path / "c"


def test_no_bit_that_turns_is_read_as_other_data(study):
    whole, chance = told(study), random.Random(11)
    seen = set()
    for _ in range(60):
        with flipped(study, chance) as path:
            seen.add(path.name if path.parent == study else path.parent.name)
            try:
                assert told(study) == whole, path
            except InputError as error:
                assert str(path) in str(error) or "provenance" in str(error)
    assert {"results", "failures", "cases.parquet", "provenance.json"} <= seen


def test_what_is_as_it_was_written_is_said_so(study, capsys):
    assert exit_status(["campaign", "verify", study]) == 0
    assert "20 rows in 2" in (out := capsys.readouterr().out) and "complete and unchanged" in out
    assert exit_status(["campaign", "verify", study, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["rows"] == 20 and answer["wrong"] == answer["strange"] == []


def test_what_is_not_as_it_was_written_is_named(study, capsys):
    part = sorted((study / "results").iterdir())[2]
    content = bytearray(part.read_bytes())
    content[len(content) // 2] ^= 1
    part.write_bytes(content)
    (study / "results/000001-999999.parquet").write_bytes(content)
    (study / "plan.toml").write_text("another plan")
    gone = sorted((study / "failures").iterdir())[0]
    gone.unlink()
    assert exit_status(["campaign", "verify", study]) == 1
    out = capsys.readouterr().out
    assert f"wrong: {part} is damaged" in out and "differences found" in out
    assert f"wrong: {study / 'plan.toml'} is not what was written" in out
    assert f"wrong: {gone} is missing: 1 rows" in out
    assert f"not part of this campaign, ignored: {study / 'results/000001-999999.parquet'}" in out


def test_a_part_that_was_removed_is_noted_and_its_cases_run_again(study, crew):
    whole = told(study)
    sorted((study / "results").iterdir())[3].unlink()
    with pytest.raises(InputError, match="is missing: it was stored"):
        Store(study).results()
    crew.done.clear()
    run(None, study, work=picky)
    assert len(crew.done) == 1 and told(study)[0] == whole[0]
    assert "was removed by somebody" in verify(Store(study)).wrong[0]


def edited(folder, change):
    """Edit the provenance as a hand would."""
    path = folder / "provenance.json"
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content, indent=2) + "\n")


def test_settings_that_were_edited_are_refused(study):
    plan = read_plan(study.parent / "plan.toml")

    def finer(content):
        content["settings"]["accuracy"] = 1e-4

    edited(study, finer)
    for use in (lambda: Store(study), lambda: run(plan, study), lambda: run(None, study)):
        with pytest.raises(InputError, match="provenance.json was edited or damaged.*seal"):
            use()
    edited(study, lambda content: content.pop("seal"))
    with pytest.raises(InputError, match="was edited"):
        Store(study)


def test_cases_of_another_campaign_are_refused(study, tmp_path):
    (tmp_path / "d").mkdir()
    Store.create(tmp_path / "d", plan_of(tmp_path / "p", cases=9))
    shutil.copy(tmp_path / "d/cases.parquet", study / "cases.parquet")
    for use in (Store.plan, Store.results, Store.failures):
        with pytest.raises(InputError, match="cases.parquet is damaged: it is not what was writ"):
            use(Store(study))


def test_a_provenance_of_something_else_is_refused(study):
    for change, words in (
        (lambda content: content.update(format="a diary"), "damaged: it is of another kind"),
        (lambda content: content.pop("format"), "damaged: 'format'"),
        (lambda content: content.update(runs=["x" * 60_000_000]), "damaged: it is far too long"),
    ):
        before = (study / "provenance.json").read_bytes()
        edited(study, change)
        with pytest.raises(InputError, match=words):
            Store(study)
        (study / "provenance.json").write_bytes(before)
    assert Store(study).results().num_rows == 16
    (study / "provenance.json").unlink()
    with pytest.raises(InputError, match="holds no campaign"):
        Store(study)


@pytest.mark.parametrize("parts", [{}, {"results": {}}, {"results": {"kept": 1}}, {"results": 3}])
def test_a_ledger_that_is_none_is_refused(study, parts):
    write_provenance(study, {**Store(study).provenance, "parts": parts})
    with pytest.raises(InputError, match="provenance.json is damaged"):
        Store(study).results()


def test_the_inputs_of_every_row_are_those_of_its_case(tmp_path, crew):
    plan = plan_of(tmp_path, cases=4)
    inputs = [case.inputs for case in plan.cases]
    for number, (column, value) in enumerate((("rate", 9.0), ("tabor", None), ("preload", 5.0))):
        folder = tmp_path / str(number)
        folder.mkdir()
        rows = [{"name": case.name, **case.inputs} for case in plan.cases]
        for row in rows[1:] if column != "preload" else ():
            row[column] = value
        rows.append({"name": "of an earlier plan", "rate": 77.0})
        Store.create(folder, plan).add(rows, [])
        wrong = verify(Store(folder)).wrong
        assert len(wrong) == (column != "preload"), wrong
        assert not wrong or f"{column} of a row is not that of its case" in wrong[0]
    # a column that a part has not at all says nothing against it
    (tmp_path / "e").mkdir()
    Store.create(tmp_path / "e", plan).add([{"name": plan.cases[0].name}], [])
    assert not verify(Store(tmp_path / "e")).wrong and inputs[0]["rate"] == 1.0
    Store(tmp_path / "e").add([{"name": plan.cases[1].name, "tabor": None}], [])
    assert "tabor of a row" in verify(Store(tmp_path / "e")).wrong[0]


@pytest.mark.parametrize("version", [0, 1, -1, "2", None, 1.5])
def test_versions_that_never_were_are_refused(study, version):
    edited(study, lambda content: content.update(format_version=version))
    with pytest.raises(InputError, match="damaged"):
        Store(study)


def test_a_file_of_ones_own_that_was_edited_is_refused(tmp_path, crew):
    own = tmp_path / "my.py"
    source = (Path(__file__).parents[1] / "examples/own/rounded_cone.py").read_text()
    own.write_text(source)
    text = 'with = ["my.py"]\n'
    run(plan_of(tmp_path, cases=3, text=text, own=[own]), tmp_path / "c", work=stand_in)
    own.write_text(source + "\n# and more\n")
    with pytest.raises(InputError, match="edited or replaced since.*my.py"):
        run(plan_of(tmp_path, cases=4, text=text, own=[own]), tmp_path / "c", work=stand_in)
    edited_plan = "my.py has been edited since this campaign was planned.*restore the file"
    shutil.rmtree(tmp_path / "c/results")
    with pytest.raises(InputError, match=edited_plan):
        run(None, tmp_path / "c", own=[own], work=stand_in)
    own.write_text(source)
    assert run(None, tmp_path / "c", own=[own], work=stand_in).done == 3
    moved = tmp_path / "moved.py"
    own.rename(moved)
    shutil.rmtree(tmp_path / "c/results")
    assert run(None, tmp_path / "c", own=[moved], work=stand_in).done == 3


def test_a_file_of_ones_own_that_is_edited_during_a_run_spoils_no_row(tmp_path, crew):
    own = tmp_path / "my.py"
    own.write_text((Path(__file__).parents[1] / "examples/own/rounded_cone.py").read_text())

    def edit(now):
        own.write_text("# nothing\n")

    plan = plan_of(tmp_path, cases=12, text='with = ["my.py"]\n', own=[own])
    end = run(plan, tmp_path / "c", work=stand_in, report=edit, store_every=0.0)
    assert end.done < 12 and end.failed == 12 - end.done
    failures = Store(tmp_path / "c").failures()
    assert set(failures.column("failure").to_pylist()) == {"crashed"}
    assert "has been edited since" in failures.column("reason").to_pylist()[0]


def test_a_plan_executes_only_the_files_that_are_permitted(tmp_path, capsys):
    own, ran = tmp_path / "my.py", tmp_path / "ran"
    own.write_text(f"open({str(ran)!r}, 'w')\n")
    (tmp_path / "cases.csv").write_text("tabor,modulus_ratio,exponent,preload,rate\n1,1,1,2,3\n")
    plan = tmp_path / "plan.toml"
    plan.write_text('with = ["my.py"]\n[[list]]\nfile = "cases.csv"\n')
    for command in ("plan", "run"):
        out = ["--out", tmp_path / "c"] if command == "run" else []
        assert exit_status(["campaign", command, plan, *out]) == 2
        assert f"permit it, --with {own}" in capsys.readouterr().err
    assert not ran.exists() and not (tmp_path / "c").exists()


@pytest.fixture
def forged(tmp_path, crew):
    """Return a campaign whose folder names a Python file that leaves a trace, and the trace."""
    own, ran = tmp_path / "my.py", tmp_path / "ran"
    own.write_text((Path(__file__).parents[1] / "examples/own/rounded_cone.py").read_text())
    plan = plan_of(tmp_path, cases=6, text='with = ["my.py"]\n', own=[own])
    run(plan, tmp_path / "c", work=picky)
    own.write_text(f"open({str(ran)!r}, 'w')\n")

    def forge(content):
        content["settings"]["own_sha256"] = [hashlib.sha256(own.read_bytes()).hexdigest()]

    content = read_provenance(tmp_path / "c")
    forge(content)
    write_provenance(tmp_path / "c", content)
    return tmp_path / "c", ran


def test_what_a_folder_names_is_not_executed_when_it_is_looked_at(forged, capsys):
    folder, ran = forged
    out = folder.parent
    commands = [["status", folder], ["verify", folder], ["merge", folder, "--out", out / "m"]]
    commands.append(["export", folder, "--csv", out / "a.csv", "--failures", out / "f.csv"])
    for words in commands:
        assert exit_status(["campaign", *words]) in (0, 1), capsys.readouterr().err
    assert exit_status(["campaign", "run", "--out", folder, "--retry"]) == 2
    assert "my.py, Python that would be executed: permit it" in capsys.readouterr().err
    assert not ran.exists()


@pytest.mark.parametrize(
    "name", ["cases.parquet", "plan.toml", "provenance.json", "results", "failures"]
)
def test_links_in_the_folder_are_not_written_through(tmp_path, crew, name):
    folder, plan = tmp_path / "c", plan_of(tmp_path, cases=3)
    run(plan, folder, work=stand_in)
    place, elsewhere = folder / name, tmp_path / "elsewhere"
    if not place.exists():
        place.mkdir()
    place.rename(elsewhere)
    place.symlink_to(elsewhere)
    stamps = {path: path.stat().st_mtime_ns for path in [elsewhere, *elsewhere.glob("*")]}
    for again in (None, plan_of(tmp_path, cases=4)):
        with pytest.raises(InputError, match=f"{name} is a symbolic link, and a campaign writes"):
            run(again, folder, work=stand_in)
    assert stamps == {path: path.stat().st_mtime_ns for path in [elsewhere, *elsewhere.glob("*")]}


# --- the lock -----------------------------------------------------------------------------------


def test_a_link_in_place_of_the_lock_is_refused_and_its_target_left_alone(tmp_path):
    target = tmp_path / "thesis.txt"
    target.write_text("precious")
    (tmp_path / "c").mkdir()
    (tmp_path / "c/lock").symlink_to(target)
    with pytest.raises(InputError, match="is a link, not a regular file; remove it"):
        run(plan_of(tmp_path), tmp_path / "c")
    assert target.read_text() == "precious"
    (tmp_path / "c/lock").unlink()
    os.mkfifo(tmp_path / "c/lock")
    with pytest.raises(InputError, match="not a regular file"):
        run(plan_of(tmp_path), tmp_path / "c")


def test_a_run_whose_lock_was_removed_writes_no_more(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path)

    def meddle(now):
        if now.done == 5:
            (folder / "lock").unlink()
            # another run, that finds no lock
            assert run(plan, folder, work=stand_in).done == 20

    with pytest.raises(FolderInUse, match="lock was removed while this run held it"):
        run(plan, folder, work=stand_in, report=meddle, store_every=0.0)
    names = Store(folder).results().column("name").to_pylist()
    assert len(names) == len(set(names)) == 20 and not verify(Store(folder)).wrong


def test_rows_that_are_stored_twice_are_read_once(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path, cases=4)
    run(plan, folder, work=stand_in)
    store = Store(folder)
    store.add([{"name": plan.cases[2].name, "rate": 3.0, "pull_off_force": 9.0}], [])
    table = Store(folder).results()
    assert table.num_rows == 4 and table.column("pull_off_force").to_pylist()[2] == 1 / 3
    assert "1 cases are stored more than once" in verify(Store(folder)).wrong[0]


def test_a_case_that_has_failed_again_is_no_fault(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path, cases=6)
    for _ in range(2):
        run(plan, folder, work=picky, retry=True)
    verdict = verify(Store(folder))
    assert verdict.rows == 5 + 2 and not verdict.wrong and Store(folder).failures().num_rows == 1


def test_a_campaign_without_results_is_verified(tmp_path, crew):
    plan = plan_of(tmp_path, cases=2)
    (tmp_path / "c").mkdir()
    Store.create(tmp_path / "c", plan)
    assert verify(Store(tmp_path / "c")) == Verdict(2, 0, (), ())
    failed = {"name": plan.cases[0].name, "failure": "refused", "reason": "no contact"}
    Store(tmp_path / "c").add([], [failed])
    assert verify(Store(tmp_path / "c")) == Verdict(3, 1, (), ())


def test_a_row_of_another_case_is_found(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path, cases=4)
    Store.create((folder.mkdir(), folder)[1], plan)
    Store(folder).add([{"name": plan.cases[2].name, "rate": 4.0}], [])
    assert "rate of a row is not that of its case" in verify(Store(folder)).wrong[0]


def held_by(folder, words, age=0.0):
    """Leave a lock that says who holds it, and when that one was last heard of."""
    path = folder / "lock"
    path.write_text(words)
    os.utime(path, (time.time() - age, time.time() - age))


def test_a_holder_on_another_machine_is_believed_while_it_gives_signs_of_life(tmp_path):
    held_by(tmp_path, "process 7 on elsewhere\n", age=20.0)
    with pytest.raises(FolderInUse, match="in use by process 7 on elsewhere"):
        with locked(tmp_path):
            pass
    held_by(tmp_path, "process 7 on elsewhere\n", age=100.0)
    with locked(tmp_path) as hold:
        os.utime(tmp_path / "lock", (0, 0))
        before = time.time()
        hold.confirm()
        # the clock of files is that of the system in steps of a few milliseconds
        assert (tmp_path / "lock").stat().st_mtime > before - 1
    assert (tmp_path / "lock").read_text() == "", "it was handed back"


def test_where_the_system_has_no_locks_the_words_in_the_file_hold(tmp_path, monkeypatch):
    held_by(tmp_path, f"process {os.getppid()} on {socket.gethostname()}\n")
    with locked(tmp_path):  # with locks of the system that process has none: it has ended
        pass
    held_by(tmp_path, f"process {os.getppid()} on {socket.gethostname()}\n")
    monkeypatch.setattr(lock.system, "lock", lambda handle: True)
    with pytest.raises(FolderInUse, match=f"process {os.getppid()} on"):
        with locked(tmp_path):
            pass
    held_by(tmp_path, f"process 99999999 on {socket.gethostname()}\n")
    with locked(tmp_path):  # there is no such process any more
        pass


# --- files --------------------------------------------------------------------------------------


def test_a_new_file_never_takes_the_place_of_another(tmp_path):
    path = tmp_path / "a"
    write_new(path, b"one")
    with pytest.raises(OSError, match="cannot write .*a: File exists"):
        write_new(path, b"two")
    assert path.read_bytes() == b"one" and os.listdir(tmp_path) == ["a"]


@POSIX
def test_a_new_file_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    done = []
    for name in ("fsync", "link"):
        function = getattr(os, name)

        def told_of(*arguments, name=name, function=function, **options):
            done.append((name, (tmp_path / "a").exists()))
            return function(*arguments, **options)

        monkeypatch.setattr(os, name, told_of)
    write_new(tmp_path / "a", b"one")
    assert done == [("fsync", False), ("link", False), ("fsync", True)]


def test_a_new_file_needs_no_second_name(tmp_path, monkeypatch):
    def refused(*_, **__):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refused)
    write_new(tmp_path / "a", b"one")
    with pytest.raises(OSError, match="File exists"):
        write_new(tmp_path / "a", b"two")
    assert (tmp_path / "a").read_bytes() == b"one"


def test_a_missing_extra_is_said_before_a_folder_is_made(tmp_path, monkeypatch):
    plan = plan_of(tmp_path)
    for module, words in (("distributed", "cluster"), ("pyarrow", "campaign")):
        monkeypatch.setitem(__import__("sys").modules, module, None)
        with pytest.raises(ModuleNotFoundError, match=rf"pip install .*\[{words}\]"):
            run(plan, tmp_path / "c", scheduler="tcp://localhost:1")
        assert not (tmp_path / "c").exists()
