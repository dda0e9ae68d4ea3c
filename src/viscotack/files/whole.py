"""The one way to write a file: whole or not at all.

What stands at the target decides. A regular file, or none, is replaced by a finished draft; behind
a symbolic link it is the file that the link leads to. A terminal, a null device or a pipe is
written to and stays what it is; so is a file that standard output or standard error goes to.
"""

import errno
import os
import re
import secrets
import stat
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from viscotack.errors import InputError

# A path, or an open binary file such as ``sys.stdout.buffer``.
Target = str | os.PathLike[str] | IO[bytes]

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# A folder of /proc says that what is to be made there is missing.
_CLOSED = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOENT)


class NotWritten(OSError, InputError):
    """A file could not be written; the words say which one, and why."""

    def __str__(self) -> str:
        """Return the words without the number of the error."""
        return str(self.strerror)


def write_whole(target: Target, content: Any) -> None:
    """Write bytes to a file, whole or not at all; on return they are on the disk.

    Permission bits of a file that is there are kept. Streams, devices and pipes get the bytes as
    they come, and what they got before an error they have.

    Parameters
    ----------
    target : path or binary file
        Where to.
    content : bytes-like
        All of it.

    Raises
    ------
    NotWritten
        If that could not be done; a regular file is then as before, and no draft is left.
    BrokenPipeError
        If the reader of a pipe has gone.
    """
    with writing_whole(target) as file:
        file.write(content)


@contextmanager
def writing_whole(target: Target) -> Iterator[IO[bytes]]:
    """Hold an open file for what is too long to have at once; errors as of `write_whole`.

    A regular file, or none, is replaced by the finished draft when the block ends well.
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
            place = Path(os.path.realpath(path))
            with _draft(place, None if found is None else found.st_mode, os.replace) as file:
                yield file
        else:
            with open(path, "wb") as file:
                yield file
    except (NotWritten, BrokenPipeError):
        raise
    except OSError as error:
        raise _not_written(path, error) from None


def write_new(path: Path, content: Any) -> None:
    """Write bytes to a file that is not there yet, whole or not at all; never over another one.

    Raises
    ------
    NotWritten
        If that could not be done; with what was there as it was.
    """
    try:
        with _draft(path, None, _name) as file:
            file.write(content)
    except OSError as error:
        raise _not_written(path, error) from None


def is_draft(path: Path) -> bool:
    """Return whether a file has a name that only drafts of this module have."""
    return re.fullmatch(r"\.viscotack-[0-9a-f]{8}\.draft", path.name) is not None


def remove_drafts(folder: Path) -> None:
    """Remove the drafts that a killed process has left in a folder."""
    for path in folder.glob("*"):
        if is_draft(path):
            path.unlink(missing_ok=True)


def check_target(target: str | os.PathLike[str]) -> None:
    """Raise NotWritten unless `write_whole` could begin; what is there stays as it is.

    A draft is made and taken away again: the rights of a folder say neither that the disk is
    mounted for reading only nor what a folder of the system takes, and mean nothing to root.
    """
    path = Path(target)
    try:
        found = _found(path)
        if _own_stream(found) is None and (found is None or stat.S_ISREG(found.st_mode)):
            draft = _draft_beside(Path(os.path.realpath(path)))
            try:
                draft.touch(exist_ok=False)
            finally:
                draft.unlink(missing_ok=True)
    except NotWritten:
        raise
    except OSError as error:
        raise _not_written(path, error) from None


def is_standard_output(path: str | os.PathLike[str]) -> bool:
    """Return whether a path is ``-`` or leads to where standard output goes, unless to nothing."""
    if os.fspath(path) == "-":
        return True
    try:
        found = os.stat(path)
        return os.path.samestat(found, os.fstat(1)) and not _is_nothing(found)
    except OSError:
        return False


def same_file(one: str | os.PathLike[str], other: str | os.PathLike[str]) -> bool:
    """Return whether what is written to one path would be lost by writing to the other.

    Links and other spellings of a path are seen through. A device loses nothing.
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
    """Return what is there, None where nothing is; refuse what cannot be written to."""
    try:
        found = os.stat(path)
    except FileNotFoundError:
        folder = Path(os.path.realpath(path)).parent
        if not folder.is_dir():
            shown = folder if path.is_symlink() else path.parent
            words = f"cannot write {path}: there is no folder {shown}"
            raise NotWritten(errno.ENOENT, words) from None
        return None
    if stat.S_ISDIR(found.st_mode):
        words = f"cannot write {path}: it is a folder; give the name of a file"
        raise NotWritten(errno.EISDIR, words)
    if stat.S_ISREG(found.st_mode) or _own_stream(found) is not None:
        protected = not found.st_mode & 0o222
    elif stat.S_ISCHR(found.st_mode) or stat.S_ISFIFO(found.st_mode):
        protected = False
    else:
        kind = "a socket" if stat.S_ISSOCK(found.st_mode) else "a disk"
        words = f"cannot write {path}: it is {kind}; give the name of a file"
        raise NotWritten(errno.EINVAL, words)
    if protected or not os.access(path, os.W_OK):
        words = f"cannot write {path}: it is write-protected; give another name"
        raise NotWritten(errno.EACCES, words)
    return found


def _own_stream(found: os.stat_result | None) -> int | None:
    """Return 1 or 2 if standard output or standard error goes there: it must not be replaced."""
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
    # without the name of the file, which may be as long as a name can be
    return place.with_name(f".viscotack-{secrets.token_hex(4)}.draft")


@contextmanager
def _draft(
    place: Path, mode: int | None, finish: Callable[[Path, Path], object]
) -> Iterator[IO[bytes]]:
    """Hold a draft that `finish` gives its name when it is complete and on the disk."""
    draft = _draft_beside(place)
    try:
        with open(draft, "xb") as file:
            if mode is not None:
                os.chmod(draft, stat.S_IMODE(mode))
            yield file
            file.flush()
            os.fsync(file.fileno())
        finish(draft, place)
    finally:
        draft.unlink(missing_ok=True)
    _sync(place.parent)


def _name(draft: Path, path: Path) -> None:
    """Give a draft its name, unless another file has it."""
    try:
        os.link(draft, path, follow_symlinks=False)
    except FileExistsError:
        raise
    except OSError:  # a file system on which a file has one name only
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST)) from None
        os.rename(draft, path)


def _not_written(path: Path, error: OSError) -> NotWritten:
    why = error.strerror or str(error)
    if error.errno in _FULL:
        words = f"no space left for {path} ({why}); what was there is safe: make room and run again"
    elif error.errno in _CLOSED:
        folder = Path(os.path.realpath(path)).parent if path.is_symlink() else path.parent
        words = f"cannot write {path}: the folder {folder} takes no new file ({why})"
    else:
        words = f"cannot write {path}: {why}"
    return NotWritten(error.errno, words)


def _sync(folder: Path) -> None:
    """Make the names in a folder durable; where the system cannot, it need not."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except PermissionError:  # it may be written and not be read
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
