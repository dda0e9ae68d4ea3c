"""Options of the tests."""

from pathlib import Path

import pytest
from hypothesis import settings

from processes import Clock
from viscotack.pool import supervisor

# The same examples in every run, however slow the machine is: the fuzzer draws others.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")


# It takes names of the system away from the process that imports it.
collect_ignore = ["without_posix"]


def pytest_addoption(parser):
    parser.addoption(
        "--tack",
        type=Path,
        default=Path("tack-files"),
        help="folder with the raw data of public tack tests, docs/tack_tests.md says which",
    )


@pytest.fixture
def clock(monkeypatch):
    """Return the clock of the limits of a pool; it stands still unless a test moves it."""
    found = Clock()
    monkeypatch.setattr(supervisor, "monotonic", found)
    monkeypatch.setattr(supervisor, "_LONGEST", 1e9)
    return found
