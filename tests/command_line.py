"""The command line as tests call it."""

import csv
import json
import shlex
from pathlib import Path

import pytest

from viscotack.app.cli import main


def exit_status(arguments):
    """Return the exit status of a line, or of words that may be anything that has a text."""
    words = shlex.split(arguments) if isinstance(arguments, str) else map(str, arguments)
    with pytest.raises(SystemExit) as end:
        main(list(words))
    return end.value.code or 0


def refused(arguments, capsys):
    """Return the words of a refused command, which has written nothing to standard output."""
    assert exit_status(arguments) == 2
    out, err = capsys.readouterr()
    assert out == "" and "Traceback" not in err
    return err


def answered(arguments, capsys):
    """Return the one JSON object that a command prints."""
    assert exit_status([*arguments, "--json"]) == 0, capsys.readouterr().err
    return json.loads(capsys.readouterr().out)


def rows_of(path):
    """Return the rows of a table that a command has written, each by its headings."""
    with Path(path).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
