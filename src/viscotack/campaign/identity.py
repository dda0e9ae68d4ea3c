"""Versions and source hash of the running program, and hashes of user-defined files.

A table must not mix rows of different program versions. Each worker therefore reports its versions
before it receives a case, and user-defined files must be unchanged since the planning.
"""

import hashlib
import platform
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import numpy
import scipy

from viscotack.errors import InputError
from viscotack.files.bounded import LARGEST_TEXT, read_bytes
from viscotack.problem.nouns import own_nouns
from viscotack.version import __version__

# What numbers depend on, beside the source: a change of its last part does not change them.
_PYTHON = ".".join(platform.python_version_tuple()[:2])
_PACKAGE = Path(__file__).parents[1]
_EDITED = (
    "{} has been edited since this campaign was planned, so new rows would not be comparable; "
    "restore the file, or give another --out"
)


@cache
def identity() -> dict[str, str]:
    """Return the versions of the libraries, and a hash of the source of this package."""
    return {
        "viscotack": __version__,
        "source": source_hash(_PACKAGE),
        "python": _PYTHON,
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }


def source_hash(folder: Path) -> str:
    """Return a short hash of all Python files below a folder, with their names."""
    found = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        content = path.read_bytes()
        found.update(f"{path.relative_to(folder).as_posix()} {len(content)}\n".encode())
        found.update(content)
    return found.hexdigest()[:16]


def difference(theirs: dict[str, str], ours: dict[str, str]) -> str:
    """Describe the differences between two identities; empty if there are none.

    Examples
    --------
    >>> difference({"viscotack": "0.2", "numpy": "2"}, {"viscotack": "0.1", "numpy": "2"})
    'viscotack 0.2 and not 0.1'
    """
    names = dict.fromkeys([*ours, *theirs])
    return ", ".join(
        f"{name} {theirs.get(name, 'unknown')} and not {ours.get(name, 'unknown')}"
        for name in names
        if theirs.get(name) != ours.get(name)
    )


def words(who: dict[str, str]) -> str:
    """Return an identity as one word of text, for a column of a table."""
    return ", ".join(f"{name} {version}" for name, version in who.items())


class OwnChanged(InputError):
    """A user-defined file was edited after the campaign was planned."""


def digest(path: str | Path, most: int = LARGEST_TEXT) -> str:
    """Return the hash of a file's bytes."""
    return hashlib.sha256(read_bytes(path, most)).hexdigest()


def permitted(
    own: tuple[str, ...], known: tuple[str, ...], files: Iterable[str | Path], folder: Path
) -> tuple[str, ...]:
    """Find the files of a folder's campaign among those that the caller permits to be executed.

    Parameters
    ----------
    own, known : tuple of str
        Paths and hashes that the folder states; () for hashes that were not kept.
    files : iterable of path
        The permitted files. The paths that the folder states are never executed for its word.
    folder : Path
        For errors.

    Raises
    ------
    OwnChanged
        If a permitted file has the path of one of them and another content.
    InputError
        If one of them is not permitted.
    """
    given = [str(Path(file).resolve()) for file in files]
    by_hash = {digest(path): path for path in given}
    found = []
    for i, path in enumerate(own):
        if known and known[i] in by_hash:
            found.append(by_hash[known[i]])
        elif path not in given:
            raise InputError(
                f"{folder} was planned with {path}, Python that would be executed: permit it, "
                f"--with {path} on the command line, own=[...] in Python"
            )
        elif known:
            raise OwnChanged(_EDITED.format(path))
        else:
            found.append(path)
    return tuple(found)


def nouns_of(paths: tuple[str, ...], known: tuple[str, ...]) -> tuple[Any, ...]:
    """Return the classes in user-defined files.

    Parameters
    ----------
    paths : tuple of str
        The files.
    known : tuple of str
        Their hashes when the campaign was planned; () if none were stored.

    Raises
    ------
    OwnChanged
        If a file was edited.
    """
    for path, before in zip(paths, known, strict=bool(known)):
        if digest(path) != before:
            raise OwnChanged(_EDITED.format(path))
    return own_nouns(paths)
