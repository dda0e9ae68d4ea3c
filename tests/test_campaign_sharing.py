"""Shards of one plan in folders of their own, and one folder of all."""

import json

import pytest

from campaign_work import InlineCrew, employ, picky, plan_of, stand_in, told
from command_line import exit_status
from viscotack import InputError
from viscotack.campaign import Store, merge, run, shard_of, verify


@pytest.fixture
def crew(monkeypatch):
    return employ(monkeypatch, InlineCrew())


def shards(tmp_path, plan, count=3, work=picky):
    """Run a plan in parts; return their folders."""
    folders = [tmp_path / f"shard-{k}" for k in range(1, count + 1)]
    for k, folder in enumerate(folders, 1):
        run(shard_of(plan, f"{k}/{count}"), folder, work=work, store_every=0.0)
    return folders


def test_shards_have_all_cases_of_a_plan_each_once(tmp_path):
    plan = plan_of(tmp_path, cases=20)
    parts = [shard_of(plan, f"{k}/3") for k in (1, 2, 3)]
    assert [len(part.cases) for part in parts] == [7, 7, 6]
    assert {case.name for part in parts for case in part.cases} == {c.name for c in plan.cases}
    assert [part.cases[0].inputs["rate"] for part in parts] == [1.0, 2.0, 3.0]


def test_merged_shards_are_the_whole_campaign(tmp_path, crew):
    plan = plan_of(tmp_path, cases=20)
    folders = shards(tmp_path, plan)
    run(plan, tmp_path / "whole", work=picky)
    merge(reversed(folders), tmp_path / "merged")
    assert told(tmp_path / "merged") == told(tmp_path / "whole")
    assert not verify(Store(tmp_path / "merged")).wrong
    # and goes on as one
    crew.done.clear()
    assert run(plan, tmp_path / "merged", work=stand_in, retry=True).done == 20
    assert len(crew.done) == 4


def test_a_shard_stays_one(tmp_path, crew):
    plan = plan_of(tmp_path, cases=6)
    run(shard_of(plan, "1/2"), tmp_path / "c", work=stand_in)
    assert run(None, tmp_path / "c", work=stand_in).cases == 3
    with pytest.raises(InputError, match="holds shard 1/2, and this is shard 2/2"):
        run(shard_of(plan, "2/2"), tmp_path / "c", work=stand_in)
    with pytest.raises(InputError, match="and this is a whole plan"):
        run(plan, tmp_path / "c", work=stand_in)


def test_what_does_not_belong_together_is_not_merged(tmp_path, crew, monkeypatch):
    plan = plan_of(tmp_path, cases=6)
    one, two = shards(tmp_path, plan, count=2)
    finer = plan_of(tmp_path / "finer", cases=6, text="settings.accuracy = 1e-3")
    run(finer, tmp_path / "d", work=stand_in)
    with pytest.raises(InputError, match="has accuracy = 0.002, .* has 0.001"):
        merge([one, tmp_path / "d"], tmp_path / "m")
    monkeypatch.setattr("viscotack.campaign.store.identity", lambda: {"viscotack": "9"})
    run(plan, tmp_path / "newer", work=stand_in)
    with pytest.raises(InputError, match="run by another program.*viscotack 9 and not"):
        merge([one, tmp_path / "newer"], tmp_path / "m")
    part = next((two / "results").iterdir())
    part.write_bytes(part.read_bytes()[:-1])
    with pytest.raises(InputError, match="is not merged: .*damaged"):
        merge([one, two], tmp_path / "m")
    with pytest.raises(InputError, match="nothing to merge"):
        merge([], tmp_path / "m")
    assert not (tmp_path / "m").exists()
    with pytest.raises(InputError, match="holds a campaign already"):
        merge([one], one)


def test_a_result_of_one_folder_stands_before_the_failure_of_another(tmp_path, crew):
    plan = plan_of(tmp_path, cases=10)
    run(plan, tmp_path / "a", work=picky)
    run(plan, tmp_path / "b", work=stand_in)
    store = merge([tmp_path / "a", tmp_path / "b"], tmp_path / "m")
    assert store.results().num_rows == 10 and store.failures().num_rows == 0
    assert [run["folder"] for run in store.provenance["runs"]] == [
        str(tmp_path / "a"),
        str(tmp_path / "b"),
    ]


class Killed(BaseException):
    """The process ends here."""


def test_a_merge_that_was_killed_goes_on(tmp_path, crew, monkeypatch):
    folders, out = shards(tmp_path, plan_of(tmp_path, cases=20)), tmp_path / "m"
    whole = told(merge(folders, tmp_path / "undisturbed").folder)
    add, left = Store.add, []

    def kill(*arguments):
        if not left:
            raise Killed
        left.pop()
        add(*arguments)

    monkeypatch.setattr(Store, "add", kill)
    for survived in (0, 1, 2, 3, 4):
        left += [True] * survived
        with pytest.raises(Killed):
            merge(folders, out)
        # what is there by then is not taken for all of it
        with pytest.raises(InputError, match="holds a merge of .*shard-1, .* that has not ended"):
            run(None, out, work=stand_in)
        with pytest.raises(InputError, match="that has not ended"):
            run(plan_of(tmp_path), out, work=stand_in)
        assert "a merge that has not ended" in verify(Store(out)).wrong[0]
        with pytest.raises(InputError, match="give the same folders in the same order"):
            merge(folders[:2], out)
    left += [True] * 99
    merge(folders, out)
    assert told(out) == whole and not verify(Store(out)).wrong
    with pytest.raises(InputError, match="holds a campaign already"):
        merge(folders, out)


def test_the_commands_share_and_merge(tmp_path, crew, capsys):
    plan_of(tmp_path, cases=4, text='settings.accuracy = 0.02\nsettings.until = "pull-off"')
    for k in (1, 2):
        words = ["run", tmp_path / "plan.toml", "--out", tmp_path / f"s{k}", "--shard", f"{k}/2"]
        assert exit_status(["campaign", *words]) == 0
    folders = [tmp_path / "s1", tmp_path / "s2"]
    assert exit_status(["campaign", "merge", *folders, "--out", tmp_path / "m"]) == 0
    capsys.readouterr()
    assert exit_status(["campaign", "status", tmp_path / "m", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["done"] == 4
    assert exit_status(["campaign", "merge", *folders]) == 2
    assert exit_status(["campaign", "run", "--out", tmp_path / "s1", "--shard", "1/2"]) == 2
    words = ["run", tmp_path / "plan.toml", "--out", tmp_path / "x", "--tls-ca", tmp_path / "no"]
    assert exit_status(["campaign", *words]) == 2
    assert "TLS needs three files" in capsys.readouterr().err
