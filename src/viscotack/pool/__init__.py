"""Worker processes under one supervisor, for campaigns and for the page.

A pool runs tasks by name, one at a time in each process. It reports progress, enforces limits of
time and memory, interrupts tasks that are no longer wanted, and replaces processes that crash or
exceed a limit. The queue, retries and blame are the business of the caller.

No library does all of this: pebble kills processes on timeout and cancellation, but has no memory
limit, no progress and no detection of suspended processes. A crash breaks the whole pool of
concurrent.futures, loky and joblib, and they cannot end a task that runs.
"""

from .event import Event, NoWorker
from .supervisor import Limits, Pool, Setup

__all__ = ["Event", "Limits", "NoWorker", "Pool", "Setup"]
