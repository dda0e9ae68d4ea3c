"""Lock of a folder, so that only one run at a time writes to it.

The operating system releases a lock when its process ends, even after a crash. Some file systems
have no locks, and others do not share them between machines. The lock file therefore also contains
machine and process of its holder, the holder renews its modification time, and it checks before
each write that the file is still its own.
"""

import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import time

from viscotack import system
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
        system.touch(self._path, self._handle)


@contextmanager
def locked(folder: Path) -> Iterator[Hold]:
    """Lock a folder for the duration of a `with` block.

    The operating system releases the lock when the process ends, even after a crash.

    Raises
    ------
    FolderInUse
        If another process holds the lock; the message contains its machine and number.
    InputError
        If the lock file is a link or not a regular file.
    """
    path = folder / "lock"
    handle = _opened(path)
    try:
        os.lseek(handle, 0, os.SEEK_SET)
        holder = os.read(handle, 200).decode(errors="replace").strip()
        if not system.lock(handle) or not _is_same(path, handle) or _lives(path, handle, holder):
            raise FolderInUse(
                f"{folder} is in use by {holder or 'another process'}; wait for that run, or give "
                "another --out"
            )
        os.ftruncate(handle, 0)
        os.lseek(handle, 0, os.SEEK_SET)
        try:
            os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        except OSError as error:
            raise InputError(f"cannot write {path}: {error.strerror}") from None
        yield Hold(path, handle)
        os.ftruncate(handle, 0)
    finally:
        os.close(handle)


def _opened(path: Path) -> int:
    """Open the lock file itself, without following links."""
    try:
        return system.open_itself(path, os.O_CREAT)
    except OSError as error:
        raise InputError(f"cannot lock {path.parent}: {error.strerror}") from None


def _lives(path: Path, handle: int, holder: str) -> bool:
    """Whether the holder named in the file may still run although its lock was granted to us."""
    found = _HOLDER.fullmatch(holder)
    if found is None or abs(time() - os.fstat(handle).st_mtime) > _STALE:
        return False
    if found[2] != socket.gethostname():
        return True
    if int(found[1]) == os.getpid() or _excludes(path):
        return False
    return system.is_running(int(found[1]))


def _excludes(path: Path) -> bool:
    """Whether the file system refuses a second lock on the same file, as it should."""
    second = system.open_itself(path, 0)
    try:
        return not system.lock(second)
    finally:
        os.close(second)


def _is_same(path: Path, handle: int) -> bool:
    try:
        return os.path.samestat(os.stat(path, follow_symlinks=False), os.fstat(handle))
    except FileNotFoundError:
        return False
