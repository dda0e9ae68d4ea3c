"""Arrays in NumPy's archives, looked at before anything of them is unpacked."""

import math
import zipfile
from collections.abc import Callable
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

# A file of a few megabytes can say that it holds terabytes. What is ours is far below [bytes].
MOST = 1e9
# Longest beginning of an array in which its shape is stated [bytes].
_HEADER = 70_000


def read_arrays(
    file: IO[bytes], expected: Callable[[str], bool], most: float = MOST
) -> dict[str, npt.NDArray[Any]]:
    """Return the arrays of an archive, nothing of which is executed.

    Parameters
    ----------
    file : binary file
        As ``numpy.savez_compressed`` wrote it.
    expected : callable
        Whether an array of this name belongs in it.
    most : float
        How large all of them may be when they are unpacked [bytes].

    Raises
    ------
    InputError
        If it is no archive, has something else in it, or is larger; also ValueError, OSError,
        zlib.error and zipfile.BadZipFile where it is damaged.
    """
    if not zipfile.is_zipfile(file):
        raise InputError("it is not an archive")
    with zipfile.ZipFile(file) as archive:
        members = archive.infolist()
        names = [member.filename.removesuffix(".npy") for member in members]
        strange = [n for n, m in zip(names, members, strict=True) if n == m.filename]
        strange += [name for name in names if not expected(name)]
        if strange or len(set(names)) < len(names):
            raise InputError(f"it has something in it that does not belong: {strange[:1] or names}")
        size = sum(member.file_size for member in members)
        if size > most:
            raise InputError(
                f"unpacked it would have {size / 1e6:.0f} MB, more than the {most / 1e6:.0f} MB "
                "that are taken"
            )
        for member in members:
            _check_shape(archive, member)
    file.seek(0)
    with np.load(file, allow_pickle=False) as parts:
        return {name: parts[name] for name in parts.files}


def _check_shape(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> None:
    """Refuse an array that says it has other numbers than there are bytes for."""
    with archive.open(member) as file:
        version = np.lib.format.read_magic(file)
        read = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }.get(version)
        if read is None:
            raise InputError(f"{member.filename} has a form that is not known, {version}")
        shape, _, kind = read(file)
        stated = math.prod(shape) * kind.itemsize
        there = member.file_size - file.tell()
        if any(n < 0 for n in shape) or stated != there or file.tell() > _HEADER:
            raise InputError(
                f"{member.filename} says that it has {stated} bytes of numbers, and has {there}"
            )
