"""Pytest plugin: processor time of each test, its processes included, as lines of JSON.

`PYTHONPATH=benchmarks python -m pytest -p costs_of_tests --costs FILE -m slow`. Unlike
`--durations`, the figures hold on a busy machine. A test that has a line in the file is skipped, so
that a run may be stopped. `python benchmarks/costs_of_tests.py FILE` prints sums by file of tests
and the dearest tests.
"""

import json
import os
import sys
from collections import Counter
from pathlib import Path

DEAREST = 40


def pytest_addoption(parser):
    """Add the option that names the file."""
    parser.addoption("--costs", type=Path, required=True, help="file of processor times")


def pytest_collection_modifyitems(config, items):
    """Leave out the tests that have been measured."""
    known = {test for test, _ in read(config.getoption("--costs"))}
    items[:] = [item for item in items if item.nodeid not in known]


def pytest_runtest_protocol(item, nextitem):
    """Run a test and note what it took, its fixtures included."""
    from _pytest.runner import runtestprotocol

    began = sum(os.times()[:4])
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    runtestprotocol(item, nextitem=nextitem)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    with item.config.getoption("--costs").open("a", encoding="utf-8") as file:
        file.write(json.dumps([item.nodeid, round(sum(os.times()[:4]) - began, 3)]) + "\n")
    return True


def read(path):
    """Return the tests of a file and their processor times [s]."""
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()]


def main():
    """Print the sums."""
    found = read(Path(sys.argv[1]))
    files = Counter()
    for test, seconds in found:
        files[test.partition("::")[0]] += seconds
    print(f"{sum(files.values()):.0f} s of processor time in {len(found)} tests")
    for name, seconds in files.most_common(DEAREST):
        print(f"{seconds:8.1f} s  {name}")
    for test, seconds in sorted(found, key=lambda each: -each[1])[:DEAREST]:
        print(f"{seconds:8.1f} s  {test}")


if __name__ == "__main__":
    main()
