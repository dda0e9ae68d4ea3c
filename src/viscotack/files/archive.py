"""Arrays in NumPy archives (.npz), checked before they are unpacked."""

import math
import os
import zipfile
from collections.abc import Callable
from tokenize import TokenError
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from .bounded import check_unpacked

# The header of a small file can declare terabytes. Files of this package are far smaller [bytes].
MOST = 1e9
# Longest header of an array, which contains its shape [bytes].
_HEADER = 70_000


def read_arrays(
    file: IO[bytes], expected: Callable[[str], bool], most: float = MOST
) -> dict[str, npt.NDArray[Any]]:
    """Read the arrays of an archive without executing any of its content.

    Parameters
    ----------
    file : binary file
        As written by ``numpy.savez_compressed``.
    expected : callable
        Called with the name of an array; returns whether the archive may contain it.
    most : float
        Largest total size of the unpacked arrays [bytes]; at most 50 MB and 50 times the size of
        the file.

    Returns
    -------
    dict of str to ndarray
        The arrays by name.

    Raises
    ------
    InputError
        If the file is not an archive, contains an unexpected member, or is too large. A damaged
        file may also raise ValueError, OSError, zlib.error or zipfile.BadZipFile.
    """
    if not zipfile.is_zipfile(file):
        raise InputError("it is not a NumPy archive")
    with zipfile.ZipFile(file) as archive:
        members = archive.infolist()
        names = [member.filename.removesuffix(".npy") for member in members]
        strange = [n for n, m in zip(names, members, strict=True) if n == m.filename]
        strange += [name for name in names if not expected(name)]
        if strange or len(set(names)) < len(names):
            raise InputError(f"it contains an unexpected array: {strange[:1] or names}")
        size = sum(member.file_size for member in members)
        if size > most:
            raise InputError(
                f"it has {size / 1e6:.0f} MB when unpacked, more than the limit of "
                f"{most / 1e6:.0f} MB"
            )
        check_unpacked(size, file.seek(0, os.SEEK_END))
        for member in members:
            _check_shape(archive, member)
    file.seek(0)
    with np.load(file, allow_pickle=False) as parts:
        return {name: parts[name] for name in parts.files}


def _check_shape(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> None:
    """Raise InputError if the declared size of an array differs from its number of bytes."""
    with archive.open(member) as file:
        version = np.lib.format.read_magic(file)
        read = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }.get(version)
        if read is None:
            raise InputError(f"{member.filename} has the unknown format version {version}")
        try:
            shape, _, kind = read(file)
        except TokenError as error:
            raise InputError(
                f"the header of {member.filename} is damaged: {error.args[0]}"
            ) from None
        stated = math.prod(shape) * kind.itemsize
        there = member.file_size - file.tell()
        if any(n < 0 for n in shape) or stated != there or file.tell() > _HEADER:
            raise InputError(
                f"the header of {member.filename} declares {stated} bytes of numbers, the file "
                f"contains {there}"
            )
