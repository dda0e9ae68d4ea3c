"""What operating systems differ in: file locks, links, signals, inherited sockets, memory.

Other modules use these functions and are the same on Linux, macOS and Windows.
"""

import os
import signal
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from viscotack.errors import InputError

# Flags of os.open: do not follow a link or wait for a pipe; Windows has neither, but text modes.
_ITSELF = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_INTERRUPTS = signal.SIGINT, signal.SIGTERM

if sys.platform == "win32":
    import _thread
    import msvcrt

    # Windows forbids others to read locked bytes, so the lock is one byte far beyond the text.
    _LOCKED = 1 << 30

    def lock(handle: int) -> bool:
        """Lock an open file for this process, without waiting; return whether it was free."""
        os.lseek(handle, _LOCKED, os.SEEK_SET)
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except PermissionError:
            return False
        except OSError:  # the file system has no locks
            pass
        return True

    @contextmanager
    def without_interrupts() -> Iterator[None]:
        """Let processes that start inside the block ignore ctrl-C; `child_options` does it."""
        yield

    def child_options(handle: int) -> Any:
        """Return the options of `subprocess.Popen` for a child that inherits a socket."""
        os.set_handle_inheritable(handle, True)
        return {"close_fds": False, "creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}

    def serve_interrupts(handler: Callable[..., Any]) -> None:
        """Ignore ctrl-C in a worker, except `interrupt`, which calls the handler."""
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        signal.signal(signal.SIGINT, handler)

    def interrupt() -> None:
        """Call the handler of `serve_interrupts` in the main thread, from any thread."""
        _thread.interrupt_main()

    def bound_memory(most: int) -> None:
        """Limit the address space of this process [bytes], where the system can."""

    def lower_priority(steps: int) -> None:
        """Lower the priority of this process by a number of steps of `nice`."""
        if steps:
            import psutil

            psutil.Process().nice(psutil.BELOW_NORMAL_PRIORITY_CLASS)

    def peak_memory() -> float:
        """Return the peak resident memory of this process [bytes]."""
        import psutil

        memory = psutil.Process().memory_info()
        return float(getattr(memory, "peak_wset", memory.rss))

else:
    # fcntl and resource are imported where they are used: Pyodide has neither.

    def lock(handle: int) -> bool:
        """Lock an open file for this process, without waiting; return whether it was free."""
        import fcntl

        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:  # the file system has no locks
            pass
        return True

    @contextmanager
    def without_interrupts() -> Iterator[None]:
        """Let processes that start inside the block inherit blocked signals, and ignore ctrl-C."""
        before = signal.pthread_sigmask(signal.SIG_BLOCK, _INTERRUPTS)
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def child_options(handle: int) -> Any:
        """Return the options of `subprocess.Popen` for a child that inherits a socket."""
        return {"pass_fds": [handle]}

    def serve_interrupts(handler: Callable[..., Any]) -> None:
        """Ignore ctrl-C in a worker; `interrupt` calls the handler."""
        for number in _INTERRUPTS:
            signal.signal(number, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _INTERRUPTS)
        signal.signal(signal.SIGUSR1, handler)

    def interrupt() -> None:
        """Call the handler of `serve_interrupts` in the main thread, from any thread."""
        os.kill(os.getpid(), signal.SIGUSR1)

    def bound_memory(most: int) -> None:
        """Limit the address space of this process [bytes], where the system can."""
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        least = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(resource.RLIMIT_AS, (least, hard))

    def lower_priority(steps: int) -> None:
        """Lower the priority of this process by a number of steps of `nice`."""
        os.nice(steps)

    def peak_memory() -> float:
        """Return the peak resident memory of this process [bytes]."""
        with suppress(OSError, StopIteration):  # Linux; getrusage has that of the parent, too
            lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
            return 1024.0 * int(next(x for x in lines if x.startswith("VmHWM:")).split()[1])
        import resource

        # kilobytes, but bytes on macOS
        unit = 1.0 if sys.platform == "darwin" else 1024.0
        return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def open_itself(path: Path, flags: int) -> int:
    """Open a regular file for reading and writing, but no link, folder, pipe or device.

    Raises
    ------
    InputError
        If the path is a link or not a regular file.
    OSError
        If it cannot be opened.
    """
    if path.is_symlink():
        raise InputError(f"{path} is a link, not a regular file; remove it")
    handle = os.open(path, os.O_RDWR | _ITSELF | flags, 0o644)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise InputError(f"{path} is not a regular file; remove it")
    return handle


def touch(path: Path, handle: int) -> None:
    """Set the modification time of an open file to now."""
    os.utime(handle if os.utime in os.supports_fd else path)


def is_running(process: int) -> bool:
    """Whether a process with this number runs."""
    import psutil

    return psutil.pid_exists(process)


def resident_memory(process: int | None = None) -> float:
    """Return the resident memory of a process [bytes], by default of this; 0 if it has ended."""
    import psutil

    try:
        return float(psutil.Process(process).memory_info().rss)
    except psutil.Error:
        return 0.0
