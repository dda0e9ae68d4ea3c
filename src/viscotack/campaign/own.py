"""Files of the user's own beside a campaign: read as they were when it was planned, or not."""

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.problem.nouns import own_nouns


class OwnChanged(InputError):
    """A file of the user's own is not what it was when the campaign was planned."""


def digest(path: str | Path) -> str:
    """Return the hash of a file's bytes."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def digests(paths: Iterable[str]) -> tuple[str, ...]:
    """Return the hashes of files."""
    return tuple(digest(path) for path in paths)


def nouns_of(paths: tuple[str, ...], known: tuple[str, ...]) -> tuple[Any, ...]:
    """Return what files of the user's own define.

    Parameters
    ----------
    paths : tuple of str
        The files.
    known : tuple of str
        Their hashes when the campaign was planned; () for a campaign that kept none.

    Raises
    ------
    OwnChanged
        If a file has another content now.
    """
    if known:
        for path, before in zip(paths, known, strict=True):
            if digest(path) != before:
                raise OwnChanged(
                    f"{path} has been edited since this campaign was planned, and its rows would "
                    "not be of one kind; put it back as it was, or give another --out"
                )
    return own_nouns(paths)
