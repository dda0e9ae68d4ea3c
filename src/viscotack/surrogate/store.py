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
from viscotack.files.archive import read_arrays
from viscotack.files.whole import write_whole

from .model import Scaled, Surrogate
from .network import from_arrays
from .trust import CONFIDENCES, INPUTS, OF, Trust

SHIPPED = Path(__file__).with_name("shipped.npz")
_FORM = "viscotack surrogate 2"
_WORDS = "words.json"
# Largest file that is taken [bytes unpacked]: the one that is shipped has half a megabyte.
_MOST = 50e6
# How many inputs each of the networks has.
_INPUTS = {
    "start": 2,
    "fast": 3,
    "force": 5,
    "work": 9,
    "give": 10,
    "line": 10,
    "trust": INPUTS,
}


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
    arrays |= trust.reach.arrays("trust.") | {"trust.levels": trust.levels}
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
        with open(path, "rb") as stream:
            arrays = read_arrays(stream, lambda _: True, _MOST)
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
    try:
        _check(arrays)
    except (KeyError, ValueError) as error:
        raise InputError(f"{path} is not the file of a surrogate: {error}") from None
    scaled = {
        name: Scaled(
            from_arrays(arrays, f"{name}."), arrays[f"{name}.centre"], arrays[f"{name}.spread"]
        )
        for name in ("start", "work", "give", "line")
    }
    trust = Trust(from_arrays(arrays, "trust."), arrays["trust.levels"])
    fast, force = from_arrays(arrays, "fast."), from_arrays(arrays, "force.")
    return Surrogate(fast=fast, force=force, trust=trust, **scaled), words


def _check(arrays: dict[str, np.ndarray]) -> None:
    """Refuse arrays that do not fit to one another, or are not finite numbers."""
    for name, array in arrays.items():
        if array.dtype.kind != "f" or not np.all(np.isfinite(array)):
            raise InputError(f"{name} must be finite numbers")
    for name, inputs in _INPUTS.items():
        networks = from_arrays(arrays, f"{name}.")
        if not networks.weights:
            raise InputError(f"it has no layers of {name}")
        width, count = inputs, len(networks.weights[0])
        for i, (weight, bias) in enumerate(zip(networks.weights, networks.biases, strict=True)):
            shape = (count, width, weight.shape[-1])
            if weight.shape != shape or bias.shape != (count, 1, shape[-1]):
                raise InputError(
                    f"layer {i} of {name} must have the shape {shape}, got {weight.shape} with "
                    f"biases {bias.shape}"
                )
            width = shape[-1]
        for part in ("centre", "spread"):
            scale = arrays.get(f"{name}.{part}")
            if scale is not None and np.broadcast_shapes(scale.shape, (width,)) != (width,):
                raise InputError(f"{name}.{part} must have {width} numbers, got {scale.shape}")
    levels, wanted = arrays["trust.levels"], (len(OF), len(CONFIDENCES))
    if levels.shape != wanted:
        raise InputError(f"trust.levels must have the shape {wanted}, got {levels.shape}")
    members = {name: len(arrays[f"{name}.weight.0"]) for name in ("fast", "force")}
    if members["fast"] not in (1, members["force"]):
        raise InputError(
            f"it has {members['fast']} networks of the fast limit for {members['force']} of the "
            "force; give one, or one for each"
        )


def _digest(arrays: dict[str, np.ndarray]) -> str:
    found = hashlib.sha256()
    for name in sorted(arrays):
        found.update(name.encode())
        found.update(np.ascontiguousarray(arrays[name]).tobytes())
    return found.hexdigest()
