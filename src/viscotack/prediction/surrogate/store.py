"""Read and write surrogates: arrays in NPZ, metadata in JSON with a checksum, without pickle.

Networks are the arrays ``NAME.weight.I`` and ``NAME.bias.I``, scaled by ``NAME.centre`` and
``NAME.spread``; arrays without a point in their name are constants of the contact.
"""

import hashlib
import io
import json
import os
import zlib
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.whole import write_whole

from .contact import Contact
from .model import Surrogate
from .network import Networks, from_arrays
from .trust import Trust

_FOLDER = Path(__file__).parent
# Files of the package, by the names of their contacts.
FILES = {
    "sphere": _FOLDER / "shipped.npz",
    "solids": _FOLDER / "solids.npz",
    "punch": _FOLDER / "punch.npz",
    "short range": _FOLDER / "short_range.npz",
}
SHIPPED = FILES["sphere"]
# Module and class of each contact, imported on first use.
_CONTACTS = {
    "sphere": ("physics", "SphereContact"),
    "solids": ("linear_solids", "SolidContact"),
    "punch": ("punch_physics", "PunchContact"),
    "short range": ("short_range", "ShortRangeContact"),
}
_FORM, _WORDS = "viscotack surrogate 4", "words.json"
# Largest accepted file [bytes unpacked]; the largest one of the package has less than one
# megabyte.
_MOST = 50e6


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
    contact, trust = surrogate.contact, surrogate.trust
    own = [name for name in surrogate.networks if name not in contact.shared]
    arrays: dict[str, Any] = {**surrogate.constants, **_arrays(surrogate.networks, own)}
    if trust is not None:
        arrays |= trust.reach.arrays("trust.")
        arrays |= {"trust.levels": trust.levels, "trust.joint": trust.joint}
    words = {"form": _FORM, "sha256": checksum(arrays), "contact": contact.name, **facts}
    if contact.shared:
        words["power law"] = checksum(_arrays(surrogate.networks, contact.shared))
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
        with open(path, "rb") as stream:
            arrays = read_arrays(stream, lambda _: True, _MOST)
        words = json.loads(arrays.pop(_WORDS).tobytes())
        if words["form"] != _FORM:
            raise InputError(f"its format is {words['form']!r}, but this version reads {_FORM!r}")
        if words["sha256"] != checksum(arrays):
            raise InputError("the checksum of its arrays differs from the stored one")
        module, kind = _CONTACTS[words["contact"]]
        contact: type[Contact] = getattr(import_module(f".{module}", __package__), kind)
        names = dict.fromkeys(key.partition(".")[0] for key in arrays if ".weight." in key)
        networks = {name: from_arrays(arrays, f"{name}.") for name in names}
        trust = None
        if reach := networks.pop("trust", None):
            trust = Trust(reach, arrays["trust.levels"], arrays["trust.joint"])
        if contact.shared:
            whole = shipped().networks
            if words["power law"] != checksum(_arrays(whole, contact.shared)):
                raise InputError("it corrects another surrogate of power laws; train it again")
            networks |= {name: whole[name] for name in contact.shared}
        constants = {name: array for name, array in arrays.items() if "." not in name}
        return Surrogate(contact, networks, trust, constants), words
    except FileNotFoundError:
        raise
    except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error) as error:
        raise InputError(f"{path} is not the file of a surrogate, or is damaged: {error}") from None


def _arrays(networks: Mapping[str, Networks], names: Iterable[str]) -> dict[str, Array]:
    """Return the arrays of some networks by their names in a file."""
    return {key: a for name in names for key, a in networks[name].arrays(f"{name}.").items()}


def checksum(arrays: Mapping[str, npt.NDArray[Any]]) -> str:
    """Return the SHA-256 of arrays with their names."""
    found = hashlib.sha256()
    for name in sorted(arrays):
        found.update(name.encode())
        found.update(np.ascontiguousarray(arrays[name]).tobytes())
    return found.hexdigest()
