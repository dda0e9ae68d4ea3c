"""A surrogate in a file: arrays in NPZ and words in JSON, no pickle."""

import hashlib
import io
import json
import os
import zlib
from functools import cache
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from viscotack.errors import InputError
from viscotack.files.whole import write_whole

from .model import Scaled, Surrogate
from .network import from_arrays
from .trust import Trust

SHIPPED = Path(__file__).with_name("shipped.npz")
_FORM = "viscotack surrogate 1"
_WORDS = "words.json"


def save(surrogate: Surrogate, path: str | os.PathLike[str], facts: dict[str, Any]) -> None:
    """Write a surrogate, and beside its arrays what is to be known of it.

    Parameters
    ----------
    surrogate : Surrogate
        What to write.
    path : path
        Ends in .npz.
    facts : dict
        How it was made and what it is worth; JSON.
    """
    arrays: dict[str, Any] = {}
    for name in ("start", "fast", "force", "work", "give", "line"):
        part = getattr(surrogate, name)
        networks = part.networks if isinstance(part, Scaled) else part
        if isinstance(part, Scaled):
            arrays |= {f"{name}.centre": part.centre, f"{name}.spread": part.spread}
        arrays |= networks.arrays(f"{name}.")
    trust = surrogate.trust
    arrays |= {"trust.force": trust.force, "trust.work": trust.work, "trust.floors": trust.floors}
    words = {"form": _FORM, "sha256": _digest(arrays), **facts}
    text = np.frombuffer(json.dumps(words).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    arrays[_WORDS] = text
    np.savez_compressed(buffer, **arrays)
    write_whole(path, buffer.getvalue())


def load(path: str | os.PathLike[str]) -> Surrogate:
    """Return the surrogate of a file.

    Raises
    ------
    ValueError
        If the file is not one that :func:`save` wrote, or is damaged.
    """
    return _read(path)[0]


@cache
def shipped() -> Surrogate:
    """Return the surrogate that comes with the package, read once.

    Examples
    --------
    >>> shipped().limits["tabor"]
    (0.01, 10.0)
    """
    return load(SHIPPED)


def facts(path: str | os.PathLike[str] = SHIPPED) -> dict[str, Any]:
    """Return what the file says of how the surrogate was made and what it is worth."""
    return _read(path)[1]


def _read(path: str | os.PathLike[str]) -> tuple[Surrogate, dict[str, Any]]:
    try:
        # opened here, for NumPy leaves a damaged file open
        with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        words = json.loads(arrays.pop(_WORDS).tobytes())
        form, digest = words["form"], words["sha256"]
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error) as error:
        raise InputError(f"{path} is not the file of a surrogate, or damaged: {error}") from None
    if form != _FORM:
        raise InputError(f"{path} has the form {form!r}, this version reads {_FORM!r}")
    if digest != _digest(arrays):
        raise InputError(f"{path} is damaged: its arrays do not have the checksum beside them")
    scaled = {
        name: Scaled(
            from_arrays(arrays, f"{name}."), arrays[f"{name}.centre"], arrays[f"{name}.spread"]
        )
        for name in ("start", "work", "give", "line")
    }
    trust = Trust(arrays["trust.force"], arrays["trust.work"], arrays["trust.floors"])
    fast, force = from_arrays(arrays, "fast."), from_arrays(arrays, "force.")
    return Surrogate(fast=fast, force=force, trust=trust, **scaled), words


def _digest(arrays: dict[str, np.ndarray]) -> str:
    found = hashlib.sha256()
    for name in sorted(arrays):
        found.update(name.encode())
        found.update(np.ascontiguousarray(arrays[name]).tobytes())
    return found.hexdigest()
