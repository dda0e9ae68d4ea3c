"""Tasks for the workers of a pool."""

import ctypes
import os
import time
from pathlib import Path


def prepare(given):
    return given


def echo(asked, tell, context):
    return {"asked": asked, "context": context, "process": os.getpid()}


def report(asked, tell, context):
    for share in asked:
        tell(share)
    return "over"


def loop(asked, tell, context):
    """Report for ever, in Python; tell of its beginning by a file."""
    Path(asked).touch()
    while True:
        tell("x" * 100_000)


def spin(asked, tell, context):
    """Compute for ever, in Python."""
    Path(asked).touch()
    while True:
        time.sleep(1e-3)


def hang(asked, tell, context):
    """Wait in C and let no other thread of the process do anything."""
    Path(asked).touch()
    ctypes.PyDLL(None).sleep(1000)


def die(asked, tell, context):
    os._exit(3)
