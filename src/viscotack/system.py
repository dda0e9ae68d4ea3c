"""Worker processes: how they begin, what they may use, and how they end."""

import os
import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from typing import Any

# Processes are begun afresh on every system: a fork copies the threads' locks of its parent.
FRESH = get_context("spawn")


class Processes(ProcessPoolExecutor):
    """Processes of this machine as an executor, each with one thread of linear algebra.

    Parameters
    ----------
    workers : int
        Number of processes.
    begin : callable
        Called with `given` at the beginning of each; it calls `begin_worker`.
    given : tuple
        Arguments of `begin`.
    """

    def __init__(self, workers: int, begin: Callable[..., object], given: tuple[Any, ...]) -> None:
        super().__init__(workers, FRESH, initializer=begin, initargs=given)

    def kill(self) -> None:
        """End all processes at once, with their tasks."""
        for process in list((self._processes or {}).values()):
            process.kill()
        self.shutdown(cancel_futures=True)


def begin_worker(memory: float | None = None, nice: int = 0) -> None:
    """Prepare this process, a child, to run tasks; what it needs has been imported before.

    Ctrl-C is left to the parent, with which the process ends.

    Parameters
    ----------
    memory : float, optional
        Memory that may be taken beside that of now [bytes]; more raises MemoryError. On Linux only.
    nice : int
        Added to the nice level.
    """
    from threadpoolctl import threadpool_limits

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    threadpool_limits(1)
    if sys.platform != "win32":
        os.nice(nice)
    if memory is not None and sys.platform == "linux":
        import resource

        import psutil

        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        most = int(psutil.Process().memory_info().vms + memory)
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))


def _end_with_parent() -> None:
    """Wait for the end of the parent, however it ends, and end this process with its task."""
    if (parent := parent_process()) is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
