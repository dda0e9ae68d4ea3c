"""Atomic writing of files: complete or not at all.

If the target is a regular file or does not exist, a finished draft replaces it; a symbolic link to
a file is refused. A terminal, a null device, a pipe, or a file to which standard output or standard
error is redirected is written to directly.
"""

import errno
import os
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from viscotack.errors import InputError

# A path, or an open binary file such as ``sys.stdout.buffer``.
Target = str | os.PathLike[str] | IO[bytes]

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# Creating a file in /proc fails with ENOENT.
_CLOSED = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOENT)


class NotWritten(OSError, InputError):
    """A file could not be written; the message contains its name and the reason."""

    def __str__(self) -> str:
        """Return the message without the error number."""
        return str(self.strerror)


def write_whole(target: Target, content: Any) -> None:
    """Write bytes to a file, complete or not at all; on return they are on the disk.

    The permission bits of an existing file are kept. Streams, devices and pipes are written to
    directly, so that after an error they may have received a part of the bytes.

    Parameters
    ----------
    target : path or binary file
        Destination.
    content : bytes-like
        Complete content.

    Raises
    ------
    NotWritten
        If writing fails; a regular file is then unchanged, and no draft remains.
    BrokenPipeError
        If the reader of a pipe has closed it.
    """
    with writing_whole(target) as file:
        file.write(content)


@contextmanager
def writing_whole(target: Target) -> Iterator[IO[bytes]]:
    """Open a file for atomic writing in several pieces; errors as for `write_whole`.

    The finished draft replaces a regular file when the block ends without an exception.
    """
    if not isinstance(target, str | os.PathLike):
        yield target
        target.flush()
        return
    path = Path(target)
    try:
        found = _found(path)
        if (handle := _own_stream(found)) is not None:
            (sys.stdout, sys.stderr)[handle - 1].flush()
            with open(handle, "wb", closefd=False) as file:
                yield file
        elif found is None or stat.S_ISREG(found.st_mode):
            with _draft(path, None if found is None else found.st_mode) as file:
                yield file
        else:
            with open(path, "wb") as file:
                yield file
    except (NotWritten, BrokenPipeError):
        raise
    except OSError as error:
        raise _not_written(path, error) from None


def check_target(target: str | os.PathLike[str]) -> None:
    """Raise NotWritten unless `write_whole` could write to the target; nothing is changed.

    The check creates and removes a draft, because permission bits do not show read-only file
    systems and special folders, and do not apply to root.
    """
    path = Path(target)
    try:
        found = _found(path)
        if _own_stream(found) is None and (found is None or stat.S_ISREG(found.st_mode)):
            draft = _draft_beside(path)
            try:
                draft.touch(exist_ok=False)
            finally:
                draft.unlink(missing_ok=True)
    except NotWritten:
        raise
    except OSError as error:
        raise _not_written(path, error) from None


def is_standard_output(path: str | os.PathLike[str]) -> bool:
    """Whether a path is ``-`` or the destination of standard output, the null device excepted."""
    if os.fspath(path) == "-":
        return True
    try:
        found = os.stat(path)
        return os.path.samestat(found, os.fstat(1)) and not _is_nothing(found)
    except OSError:
        return False


def same_file(one: str | os.PathLike[str], other: str | os.PathLike[str]) -> bool:
    """Whether writing to one path would overwrite the file at the other path.

    Links and relative paths are resolved. Devices are never overwritten.
    """
    if is_standard_output(one) and is_standard_output(other):
        return True
    if os.path.realpath(one) == os.path.realpath(other):
        return not os.path.exists(one) or os.path.isfile(one)
    try:
        return os.path.isfile(one) and os.path.samefile(one, other)
    except OSError:
        return False


def _found(path: Path) -> os.stat_result | None:
    """Return the status of an existing target, None if missing; NotWritten if not writable."""
    found = os.stat(path) if path.exists() else None
    is_file = found is None or stat.S_ISREG(found.st_mode)
    if path.is_symlink() and is_file and _own_stream(found) is None:
        words = f"cannot write {path}: it is a link to {os.path.realpath(path)}; give that name"
        raise NotWritten(errno.ELOOP, words)
    if found is None:
        if not path.parent.is_dir():
            words = f"cannot write {path}: folder {path.parent} does not exist"
            raise NotWritten(errno.ENOENT, words)
        return None
    if stat.S_ISDIR(found.st_mode):
        words = f"cannot write {path}: it is a folder; give a file name"
        raise NotWritten(errno.EISDIR, words)
    if stat.S_ISREG(found.st_mode) or _own_stream(found) is not None:
        protected = not found.st_mode & 0o222
    elif stat.S_ISCHR(found.st_mode) or stat.S_ISFIFO(found.st_mode):
        protected = False
    else:
        kind = "a socket" if stat.S_ISSOCK(found.st_mode) else "a disk"
        words = f"cannot write {path}: it is {kind}; give a file name"
        raise NotWritten(errno.EINVAL, words)
    if protected or not os.access(path, os.W_OK):
        words = f"cannot write {path}: it is write-protected; give another name"
        raise NotWritten(errno.EACCES, words)
    return found


def _own_stream(found: os.stat_result | None) -> int | None:
    """Return 1 or 2 if the target receives standard output or error and must not be replaced."""
    for handle in (1, 2):
        try:
            if found is not None and os.path.samestat(found, os.fstat(handle)):
                return handle
        except OSError:  # closed
            continue
    return None


def _is_nothing(found: os.stat_result) -> bool:
    return os.path.samestat(found, os.stat(os.devnull))


def _draft_beside(place: Path) -> Path:
    # without the name of the file, which may already have the largest allowed length
    return place.with_name(f".viscotack-{secrets.token_hex(4)}.draft")


@contextmanager
def _draft(place: Path, mode: int | None) -> Iterator[IO[bytes]]:
    """Open a draft, which takes the place of the file when it is complete and on the disk."""
    draft = _draft_beside(place)
    try:
        with open(draft, "xb") as file:
            if mode is not None:
                os.chmod(draft, stat.S_IMODE(mode))
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(draft, place)
    finally:
        draft.unlink(missing_ok=True)
    _sync(place.parent)


def _not_written(path: Path, error: OSError) -> NotWritten:
    why = error.strerror or str(error)
    if error.errno in _FULL:
        words = f"no space left for {path} ({why}); the old file is intact: free space and repeat"
    elif error.errno in _CLOSED:
        words = f"cannot write {path}: cannot create a file in the folder {path.parent} ({why})"
    else:
        words = f"cannot write {path}: {why}"
    return NotWritten(error.errno, words)


def _sync(folder: Path) -> None:
    """Flush the directory entries of a folder to the disk, if the system supports it."""
    if (directory := getattr(os, "O_DIRECTORY", None)) is None:
        return
    try:
        handle = os.open(folder, os.O_RDONLY | directory)
    except PermissionError:  # a folder that may be written but not read
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
