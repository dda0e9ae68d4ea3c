"""What there is, is said: every room is in the list and in the README, and its commands run."""

import csv
import re
import runpy
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn", reason="comes with viscotack[replication]")
pytest.importorskip("xgboost", reason="comes with viscotack[replication]")
pytest.importorskip("pyarrow", reason="comes with viscotack[campaign]")

from research.replication.contents import CONTENTS  # noqa: E402
from viscotack import datasets  # noqa: E402

HOME = Path(__file__).resolve().parents[1]
PAGES = sorted(HOME.rglob("*.md"))
COLUMNS = ("tabor", "modulus_ratio", "exponent", "preload", "rate", "pull_off_force")
# What makes a command of the pages short: small models, few rows.
SHORT = {
    "research.replication.learning": ["--quick"],
    "research.replication.published": ["--count", "3"],
}


def commands(page):
    """Return the `python -m research.replication...` lines of a page."""
    blocks = re.findall(r"```console\n(.*?)```", page.read_text(), re.DOTALL)
    lines = [line.removeprefix("$ ") for line in "".join(blocks).splitlines()]
    return [line for line in lines if line.startswith("python -m research.replication")]


STATED = [commands(page) for page in PAGES]


def run(words):
    """Run a module as `python -m` does and return its exit status."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", words)
        # another test may have imported it, under its own name
        patch.delitem(sys.modules, f"{words[0]}.__main__", raising=False)
        with pytest.raises(SystemExit) as stop:
            runpy.run_module(words[0], run_name="__main__", alter_sys=True)
    return stop.value.code


@pytest.fixture
def anywhere(tmp_path, monkeypatch):
    """Stand in an empty folder beside a table of simulated rows."""
    table = datasets.load("thesis").slice(0, 60).to_pydict()
    with open(tmp_path / "rows.csv", "w", newline="") as file:
        lines = csv.writer(file)
        names = (*COLUMNS, "work_to_pull_off")
        lines.writerow(names)
        lines.writerows(np.array([table[name] for name in names]).T.tolist())
    monkeypatch.chdir(tmp_path)


def test_every_room_with_a_command_is_in_the_list():
    rooms = {f"research.replication.{path.parent.name}" for path in HOME.glob("*/__main__.py")}
    assert {part.room for part in CONTENTS} == rooms


def test_the_list_says_what_each_part_is_and_how_long_it_takes(capsys):
    assert run(["research.replication", "--list"]) == 0
    said = capsys.readouterr().out
    for part in CONTENTS:
        assert part.command in said and part.claim in said and part.time in said


def test_without_a_question_it_says_what_one_may_ask(capsys):
    run(["research.replication"])
    said = capsys.readouterr()
    # newer versions of typer say it where errors go
    assert "--list" in said.out + said.err


def test_the_readme_leads_to_every_room():
    text = (HOME / "README.md").read_text()
    for part in CONTENTS:
        assert f"({part.room.removeprefix('replication.')}/README.md)" in text
        assert f"`python -m {part.room}`" in text


def is_long(command):
    # with options: ten seconds of learning, and the published table from a file
    return command.startswith(
        ("python -m research.replication.learning", "python -m research.replication.published ")
    )


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(command, marks=[pytest.mark.slow] * is_long(command))
        for command in sorted({part.command for part in CONTENTS}.union(*STATED))
        # three minutes, which test_second_code.py takes once
        if command != "python -m research.replication.second_code"
    ],
)
def test_commands_of_the_pages_and_of_the_list_run(command, anywhere):
    words = shlex.split(command)[2:]
    assert run([*words, *SHORT.get(words[0], [])]) == 0
