"""Shards of one plan in folders of their own, and one folder of all."""

import pytest

from campaign_work import InlineCrew, employ, picky, plan_of, stand_in, told
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


def test_what_does_not_belong_together_is_not_merged(tmp_path, crew, monkeypatch):
    plan = plan_of(tmp_path, cases=6)
    one, _ = shards(tmp_path, plan, count=2)
    finer = plan_of(tmp_path / "finer", cases=6, text="settings.accuracy = 1e-3")
    run(finer, tmp_path / "d", work=stand_in)
    with pytest.raises(InputError, match="has accuracy = 0.002, .* has 0.001"):
        merge([one, tmp_path / "d"], tmp_path / "m")
    monkeypatch.setattr("viscotack.campaign.store.identity", lambda: {"viscotack": "9"})
    run(plan, tmp_path / "newer", work=stand_in)
    with pytest.raises(InputError, match="run by another program.*viscotack 9 and not"):
        merge([one, tmp_path / "newer"], tmp_path / "m")
    with pytest.raises(InputError, match="holds a campaign already"):
        merge([one], one)
