"""Files are read within a limit of size, and only those that end: no devices, no pipes.

Every file that is opened here is noted, so that a command does not write over what it has read.
"""

import os
import stat
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import IO

from viscotack.errors import InputError

# Largest text that a user gives, such as a table of a million cases [bytes].
LARGEST_TEXT = 100_000_000
# Longest line of a text [bytes]: a table of it has tens of thousands of columns.
LONGEST_LINE = 1_000_000
# Largest size of an archive when unpacked: results with their fields, maps [bytes].
LARGEST_UNPACKED = 1e9
_AT_ONCE = 1 << 20
# Device and number of the files and folders that the command has read.
_READ: set[tuple[int, int]] = set()


def open_regular(path: str | os.PathLike[str]) -> IO[bytes]:
    """Open a regular file for reading; errors as of `read_bytes`."""
    found = os.stat(path).st_mode
    # opening a pipe without a writer would block
    if not stat.S_ISREG(found) and not stat.S_ISDIR(found):
        raise InputError(
            f"{os.fspath(path)} is no regular file: it is a device, a pipe or a socket; save what "
            "it gives in a file"
        )
    note_read(path)
    return open(path, "rb")


def note_read(path: str | os.PathLike[str]) -> None:
    """Note a file or folder as an input, for `was_read`."""
    with suppress(OSError, ValueError):  # it is not there, which its reader reports
        found = os.stat(path)
        _READ.add((found.st_dev, found.st_ino))


def was_read(path: str | os.PathLike[str]) -> bool:
    """Whether a file, by whatever name or link, was read or lies in a folder that was."""
    place = Path(os.path.realpath(path))
    for each in (place, *place.parents):
        with suppress(OSError):
            found = os.stat(each)
            if (found.st_dev, found.st_ino) in _READ:
                return True
    return False


def forget_reads() -> None:
    """Forget what was read, when a command begins."""
    _READ.clear()


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
        # one part, which is not copied; a file may grow, and some of the system's state no size
        while max(size, stated) <= most and (part := stream.read(max(stated - size, _AT_ONCE))):
            parts.append(part)
            size += len(part)
    if max(size, stated) > most:
        raise InputError(
            f"{os.fspath(path)} is larger than {most / 1e6:g} MB, the most that is read of such a "
            "file"
        )
    return b"".join(parts)


def check_lines(path: str | os.PathLike[str], content: bytes, most: int = LONGEST_LINE) -> None:
    """Refuse a text with a line of more bytes than `most`."""
    begin = 0
    while begin + most < len(content):
        window = begin, begin + most + 1
        end = max(content.rfind(b"\n", *window), content.rfind(b"\r", *window))
        if end < 0:
            line = content.count(b"\n", 0, begin) + 1
            raise InputError(
                f"{os.fspath(path)}, line {line}: a line of more than {most / 1e6:g} MB, the most "
                "that is read; a table has a row in each line"
            )
        begin = end + 1


def check_unpacked(file: IO[bytes], most: float = LARGEST_UNPACKED) -> bool:
    """Refuse a zip archive that unpacks to more bytes than `most`; whether it is an archive."""
    if not zipfile.is_zipfile(file):
        return False
    try:
        with zipfile.ZipFile(file) as archive:
            size = sum(member.file_size for member in archive.infolist())
    except zipfile.BadZipFile as error:
        raise InputError(f"it is a damaged archive: {error}") from None
    if size > most:
        raise InputError(
            f"it has {size / 1e6:.0f} MB when unpacked, more than the limit of {most / 1e6:.0f} MB"
        )
    return True
