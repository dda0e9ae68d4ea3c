"""Files are read within a limit of size, and only those that end: no devices, no pipes."""

import os
import stat
from typing import IO

from viscotack.errors import InputError

# Largest text that a user gives, such as a table of a million cases [bytes].
LARGEST_TEXT = 300_000_000
# Largest part of a campaign, which this package wrote [bytes].
LARGEST_PART = 2_000_000_000
_AT_ONCE = 1 << 20


def open_regular(path: str | os.PathLike[str]) -> IO[bytes]:
    """Open a regular file for reading; errors as of `read_bytes`."""
    found = os.stat(path).st_mode
    # opening a pipe without a writer would block
    if not stat.S_ISREG(found) and not stat.S_ISDIR(found):
        raise InputError(
            f"{os.fspath(path)} is no regular file: it is a device, a pipe or a socket; save what "
            "it gives in a file"
        )
    return open(path, "rb")


def read_bytes(path: str | os.PathLike[str], most: int) -> bytes:
    """Read a regular file of at most `most` bytes.

    Raises
    ------
    OSError
        If the file cannot be opened.
    InputError
        If it is a device, a pipe or a socket, or larger.
    """
    parts, size = [], 0
    with open_regular(path) as stream:
        stated = os.fstat(stream.fileno()).st_size
        # a file may grow, and some of the system's state no size
        while max(size, stated) <= most and (part := stream.read(_AT_ONCE)):
            parts.append(part)
            size += len(part)
    if max(size, stated) > most:
        raise InputError(
            f"{os.fspath(path)} is larger than {most / 1e6:g} MB, the most that is read of such a "
            "file"
        )
    return b"".join(parts)
