"""Arrays in NumPy archives (.npz), and the size of archives."""

import zipfile
from collections.abc import Callable
from tokenize import TokenError
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

# Largest size of an archive when unpacked: results with their fields, maps [bytes].
LARGEST_UNPACKED = 1e9


def read_arrays(
    file: IO[bytes], expected: Callable[[str], bool], most: float = LARGEST_UNPACKED
) -> dict[str, npt.NDArray[Any]]:
    """Read the arrays of an archive without executing any of its content.

    Parameters
    ----------
    file : binary file
        As written by ``numpy.savez_compressed``.
    expected : callable
        Called with the name of an array; returns whether the archive may contain it.
    most : float
        Largest total size of the unpacked arrays [bytes].

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
    if not check_unpacked(file, most):
        raise InputError("it is not a NumPy archive")
    file.seek(0)
    try:
        with np.load(file, allow_pickle=False) as parts:
            if strange := [name for name in parts.files if not expected(name)]:
                raise InputError(f"it contains an unexpected array: {strange[:1]}")
            return {name: parts[name] for name in parts.files}
    except (MemoryError, TokenError) as error:
        raise InputError(f"it is not a NumPy archive, or damaged: {error}") from None


def check_unpacked(file: IO[bytes], most: float = LARGEST_UNPACKED) -> bool:
    """Refuse a zip archive that unpacks to more bytes than `most`; whether it is an archive."""
    if not zipfile.is_zipfile(file):
        return False
    try:
        with zipfile.ZipFile(file) as archive:
            size = sum(member.file_size for member in archive.infolist())
    except zipfile.BadZipFile as error:
        raise InputError(f"it is a damaged archive: {error}") from None
    if size > most:
        raise InputError(
            f"it has {size / 1e6:.0f} MB when unpacked, more than the limit of {most / 1e6:.0f} MB"
        )
    return True
