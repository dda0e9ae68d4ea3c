"""Atomic writing of files: complete or not at all.

If the target is a regular file or does not exist, a finished draft replaces it; what a symbolic
link names is replaced, not the link. A terminal, a null device or a pipe is written to directly.
"""

import errno
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from viscotack.errors import InputError

# A path, or an open binary file such as ``sys.stdout.buffer``.
Target = str | os.PathLike[str] | IO[bytes]

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class NotWritten(OSError, InputError):
    """A file could not be written; the message contains its name and the reason."""

    def __str__(self) -> str:
        """Return the message without the error number."""
        return str(self.strerror)


def write_whole(target: Target, content: Any) -> None:
    """Write bytes to a file, complete or not at all.

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
    with _told(target):
        path, draft = _places(target)
        if path.exists() and not path.is_file():
            with open(path, "wb") as file:
                yield file
            return
        try:
            with open(draft, "xb") as file:
                if path.exists():
                    os.chmod(draft, stat.S_IMODE(path.stat().st_mode))
                yield file
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, path)
        finally:
            draft.unlink(missing_ok=True)


def check_target(target: str | os.PathLike[str]) -> None:
    """Raise NotWritten unless `write_whole` could write to the target; nothing is changed.

    The check creates and removes a draft, because permission bits do not show read-only file
    systems and special folders, and do not apply to root.
    """
    with _told(target):
        path, draft = _places(target)
        if not path.exists() or path.is_file():
            draft.touch(exist_ok=False)
            draft.unlink()


def is_standard_output(path: str | os.PathLike[str]) -> bool:
    """Whether a path is ``-`` or the system's name of standard output."""
    return os.fspath(path) in ("-", "/dev/stdout")


def same_file(one: str | os.PathLike[str], other: str | os.PathLike[str]) -> bool:
    """Whether writing to one path would overwrite the file at the other path."""
    if is_standard_output(one) and is_standard_output(other):
        return True
    if os.path.realpath(one) == os.path.realpath(other):
        return not os.path.exists(one) or os.path.isfile(one)
    return os.path.isfile(one) and os.path.isfile(other) and os.path.samefile(one, other)


def _places(target: str | os.PathLike[str]) -> tuple[Path, Path]:
    """Return the file that a path names and the draft beside it; OSError if it is protected."""
    path = Path(os.path.realpath(target))
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, "it is a folder; give a file name")
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"folder {Path(target).parent} does not exist")
    # its permission bits do not bind root
    if path.exists() and not (path.stat().st_mode & 0o222 and os.access(path, os.W_OK)):
        raise PermissionError(errno.EACCES, "it is write-protected; give another name")
    # without the name of the file, which may already have the largest allowed length
    return path, path.with_name(f".viscotack-{secrets.token_hex(4)}.draft")


@contextmanager
def _told(target: str | os.PathLike[str]) -> Iterator[None]:
    """Raise the errors of the system as NotWritten, which names the target."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        why = error.strerror or str(error)
        words = f"cannot write {os.fspath(target)}: {why}"
        if error.errno in _FULL:
            words = (
                f"no space left for {os.fspath(target)} ({why}); the old file is intact: free "
                "space and repeat"
            )
        raise NotWritten(error.errno, words) from None
