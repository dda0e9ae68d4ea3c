"""A pool of supervised worker processes, used by campaigns and by the page.

A pool runs functions by name, one at a time in each process. It reports progress, enforces time
and memory limits, interrupts cancelled tasks, and replaces processes that crash or exceed a limit.
The caller keeps the queue and decides about retries.

No library does all of this: pebble kills processes on timeout and cancellation, but has no memory
limit, no progress reports and no detection of suspended processes. In concurrent.futures, loky and
joblib a crash breaks the whole pool, and running tasks cannot be ended.
"""

from .event import Event, NoWorker
from .supervisor import Limits, Pool, Setup

__all__ = ["Event", "Limits", "NoWorker", "Pool", "Setup"]
