"""Parquet files of campaigns, read first in a child process with limits."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.parquet import check_parquet, damaged
from viscotack.pool.apart import Apart, Exceeded

# Limits of the child: for a small file, and per byte of it. Numbers of a campaign repeat: a column
# of a grid takes a hundredth of its size.
_MEMORY, _MEMORY_PER_BYTE = 150e6, 100.0
_SECONDS, _SECONDS_PER_BYTE = 60.0, 4e-6
# Imports of the child, which its limit of memory does not count.
IMPORTS = "viscotack.files.arrow:import_arrow"
# Hashes of what this process wrote, and of what a child has read: memory and time of these files
# are bounded, and this process reads them.
_SAFE: set[str] = set()


def trust(sha256: str) -> None:
    """Note the hash of a file that this process writes."""
    _SAFE.add(sha256)


def check_apart(files: Iterable[tuple[Path, str]]) -> None:
    """Read files with known hashes in a child process, unless this was done; they may be forged.

    The memory that a file takes follows neither from its size nor from its metadata.

    Parameters
    ----------
    files : iterable of (Path, str)
        With their hashes. Files behind the first one are read in the same process, which takes time
        to start; their errors are not raised.

    Raises
    ------
    FileNotFoundError
        If the first one is not there.
    ValueError
        If it is damaged, or takes too much memory or time; with its name.
    """
    (first, sha256), *others = files
    if sha256 in _SAFE:
        return
    arrow()  # the error of a missing library is that of this process
    with Apart(IMPORTS) as child:
        check(child, first, sha256)
        for path, hash_ in others:
            with suppress(InputError, OSError):
                check(child, path, hash_)


def check(child: Apart, path: Path, sha256: str) -> None:
    """Read a file in a child process, unless this was done; errors as of `check_apart`."""
    if sha256 in _SAFE:
        return
    size = path.stat().st_size
    limits = {
        "seconds": _SECONDS + _SECONDS_PER_BYTE * size,
        "memory": _MEMORY + _MEMORY_PER_BYTE * size,
    }
    try:
        child.call(check_parquet, path, sha256, **limits)
    except Exceeded as error:
        raise InputError(damaged(path, error)) from None
    trust(sha256)
