"""The command ``viscotack app``: what it needs, where it listens, what it prints."""

import builtins
import os
import re
import signal
import socket
import sys
import urllib.request
from pathlib import Path

import pytest

from app_server import running
from command_line import exit_status
from processes import children, lives, until
from viscotack.app.cli.page import _listening, _query, _token
from viscotack.errors import install_command

DOCS = Path(__file__).parents[1] / "docs/api.md"


def test_an_answer_does_not_wait_for_the_confirmation_of_its_head():
    with _listening("127.0.0.1", 0) as listening:
        assert listening.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)


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


def test_a_case_file_is_in_the_link_that_is_opened():
    query = _query(Path("examples/from_toml/cone.toml"), ())
    assert "cone.slope=0.05" in query


def test_a_missing_library_is_said_in_words(monkeypatch, capsys):
    real = builtins.__import__

    def without(name, *more):
        if name in ("uvicorn", "fastapi"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return real(name, *more)

    monkeypatch.setattr(builtins, "__import__", without)
    assert exit_status(["app", "--no-browser"]) == 2
    said = capsys.readouterr().err
    assert f"need uvicorn; install it with: {install_command('app')}" in " ".join(said.split())


def test_a_port_that_is_taken_is_said_in_words(capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert exit_status(["app", "--no-browser", "--port", port]) == 2
    assert f"cannot listen at 127.0.0.1, port {port}" in capsys.readouterr().err


def test_a_file_that_states_no_case_is_refused_before_anything_is_served(tmp_path, capsys):
    file = tmp_path / "case.toml"
    file.write_text("[material]\nmodel = 'elastic'\n")
    assert exit_status(["app", "--no-browser", file]) == 2
    assert "are missing; see docs/input.md" in capsys.readouterr().err


def test_a_material_in_a_file_of_its_own_goes_into_the_link(tmp_path):
    (tmp_path / "series.csv").write_text("modulus_ratio,relaxation_time_s\n5.0,0.001\n")
    (tmp_path / "case.toml").write_text(
        "[material]\nmodel = 'prony'\nrubbery_modulus = '1 MPa'\npoisson_ratio = 0.5\n"
        "file = 'series.csv'\n[interface]\nlaw = 'lennard-jones'\n"
        "work_of_adhesion = '50 mJ/m^2'\nequilibrium_gap = '1 um'\n[sphere]\nradius = '1 mm'\n"
        "[protocol]\npreload_depth = '1 um'\nspeed = '10 um/s'\n"
    )
    from viscotack.operations.declare.state import state_of_query
    from viscotack.problem.case_file import read_case

    query = _query(tmp_path / "case.toml", ())
    assert state_of_query(query).problem == read_case(tmp_path / "case.toml")


def test_a_token_is_needed_beyond_this_machine_and_a_short_one_refused(monkeypatch):
    monkeypatch.delenv("VISCOTACK_TOKEN", raising=False)
    assert _token("127.0.0.1") == ""
    assert len(_token("0.0.0.0")) >= 32 and _token("0.0.0.0") != _token("0.0.0.0")
    monkeypatch.setenv("VISCOTACK_TOKEN", "s" * 16)
    assert _token("0.0.0.0") == _token("127.0.0.1") == "s" * 16
    monkeypatch.setenv("VISCOTACK_TOKEN", "short")
    with pytest.raises(ValueError, match="16 characters or more"):
        _token("0.0.0.0")


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells of other processes")
def test_the_workers_end_with_a_server_that_is_killed():
    with running() as (_, server):
        workers = until(lambda: children(server))
        os.kill(server, signal.SIGKILL)
        until(lambda: not any(map(lives, workers)))
