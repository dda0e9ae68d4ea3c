"""Checkpoints: runs on a grid in a file, from which they continue after an interruption.

A file is a NumPy archive with the arrays of several parts of a simulation, named ``part.array``,
and one text in JSON per part. It stores every number in full, so that a run that continues has the
same digits as one that was not interrupted.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.whole import writing_whole

# Wall time after which a run is written again [s]; a kill loses this and the step under way.
EVERY = 30.0
# Most bytes of a file: 8192 x 8192 pixels and 50 modes.
_LARGEST = 6e10
_NAME = re.compile(r"key|(start|main)\.[a-z_]{1,20}")

Arrays = dict[str, npt.NDArray[Any]]


@dataclass(eq=False)
class Checkpoint:
    """Parts of a simulation in a file.

    Attributes
    ----------
    path : Path
        The file.
    key : str
        Identifier of problem and settings.
    every : float
        Wall time between two writes [s].
    parts : dict
        Arrays of each part.
    """

    path: Path
    key: str
    every: float = EVERY
    parts: dict[str, Arrays] = field(default_factory=dict)
    written: float = field(default_factory=perf_counter)

    @classmethod
    def opened(cls, path: Path, key: str, every: float = EVERY) -> Checkpoint:
        """Return the checkpoint in a file, an empty one if the file does not exist.

        Raises
        ------
        InputError
            If the file is no checkpoint, is damaged, or belongs to another problem.
        """
        found = cls(path, key, every)
        if not path.exists():
            return found
        try:
            with open(path, "rb") as file:
                arrays = read_arrays(file, lambda name: bool(_NAME.fullmatch(name)), _LARGEST)
            stored = str(arrays.pop("key"))
        except (ValueError, OSError, KeyError, EOFError, zlib.error, BadZipFile) as error:
            raise InputError(f"{path} is not a checkpoint: {error}; name another file") from None
        if stored != key:
            raise InputError(
                f"{path} is the checkpoint of another problem, accuracy, number of maps or "
                "version; remove it or name another file"
            )
        for name, array in arrays.items():
            part, _, own = name.partition(".")
            found.parts.setdefault(part, {})[own] = array
        return found

    def part(self, name: str, read: Callable[[Arrays], Any]) -> Any:
        """Return a part as the function reads it, None if there is none."""
        if name not in self.parts:
            return None
        try:
            return read(self.parts[name])
        except (KeyError, TypeError, ValueError, IndexError) as error:
            raise InputError(f"{self.path} is a damaged checkpoint: {error}; remove it") from None

    @property
    def due(self) -> bool:
        """Whether it is time to write again."""
        return perf_counter() - self.written >= self.every

    def keep(self, name: str, arrays: Arrays) -> None:
        """Write the file with new arrays of a part, whole or not at all."""
        self.parts[name] = arrays
        flat = {f"{part}.{own}": a for part, held in self.parts.items() for own, a in held.items()}
        with writing_whole(self.path) as file:
            np.savez(file, key=np.array(self.key), **flat)  # type: ignore[arg-type]
        self.written = perf_counter()
