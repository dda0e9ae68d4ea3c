"""Published materials, each a passport with its source.

The list is short, because the numbers of each material were read in its source. Add one by a file
in the folder `published`, whose name is that of the material, and its test in test_library.py.
"""

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_file import read_passport

_FOLDER = Path(__file__).parent / "published"
MATERIALS = tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


@lru_cache
def published(name: str) -> Passport:
    """Return the passport of a published material by its short name.

    Returns
    -------
    Passport
        Material, temperature, shift and source.

    Raises
    ------
    ValueError
        If the library has no such material.

    Examples
    --------
    >>> published("pdms-10-1").material.exponent
    0.2207
    """
    if name not in MATERIALS:
        raise InputError(f"no published material {name!r}; the library has {', '.join(MATERIALS)}")
    return read_passport(_FOLDER / f"{name}.toml")


def passport_of(name: str, *, also: Iterable[Any] = ()) -> Passport:
    """Return the passport in a file, or that of a published material.

    Parameters
    ----------
    name : str
        Path of the file, or short name of the published material.
    also : iterable of classes
        User-defined materials that the file may name.

    Raises
    ------
    ValueError
        If it is neither, or the file is not a passport.
    """
    if name in MATERIALS:
        return published(name)
    if not name.endswith(".toml") and not Path(name).exists():
        raise InputError(
            f"{name!r} is neither a passport (FILE.toml) nor a published material "
            f"({', '.join(MATERIALS)})"
        )
    return read_passport(name, also=also)
