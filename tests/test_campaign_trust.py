"""What others do to a campaign: bits that turn, hands that edit, strangers, second runs."""

import os
import shutil
from pathlib import Path

import pytest

from campaign_work import InlineCrew, employ, picky, plan_of, stand_in
from command_line import exit_status
from viscotack import InputError
from viscotack.campaign import Store, run, verify
from viscotack.files.whole import write_new


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


@pytest.fixture
def study(tmp_path, crew):
    """Return the folder of a finished campaign with results and failures in several parts."""
    run(plan_of(tmp_path, cases=20), tmp_path / "c", work=picky, store_every=0.0)
    return tmp_path / "c"


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


# --- the lock -----------------------------------------------------------------------------------


def test_rows_that_are_stored_twice_are_read_once(tmp_path, crew):
    folder, plan = tmp_path / "c", plan_of(tmp_path, cases=4)
    run(plan, folder, work=stand_in)
    store = Store(folder)
    store.add([{"name": plan.cases[2].name, "rate": 3.0, "pull_off_force": 9.0}], [])
    table = Store(folder).results()
    assert table.num_rows == 4 and table.column("pull_off_force").to_pylist()[2] == 1 / 3
    assert "1 cases are stored more than once" in verify(Store(folder)).wrong[0]


# --- files --------------------------------------------------------------------------------------


def test_a_new_file_never_takes_the_place_of_another(tmp_path):
    path = tmp_path / "a"
    write_new(path, b"one")
    with pytest.raises(OSError, match="cannot write .*a: File exists"):
        write_new(path, b"two")
    assert path.read_bytes() == b"one" and os.listdir(tmp_path) == ["a"]


def test_a_missing_extra_is_said_before_a_folder_is_made(tmp_path, monkeypatch):
    plan = plan_of(tmp_path)
    for module, words in (("distributed", "cluster"), ("pyarrow", "campaign")):
        monkeypatch.setitem(__import__("sys").modules, module, None)
        with pytest.raises(ModuleNotFoundError, match=rf"pip install .*\[{words}\]"):
            run(plan, tmp_path / "c", scheduler="tcp://localhost:1")
        assert not (tmp_path / "c").exists()
