"""Files of surrogates: arrays in NPZ, metadata in JSON, with a checksum and without pickle."""

from __future__ import annotations

import hashlib
import io
import json
import os
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.bounded import open_regular
from viscotack.files.whole import write_whole

Arrays = Mapping[str, npt.NDArray[Any]]

_WORDS = "words.json"


def write(
    path: str | os.PathLike[str], arrays: Arrays, form: str, facts: Mapping[str, Any]
) -> None:
    """Write arrays with their format name, checksum and metadata."""
    words = {"form": form, "sha256": checksum(arrays), **facts}
    text = np.frombuffer(json.dumps(words).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    entries: dict[str, Any] = {**arrays, _WORDS: text}
    np.savez_compressed(buffer, **entries)
    write_whole(path, buffer.getvalue())


@contextmanager
def opened(
    path: str | os.PathLike[str], form: str, what: str, most: float
) -> Iterator[tuple[dict[str, npt.NDArray[Any]], dict[str, Any]]]:
    """Yield the arrays and metadata of a file written by :func:`write`.

    Parameters
    ----------
    path : path
    form : str
        Accepted format name.
    what : str
        Description of the expected content, for error messages.
    most : float
        Largest accepted size [bytes unpacked].

    Raises
    ------
    InputError
        If the file has another format, is damaged, or the body of the ``with`` statement
        fails.
    """
    try:
        # open the file here, because NumPy does not close damaged files
        with open_regular(path) as stream:
            arrays = read_arrays(stream, lambda _: True, most)
        words = json.loads(arrays.pop(_WORDS).tobytes())
        if words["form"] != form:
            raise InputError(f"its format is {words['form']!r}, but this version reads {form!r}")
        if words["sha256"] != checksum(arrays):
            raise InputError("the checksum of its arrays differs from the stored one")
        yield arrays, words
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error) as error:
        raise InputError(f"{path} is not {what}, or is damaged: {error}") from None


def checksum(arrays: Arrays) -> str:
    """Return the SHA-256 of arrays with their names."""
    found = hashlib.sha256()
    for name in sorted(arrays):
        found.update(name.encode())
        found.update(np.ascontiguousarray(arrays[name]).tobytes())
    return found.hexdigest()
