"""Validated, read-only columns of measured numbers.

The frozen dataclasses of :mod:`viscotack.lab.sweeps` store their columns with these functions.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.materials.constants import poisson_ratio as checked_poisson_ratio

KINDS = {"E": "tension", "G": "shear"}


def check_kind(kind: Any) -> None:
    """Raise an error unless the kind of modulus is "E" (tensile) or "G" (shear)."""
    if kind not in KINDS:
        raise InputError(f"kind must be 'E' (tensile) or 'G' (shear), got {kind!r}")


def store_temperature(instance: Any, name: str) -> None:
    """Store one temperature [K] as a float, or None where it is unknown."""
    value = getattr(instance, name)
    if value is None:
        return
    number = float(value)
    if not 0 < number < np.inf:
        raise InputError(f"{name} must be positive [K], got {value!r}; give Celsius + 273.15")
    object.__setattr__(instance, name, number)


def array(name: str, values: npt.ArrayLike, unit: str, length: int | None = None) -> Array:
    """Return a copy as a one-dimensional array of floats, of a given length."""
    row = np.array(values, dtype=float)
    if row.ndim != 1 or not row.size:
        raise InputError(f"{name} must be a row of numbers [{unit}], got shape {row.shape}")
    if length is not None and row.size != length:
        raise InputError(f"{name} has {row.size} values where the others have {length}")
    return row


def store_columns(instance: Any, **units: tuple[str, bool]) -> None:
    """Store positive read-only arrays of one length; some columns may contain nan (unknown)."""
    length = None
    for name, (unit, may_miss) in units.items():
        row = array(name, getattr(instance, name), unit, length)
        length = row.size
        wrong = row[~((row > 0) & (row < np.inf) | (may_miss & np.isnan(row)))]
        if wrong.size:
            cure = "; give Celsius + 273.15" if unit == "K" else ""
            raise InputError(f"{name} must be positive and finite [{unit}], got {wrong[0]:g}{cure}")
        store(instance, name, row)


def store_whole(instance: Any, name: str, values: npt.ArrayLike, length: int) -> None:
    """Store a row of whole numbers as a read-only array."""
    row = array(name, values, "-", length)
    broken = row[row != np.round(row)]
    if broken.size:
        raise InputError(f"{name} must be whole numbers, got {broken[0]:g}")
    store(instance, name, row.astype(np.int64))


def store(instance: Any, name: str, row: npt.NDArray[Any]) -> None:
    """Store a read-only array."""
    row.flags.writeable = False
    object.__setattr__(instance, name, row)


def sort_along(instance: Any, along: Array) -> None:
    """Sort all columns of a curve in ascending order of one of them."""
    order = np.argsort(along, kind="stable")
    for name, values in vars(instance).items():
        if isinstance(values, np.ndarray):
            store(instance, name, values[order])


def chosen(instance: Any, points: npt.ArrayLike) -> Any:
    """Return a copy with the selected points."""
    columns = {
        name: values[np.asarray(points)]
        for name, values in vars(instance).items()
        if isinstance(values, np.ndarray)
    }
    return replace(instance, **columns)


def in_tension(instance: Any, poisson_ratio: float, *names: str, power: int = 1) -> Any:
    """Convert shear to tensile moduli; a note records the Poisson ratio used."""
    nu = checked_poisson_ratio(poisson_ratio)
    if instance.kind == "E":
        return instance
    factor = (2 * (1 + nu)) ** power
    return replace(
        instance,
        kind="E",
        source=instance.source.noted(f"shear converted to tension with Poisson ratio {nu:g}"),
        **{name: factor * getattr(instance, name) for name in names},
    )
