"""Versions and source hash of the running program: a table must not mix rows of different ones."""

import hashlib
import platform
from functools import cache
from pathlib import Path

import numpy
import scipy

from viscotack.version import __version__

# What numbers depend on, beside the source: a change of its last part does not change them.
_PYTHON = ".".join(platform.python_version_tuple()[:2])
_PACKAGE = Path(__file__).parents[1]


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
