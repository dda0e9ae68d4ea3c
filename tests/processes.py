"""What tests of processes share: waiting for a state, and who is there."""

import time
from pathlib import Path

# Longest time to wait for a state [s]; it decides no test, so it may be as long as it wants.
LONG = 120.0


def until(condition, seconds=LONG):
    """Wait for a state; return what was found."""
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "it has not come about"
        time.sleep(0.01)
    return found


def state(process):
    """Return the letter that the system has for a process; "" where there is none."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return ""


def children(process):
    """Return the processes that a process has started."""
    found = Path(f"/proc/{process}/task").glob("*/children")
    return [int(word) for path in found for word in path.read_text().split()]
