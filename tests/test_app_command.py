"""The command ``viscotack app``: what it needs, where it listens, what it prints."""

import re
import urllib.request
from pathlib import Path

import pytest

from app_server import running
from viscotack.app.cli.page import _token

DOCS = Path(__file__).parents[1] / "docs/api.md"


@pytest.mark.slow
def test_page_and_client_of_the_docs_are_answered(tmp_path, monkeypatch, capsys):
    fences = dict(re.findall(r"```(json|python)\n(.*?)```", DOCS.read_text(), flags=re.S))
    (tmp_path / "case.json").write_text(fences["json"])
    monkeypatch.chdir(tmp_path)
    with running() as (link, _):
        with urllib.request.urlopen(link) as answer:
            assert b"how hard must one pull" in answer.read()
        exec(fences["python"].replace("http://localhost:8642", link.rstrip("/")), {})  # noqa: S102
    assert float(capsys.readouterr().out) == pytest.approx(4.668e-3, rel=0.01)


def test_a_token_is_needed_beyond_this_machine_and_a_short_one_refused(monkeypatch):
    monkeypatch.delenv("VISCOTACK_TOKEN", raising=False)
    assert _token("127.0.0.1") == ""
    assert len(_token("0.0.0.0")) >= 32 and _token("0.0.0.0") != _token("0.0.0.0")
    monkeypatch.setenv("VISCOTACK_TOKEN", "s" * 16)
    assert _token("0.0.0.0") == _token("127.0.0.1") == "s" * 16
    monkeypatch.setenv("VISCOTACK_TOKEN", "short")
    with pytest.raises(ValueError, match="16 characters or more"):
        _token("0.0.0.0")
