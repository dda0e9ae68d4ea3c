"""Published materials with their source.

The list is short, because each material is checked against its publication. Add one by a function
like those below.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.materials.passport import Evidence, Origin, Passport
from viscotack.materials.passport_file import read_passport
from viscotack.materials.power_law import RetardationPowerLaw
from viscotack.materials.shift import WLF


def pdms_10_1() -> Passport:
    """Return the passport of PDMS (Sylgard 184, resin to curing agent 10:1, 2 h at 70 C), Eq. 4.27.

    Tensile DMA at 1 Hz and 0.1 % strain, -130 to 20 C in steps of 10 K, shifted to 20 C by WLF
    with a glass transition at -115 C; modified power law in its retardation form. k is
    1.458/3089 = 4.720e-4. The thesis states no Poisson ratio; 0.5 is assumed.

    Examples
    --------
    >>> f"{pdms_10_1().material.modulus_ratio:.3e}"
    '4.720e-04'
    """
    shift = WLF.from_glass_transition(158.15).at_reference(293.15)
    decades = float(np.asarray(shift.log10_shift(143.15)))
    return Passport(
        name="PDMS 10:1 (Sylgard 184)",
        material=RetardationPowerLaw(
            rubbery_modulus=1.458e6,
            glassy_modulus=3.089e9,
            exponent=0.2207,
            tau0=0.01876,
            poisson_ratio=0.5,
        ),
        temperature=293.15,
        shift=shift,
        temperatures=(143.15, 293.15),
        frequencies=(2 * np.pi, 2 * np.pi * 10**decades),
        measured="E",
        origin=Origin(
            reference="Maghami, PhD thesis (2025), Sec. 4.6.1, Eq. 4.25 and 4.27",
            doi="10.1016/j.jmps.2024.105844",
        ),
        evidence=Evidence(
            numbers=32,
            constants=4,
            level=0.9,
            undetermined=(
                "no intervals were published",
                "the coldest points lie below the glass transition, where WLF is not valid: the "
                "glassy modulus and the highest frequencies depend on them",
            ),
        ),
    )


MATERIALS: dict[str, Callable[[], Passport]] = {"pdms-10-1": pdms_10_1}


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
    return MATERIALS[name]()


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
