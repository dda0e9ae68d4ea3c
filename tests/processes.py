"""What tests of processes share: waiting for a state."""

import time

# Longest time to wait for a state [s]; it decides no test, so it may be as long as it wants.
LONG = 120.0


def until(condition, seconds=LONG):
    """Wait for a state; return what was found."""
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "it has not come about"
        time.sleep(0.01)
    return found
