"""The table that the thesis's authors published: a sample of it, or the one that is given."""

from pathlib import Path

import pytest

from replication.table import read_detachments

SAMPLE = Path(__file__).resolve().parents[2] / "tests/data/sphere_bem_published/rows.csv"
MOST = 6000


def pytest_addoption(parser):
    """Take the whole table, where it is at hand."""
    parser.addoption("--table", type=Path, default=SAMPLE, help="the published table, a CSV file")


@pytest.fixture(scope="session")
def published(request):
    """Return rows of the published table."""
    path = request.config.getoption("--table")
    if not path.exists():
        pytest.skip(f"there is no published table at {path}; give it with --table=PATH")
    return read_detachments(path)


@pytest.fixture(scope="session")
def whole(published):
    """Return the published table where most of it is at hand: trees learn little from a sample."""
    if len(published) < MOST:
        pytest.skip(f"needs {MOST} rows of the published table, has {len(published)}: --table=PATH")
    return published
