"""One run at a time on a folder: the second is refused.

A lock of the system is let go of when its process ends, however. Not every file system has such
locks, and some have them on each machine apart. So the file says besides who holds it, and its date
that the holder lives; and the holder looks, before it writes, whether the file is still its own.
"""

import os
import re
import socket
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import time

from viscotack.errors import InputError

# Seconds without a sign of life after which a holder on another machine is taken for ended.
_STALE = 60.0
_HOLDER = re.compile(r"process (\d+) on (\S+)")


class FolderInUse(InputError):
    """Another run writes to the folder."""


class Hold:
    """A folder that is held.

    Parameters
    ----------
    path : Path
        The file of the lock.
    handle : int
        Its open handle.
    """

    def __init__(self, path: Path, handle: int) -> None:
        self._path, self._handle = path, handle

    def confirm(self) -> None:
        """Say that the holder lives; FolderInUse if the lock has been taken away meanwhile."""
        if not _is_same(self._path, self._handle):
            raise FolderInUse(
                f"{self._path} was removed while this run held it, and another run may write "
                "there; this one has ended, and what it had stored is safe"
            )
        os.utime(self._handle)


@contextmanager
def locked(folder: Path) -> Iterator[Hold]:
    """Hold the folder for the block; the system lets go of it when the process ends, however.

    Raises
    ------
    FolderInUse
        If another process holds it; with the machine and the number of that process.
    InputError
        If its lock is a link or no file, or the system has no locks.
    """
    path = folder / "lock"
    handle = _opened(path)
    try:
        holder = os.pread(handle, 200, 0).decode(errors="replace").strip()
        if not _taken(handle) or not _is_same(path, handle) or _lives(path, handle, holder):
            raise FolderInUse(
                f"{folder} is in use by {holder or 'another process'}; wait for that run, or give "
                "another --out"
            )
        os.ftruncate(handle, 0)
        os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode(), 0)
        yield Hold(path, handle)
        os.ftruncate(handle, 0)
    finally:
        os.close(handle)


def _opened(path: Path) -> int:
    """Return a handle of the lock's own file: nothing that it may lead to is touched."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o644)
    except OSError as error:
        if path.is_symlink():
            raise InputError(f"{path} is a link, and a lock must be a file: remove it") from None
        raise InputError(f"cannot lock {path.parent}: {error.strerror}") from None
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise InputError(f"{path} is no file, and a lock must be one: remove it")
    return handle


def _taken(handle: int) -> bool:
    try:
        import fcntl
    except ImportError:
        raise InputError("campaigns need the file locks of Linux or macOS to run") from None
    with suppress(OSError):  # a file system without such locks has the words in the file only
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
    return True


def _lives(path: Path, handle: int, holder: str) -> bool:
    """Return whether the holder that a file names may live, though the system gave us its lock."""
    found = _HOLDER.fullmatch(holder)
    if found is None or abs(time() - os.fstat(handle).st_mtime) > _STALE:
        return False
    if found[2] != socket.gethostname():
        return True
    if int(found[1]) == os.getpid() or _excludes(path):
        return False
    try:
        os.kill(int(found[1]), 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass
    return True


def _excludes(path: Path) -> bool:
    """Return whether the system keeps a lock from a second handle, as it should."""
    second = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
    try:
        return not _taken(second)
    finally:
        os.close(second)


def _is_same(path: Path, handle: int) -> bool:
    try:
        return os.path.samestat(os.stat(path, follow_symlinks=False), os.fstat(handle))
    except FileNotFoundError:
        return False
