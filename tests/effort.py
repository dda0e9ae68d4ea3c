"""The effort of a call, counted: the same on every machine and beside any load."""

import sys


def calls(function):
    """Return how many functions, of Python and of C, a call of a function calls in turn."""
    count = 0

    def one(_, event, __):
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(one)
    try:
        function()
    finally:
        sys.setprofile(before)
    return count
