"""Parquet files of campaigns, read first in a child process with limits."""

from collections.abc import Callable, Iterable
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


def check_apart(
    path: Path, sha256: str, beside: Callable[[], Iterable[tuple[Path, str]]] = tuple
) -> None:
    """Read a file with a known hash in a child process, unless this was done; it may be forged.

    The memory that a file takes follows neither from its size nor from its metadata.

    Parameters
    ----------
    path, sha256
        The file and its hash.
    beside : callable
        Returns files with their hashes that are read in the same process, which takes time to
        start; their errors are not raised.

    Raises
    ------
    FileNotFoundError
        If it is not there.
    ValueError
        If it is damaged, or takes too much memory or time; with its name.
    """
    if sha256 in _SAFE:
        return
    arrow()  # the error of a missing library is that of this process
    with Apart(IMPORTS) as child:
        check(child, path, sha256)
        for other in beside():
            with suppress(InputError, OSError):
                check(child, *other)


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
