"""Read and write surrogates: arrays in NPZ, metadata in JSON with a checksum, without pickle."""

import hashlib
import io
import json
import os
import zlib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.bounded import open_regular
from viscotack.files.whole import write_whole

from .contact import Contact
from .linear_solids import SolidContact
from .model import Surrogate
from .network import Networks, from_arrays
from .physics import SphereContact
from .punch_physics import PunchContact
from .short_range import ShortRangeContact
from .trust import CONFIDENCES, OF, Trust

_FOLDER = Path(__file__).parent
# Files of the package, by the names of their contacts.
FILES = {
    "sphere": _FOLDER / "shipped.npz",
    "solids": _FOLDER / "solids.npz",
    "punch": _FOLDER / "punch.npz",
    "short range": _FOLDER / "short_range.npz",
}
SHIPPED = FILES["sphere"]
_CONTACTS: dict[str, type[Contact]] = {
    each.name: each for each in (SphereContact, SolidContact, PunchContact, ShortRangeContact)
}
_FORM, _WORDS = "viscotack surrogate 4", "words.json"
# Largest accepted file [bytes unpacked]; the largest one of the package has less than one
# megabyte.
_MOST = 50e6
Arrays = Mapping[str, npt.NDArray[Any]]


def save(surrogate: Surrogate, path: str | os.PathLike[str], facts: Mapping[str, Any]) -> None:
    """Write a surrogate with metadata.

    Networks that a contact shares with the sphere on power laws are not stored; the file contains
    their checksum.

    Parameters
    ----------
    surrogate : Surrogate
        Surrogate to write.
    path : path
        Output file, ending in .npz.
    facts : mapping
        Metadata on training and validation, in JSON types.
    """
    if surrogate.move is not None:
        raise InputError("a moved surrogate has no file; keep its points and move it again")
    contact, trust = surrogate.contact, surrogate.trust
    arrays: dict[str, Any] = dict(surrogate.constants)
    for name, networks in surrogate.networks.items():
        if name not in contact.shared:
            arrays |= networks.arrays(f"{name}.")
    if trust is not None:
        arrays |= trust.reach.arrays("trust.")
        arrays |= {"trust.levels": trust.levels, "trust.joint": trust.joint}
    words = {"form": _FORM, "sha256": checksum(arrays), "contact": contact.name, **facts}
    if contact.shared:
        words["power law"] = _checksum_of(surrogate.networks, contact.shared)
    arrays[_WORDS] = np.frombuffer(json.dumps(words).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    write_whole(path, buffer.getvalue())


def load(path: str | os.PathLike[str]) -> Surrogate:
    """Read a surrogate of any contact from a file.

    Raises
    ------
    ValueError
        If the file was not written by :func:`save`, is damaged, or belongs to another surrogate
        of power laws than that of the package.
    """
    return _read(path)[0]


def shipped(contact: str = "sphere") -> Surrogate:
    """Return the surrogate of a contact from the package; it is read once.

    Raises
    ------
    OSError
        If its file is damaged or missing, so that the package must be installed again.

    Examples
    --------
    >>> shipped().limits["tabor"]
    (0.01, 10.0)
    >>> shipped("punch").contact.inputs
    ('size', 'thickness', 'modulus_ratio', 'preload', 'rate')
    """
    return _shipped(contact)


@cache
def _shipped(contact: str) -> Surrogate:
    try:
        return load(FILES[contact])
    except (InputError, FileNotFoundError) as error:
        # no refusal of a question: the installation is broken
        words = "a file of viscotack is damaged; install viscotack again"
        raise OSError(f"{words} ({error})") from None


def facts(path: str | os.PathLike[str] = SHIPPED) -> dict[str, Any]:
    """Return the metadata of a file on training and validation."""
    return _read(path)[1]


def _read(path: str | os.PathLike[str]) -> tuple[Surrogate, dict[str, Any]]:
    try:
        # open the file here, because NumPy does not close damaged files
        with open_regular(path) as stream:
            arrays = read_arrays(stream, lambda _: True, _MOST)
        words = json.loads(arrays.pop(_WORDS).tobytes())
        if words["form"] != _FORM:
            raise InputError(f"its format is {words['form']!r}, but this version reads {_FORM!r}")
        if words["sha256"] != checksum(arrays):
            raise InputError("the checksum of its arrays differs from the stored one")
        return _surrogate(arrays, words), words
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error) as error:
        raise InputError(f"{path} is not the file of a surrogate, or is damaged: {error}") from None


