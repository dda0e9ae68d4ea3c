"""What others do to a campaign: bits that turn, hands that edit, strangers, second runs."""

import shutil
from pathlib import Path

import pytest

from campaign_work import InlineCrew, employ, plan_of, stand_in
from viscotack import InputError
from viscotack.campaign import run


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


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


# --- the lock -----------------------------------------------------------------------------------


# --- files --------------------------------------------------------------------------------------
