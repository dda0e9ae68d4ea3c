"""Versions and source hash of the running program: a table must not mix rows of different ones."""

import hashlib
import platform
from functools import cache
from pathlib import Path

import numpy
import scipy

from viscotack.version import __version__

_PACKAGE = Path(__file__).parents[1]


@cache
def identity() -> str:
    """Return the versions on which numbers depend, and a hash of the source of this package."""
    source = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        content = path.read_bytes()
        source.update(f"{path.relative_to(_PACKAGE).as_posix()} {len(content)}\n".encode())
        source.update(content)
    return (
        f"viscotack {__version__}, source {source.hexdigest()[:16]}, "
        # a change of its last part does not change numbers
        f"python {'.'.join(platform.python_version_tuple()[:2])}, "
        f"numpy {numpy.__version__}, scipy {scipy.__version__}"
    )
