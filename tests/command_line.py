"""The command line as tests call it."""

import pytest

from viscotack.app.cli import main


def exit_status(arguments):
    """Return the exit status of a command; its words may be anything that has a text."""
    with pytest.raises(SystemExit) as end:
        main([str(word) for word in arguments])
    return end.value.code or 0
