"""A surrogate in a file: arrays in NPZ and words in JSON, no pickle."""

import os
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError

from . import sealed
from .model import Scaled, Surrogate
from .network import from_arrays
from .trust import CONFIDENCES, INPUTS, OF, Trust

SHIPPED = Path(__file__).with_name("shipped.npz")
_FORM = "viscotack surrogate 2"
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
        arrays |= getattr(surrogate, name).arrays(f"{name}.")
    trust = surrogate.trust
    arrays |= trust.reach.arrays("trust.") | {"trust.levels": trust.levels}
    sealed.write(path, arrays, _FORM, facts)


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
    with sealed.opened(path, _FORM, "the file of a surrogate", _MOST) as (arrays, words):
        _check(arrays)
        scaled = {name: Scaled.of(arrays, f"{name}.") for name in ("start", "work", "give", "line")}
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
