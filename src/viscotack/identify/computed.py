"""Forces that an identification computed, kept in a file for the next one.

Forces by theory and simulation take most of the time of an identification. Each result is kept
under a hash of all that it follows from and of the version, so that changed data, options or
materials are computed again. The file contains numbers and reasons of refusals only.
"""

import hashlib
import io
import re
import zipfile
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.whole import NotWritten, write_whole
from viscotack.version import __version__

_NAME = re.compile(r"[0-9a-f]{32}\.[a-z_]{1,20}")
_MOST = 5e7  # largest size of a file, unpacked [bytes]
SUFFIX = ".computed.npz"  # of the file beside a study

Arrays = Callable[[], Mapping[str, npt.NDArray[Any]]]


class Computed:
    """Arrays by a hash of their inputs."""

    def __init__(self, known: Mapping[str, npt.NDArray[Any]] | None = None) -> None:
        self._known = dict(known or {})
        self._used: set[str] = set()
        self._changed = False

    @classmethod
    def read(cls, path: Path) -> "Computed":
        """Read a file; a missing or damaged one is empty."""
        with suppress(OSError, ValueError, InputError, zipfile.BadZipFile, zlib.error):
            with path.open("rb") as file:
                return cls(read_arrays(file, lambda name: bool(_NAME.fullmatch(name)), _MOST))
        return cls()

    def write(self, path: Path) -> None:
        """Write the entries used since the file was read, if any is new."""
        if not self._changed:
            return
        content = io.BytesIO()
        used = {name: self._known[name] for name in sorted(self._used)}
        np.savez_compressed(content, allow_pickle=False, **used)  # type: ignore[arg-type]
        # a folder that cannot be written to costs time only
        with suppress(NotWritten, OSError):
            write_whole(path, content.getvalue())

    def of(self, what: Any, compute: Arrays) -> dict[str, npt.NDArray[Any]]:
        """Return arrays by name, computed if they are not known.

        Parameters
        ----------
        what : object
            All that the arrays follow from; its `repr` must be unique.
        compute : callable
            Returns the arrays.
        """
        text = f"{__version__} {what!r}"
        key = hashlib.sha256(text.encode()).hexdigest()[:32]
        names = [name for name in self._known if name.startswith(key)]
        if not names:
            self._changed = True
            found = {f"{key}.{name}": value for name, value in compute().items()}
            self._known |= found
            names = list(found)
        self._used.update(names)
        return {name.partition(".")[2]: self._known[name] for name in names}


def packaged(material: Any) -> bool:
    """Whether a material is a class of the package, whose `repr` states all of it."""
    return type(material).__module__.startswith("viscotack.")
