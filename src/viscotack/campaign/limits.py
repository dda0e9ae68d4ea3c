"""Bounds on the time and the memory of one case, kept by a watch beside it.

A watch works in any thread, so that it serves the processes of this machine and the threads of a
cluster's worker alike; a signal would reach the main thread only.
"""

import ctypes
import os
from threading import Event, Lock, Thread, get_ident
from time import perf_counter
from types import TracebackType

# Seconds between two looks: a case may be late by as much.
_LOOK = 0.05
_STATM, _STATUS = "/proc/self/statm", "/proc/self/status"


class LimitExceeded(BaseException):
    """A case has met a limit; no error, so that nothing on its way can take it for one of its own.

    It is raised by a :class:`Watch` inside the watched block, between two instructions of Python.
    """


class Watch:
    """Ends the block within by LimitExceeded when it takes too long or too much memory.

    Parameters
    ----------
    seconds : float
        Longest time of the block [s].
    memory : float
        Most resident memory that the process may gain during the block [bytes]. Only Linux tells;
        elsewhere there is no bound.

    Attributes
    ----------
    kind, reason : str
        Which limit was met, "time limit" or "memory limit", and a sentence; "" while none was.

    Examples
    --------
    >>> watch = Watch(seconds=0.1, memory=1e9)
    >>> try:
    ...     with watch:
    ...         while True:
    ...             pass
    ... except LimitExceeded:
    ...     print(watch.kind)
    time limit
    """

    def __init__(self, *, seconds: float, memory: float) -> None:
        self.seconds, self.memory = seconds, memory
        self.kind = self.reason = ""
        self._ended, self._lock = Event(), Lock()

    def __enter__(self) -> "Watch":
        self._thread, self._began, self._base = get_ident(), perf_counter(), resident_memory()
        self._watcher = Thread(target=self._look, daemon=True)
        self._watcher.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        with self._lock:
            self._ended.set()
        # One that was raised in the last moment and has not arrived is taken back.
        _raise_in(self._thread, None)
        self._watcher.join()

    def _look(self) -> None:
        while not self._ended.wait(min(_LOOK, self.seconds)):
            gained = resident_memory() - self._base
            if perf_counter() - self._began > self.seconds:
                self.kind, self.reason = "time limit", f"took more than {self.seconds:g} s"
            elif gained > self.memory:
                self.kind = "memory limit"
                self.reason = f"took {gained / 1e6:.0f} MB, more than {self.memory / 1e6:g} MB"
            if self.kind:
                with self._lock:
                    if not self._ended.is_set():
                        _raise_in(self._thread, LimitExceeded)
                return


def resident_memory() -> float:
    """Return the resident memory of this process [bytes]; 0 where the system does not tell."""
    try:
        with open(_STATM) as file:
            return int(file.read().split()[1]) * float(os.sysconf("SC_PAGE_SIZE"))
    except (OSError, ValueError):
        return 0.0


def peak_memory() -> float:
    """Return the largest resident memory that this process has had [bytes]; 0 where unknown."""
    try:
        with open(_STATUS) as file:
            peak = next(line for line in file if line.startswith("VmHWM:"))
        return 1024.0 * int(peak.split()[1])
    except (OSError, StopIteration):
        return 0.0


def _raise_in(thread: int, exception: type[BaseException] | None) -> None:
    """Raise in another thread; None takes back what has not arrived."""
    what = None if exception is None else ctypes.py_object(exception)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), what)
