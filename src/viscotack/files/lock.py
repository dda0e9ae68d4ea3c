"""One run at a time on a folder: the second is refused."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from viscotack.errors import InputError


class FolderInUse(InputError):
    """Another run writes to the folder."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder for the block; the system lets go of it when the process ends, however.

    Raises
    ------
    FolderInUse
        If another process holds it; with the machine and the number of that process.
    """
    handle = os.open(folder / "lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        if not _taken(handle):
            holder = os.read(handle, 200).decode(errors="replace").strip() or "another process"
            raise FolderInUse(
                f"{folder} is in use by {holder}; wait for that run, or give another --out"
            )
        os.ftruncate(handle, 0)
        os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode(), 0)
        yield
    finally:
        os.close(handle)


def _taken(handle: int) -> bool:
    try:
        import fcntl
    except ImportError:
        raise InputError("campaigns need the file locks of Linux or macOS to run") from None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
