"""Options of the tests."""

from pathlib import Path


def pytest_addoption(parser):
    parser.addoption(
        "--tack",
        type=Path,
        default=Path("tack-files"),
        help="folder with the raw data of public tack tests, docs/tack_tests.md says which",
    )
