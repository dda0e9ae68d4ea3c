"""The table that the thesis's authors published: a sample of it, or the one that is given."""

from pathlib import Path

import pytest

from research.replication.table import SAMPLE, read_detachments

MOST = 6000


def pytest_addoption(parser):
    """Take the whole table, where it is at hand."""
    parser.addoption("--table", type=Path, default=SAMPLE, help="the published table, a CSV file")


@pytest.fixture(scope="session")
def published(request):
    """Return rows of the published table."""
    return read_detachments(request.config.getoption("--table"))


@pytest.fixture(scope="session")
def sample():
    """Return few rows of the published table, whatever table is given."""
    return read_detachments(SAMPLE)


@pytest.fixture(scope="session")
def whole(published):
    """Return the published table where most of it is at hand: trees learn little from a sample."""
    if len(published) < MOST:
        pytest.skip(f"needs {MOST} rows of the published table, has {len(published)}: --table=PATH")
    return published
