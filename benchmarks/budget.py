"""Pytest plugin of `mutants.py`: fast tests first, and limits in processor time.

Processor time, unlike wall time, does not depend on what else the machine does.
"""

import os
import signal

# Processor time after which a test is taken to hang, without and with the marker `slow` [s].
LIMIT, LIMIT_IF_SLOW = 90.0, 900.0


def pytest_addoption(parser):
    """Add the option by which `mutants.py` sets the budget."""
    parser.addoption("--budget", type=float, help="start no test after this processor time [s]")


def pytest_collection_modifyitems(items):
    """Put tests that are marked slow last."""
    items.sort(key=slow)


def pytest_runtest_protocol(item):
    """Skip a test after the budget is spent; else let it run up to its limit."""
    if sum(os.times()[:4]) > item.config.getoption("budget"):
        return True
    # no handler: at the limit the signal ends the process, whatever the test catches
    signal.setitimer(signal.ITIMER_PROF, LIMIT_IF_SLOW if slow(item) else LIMIT)
    return None


def slow(item):
    """Whether a test is marked slow."""
    return item.get_closest_marker("slow") is not None