def _surrogate(arrays: Arrays, words: Mapping[str, Any]) -> Surrogate:
    contact = _CONTACTS[words["contact"]]
    for name, array in arrays.items():
        if array.dtype.kind != "f" or not np.all(np.isfinite(array)):
            raise InputError(f"{name} must be finite numbers")
    networks = {n: from_arrays(arrays, f"{n}.") for n in contact.shapes if _stored(n, arrays)}
    for name, each in networks.items():
        _check_layers(name, each, *contact.shapes[name])
    trust = None
    if reach := networks.pop("trust", None):
        trust = Trust(reach, arrays["trust.levels"], arrays["trust.joint"])
        _check_shape("trust.levels", trust.levels, (len(OF), len(CONFIDENCES)))
        _check_shape("trust.joint", trust.joint, (len(CONFIDENCES),))
    constants = {name: arrays[name] for name in contact.sizes}
    for name, shape in contact.sizes.items():
        _check_shape(name, constants[name], shape)
    for name in contact.limiting:
        count, wanted = (len(networks[n].weights[0]) for n in (name, "force"))
        if count not in (1, wanted):
            raise InputError(
                f"the number of networks of the {name} limit must be 1 or {wanted}, as for the "
                f"force, got {count}"
            )
    if contact.shared:
        whole = shipped().networks
        if words["power law"] != _checksum_of(whole, contact.shared):
            raise InputError("it corrects another surrogate of power laws; train it again")
        networks |= {name: whole[name] for name in contact.shared}
    return Surrogate(contact, networks, trust, constants)


def _stored(name: str, arrays: Arrays) -> bool:
    """Return whether a file must have networks; those of intervals are trained last."""
    return name not in ("second", "trust") or f"{name}.weight.0" in arrays


def checksum(arrays: Arrays) -> str:
    """Return the SHA-256 of arrays with their names."""
    found = hashlib.sha256()
    for name in sorted(arrays):
        found.update(name.encode())
        found.update(np.ascontiguousarray(arrays[name]).tobytes())
    return found.hexdigest()


def _checksum_of(networks: Mapping[str, Networks], names: tuple[str, ...]) -> str:
    """Return the checksum of some networks, without intervals."""
    each = [networks[name].arrays(f"{name}.") for name in names]
    return checksum({name: array for arrays in each for name, array in arrays.items()})


def _check_layers(name: str, networks: Networks, inputs: int, outputs: int) -> None:
    """Raise an error if layers do not connect the given numbers of inputs and outputs."""
    if not networks.weights:
        raise InputError(f"layers of {name} are missing")
    width, count = inputs, len(networks.weights[0])
    for i, (weight, bias) in enumerate(zip(networks.weights, networks.biases, strict=True)):
        _check_shape(f"layer {i} of {name}", weight, (count, width, weight.shape[-1]))
        _check_shape(f"biases of layer {i} of {name}", bias, (count, 1, weight.shape[-1]))
        width = weight.shape[-1]
    if width != outputs:
        raise InputError(
            f"layers of {name} have {width} outputs for {inputs} inputs, expected {outputs}"
        )
    scale = {"centre": networks.centre, "spread": networks.spread}
    known = {part: each for part, each in scale.items() if each is not None}
    if len(known) == 1:
        raise InputError(f"{name} has only a {next(iter(known))}; give both centre and spread")
    for part, each in known.items():
        _check_shape(f"{name}.{part}", each, (outputs,))


def _check_shape(name: str, array: npt.NDArray[Any], wanted: tuple[int, ...]) -> None:
    if array.shape != wanted:
        raise InputError(f"{name} must have the shape {wanted}, got {array.shape}")
