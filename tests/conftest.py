"""Options of the tests."""

from pathlib import Path

from hypothesis import settings

# The same examples in every run, however slow the machine is: the fuzzer draws others.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")


def pytest_addoption(parser):
    parser.addoption(
        "--tack",
        type=Path,
        default=Path("tack-files"),
        help="folder with the raw data of public tack tests, docs/verification.md says which",
    )
