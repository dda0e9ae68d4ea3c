"""Lock of a folder, so that only one run at a time writes to it.

The operating system releases a lock when its process ends, even after a crash. Some file systems
have no locks, and others do not share them between machines. The lock file therefore also contains
machine and process of its holder, the holder renews its modification time, and it checks before
each write that the file is still its own.
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

# Time without renewal after which a holder on another machine counts as ended [s].
_STALE = 60.0
_HOLDER = re.compile(r"process (\d+) on (\S+)")


class FolderInUse(InputError):
    """Another run has locked the folder."""


class Hold:
    """A locked folder.

    Parameters
    ----------
    path : Path
        The lock file.
    handle : int
        Its open file descriptor.
    """

    def __init__(self, path: Path, handle: int) -> None:
        self._path, self._handle = path, handle

    def confirm(self) -> None:
        """Renew the lock; FolderInUse if its file was removed or replaced meanwhile."""
        if not _is_same(self._path, self._handle):
            raise FolderInUse(
                f"{self._path} was removed while this run held it, so another run may write to "
                "the folder; this run has ended, and its stored rows are safe"
            )
        os.utime(self._handle)


@contextmanager
def locked(folder: Path) -> Iterator[Hold]:
    """Lock a folder for the duration of a `with` block.

    The operating system releases the lock when the process ends, even after a crash.

    Raises
    ------
    FolderInUse
        If another process holds the lock; the message contains its machine and number.
    InputError
        If the lock file is a link or not a regular file, or the system has no file locks.
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
    """Open the lock file itself, without following links."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o644)
    except OSError as error:
        if path.is_symlink():
            raise InputError(f"the lock {path} is a link, not a regular file; remove it") from None
        raise InputError(f"cannot lock {path.parent}: {error.strerror}") from None
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise InputError(f"the lock {path} is not a regular file; remove it")
    return handle


def _taken(handle: int) -> bool:
    try:
        import fcntl
    except ImportError:
        raise InputError("campaigns need the file locks of Linux or macOS") from None
    with suppress(OSError):  # without locks in the file system only the text in the file counts
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
    return True


def _lives(path: Path, handle: int, holder: str) -> bool:
    """Whether the holder named in the file may still run although its lock was granted to us."""
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
    """Whether the file system refuses a second lock on the same file, as it should."""
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
