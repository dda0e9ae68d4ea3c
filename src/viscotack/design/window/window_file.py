"""Read a window from a TOML file: the contacts of an object, speeds and preloads.

The tables [stamp], [donor] and [receiver] each have the tables of a case file, without its
protocol: [stamp.material], [stamp.interface], [stamp.sphere] or another shape of revolution, and
perhaps a body such as [stamp.layer]. The table [pull] has speeds, preloads, the stiffness and
perhaps temperatures and dwells, [scatter] the scatter of works and preload.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials import Elastic
from viscotack.model.problem import Problem
from viscotack.model.problem.tables import Read, Reading, read_as
from viscotack.model.protocol.moves import Stiffness
from viscotack.model.traction import ages

from ..files import contact, ends, opened
from .chances import WindowScatter
from .opening import aged
from .picking import DONOR, RECEIVER, STAMP

_PER_DECADE, _MOST = 3, 1000


def _numbers(value: Any, reading: Reading, unit: str) -> tuple[float, ...]:
    """Return a quantity, a list of them, or the numbers of a range "1 um/s..1 mm/s"."""
    if isinstance(value, list):
        if not value:
            raise InputError("must not be empty")
        return tuple(reading.parsed(each, unit) for each in value)
    low, *high = ends(value, reading, unit)
    if not high:
        return (low,)
    if not 0 < low < high[0]:
        raise InputError(f"a range begins above 0, got {value!r:.60}")
    count = min(1 + round(_PER_DECADE * np.log10(high[0] / low)), _MOST)
    return tuple(float(x) for x in np.geomspace(low, high[0], max(count, 2)))


def _of(unit: str) -> Read:
    return Read(partial(_numbers, unit=unit))


@dataclass(frozen=True)
class _Pull:
    """The table [pull]: speeds, preloads, the machine, and what more maps are drawn for."""

    speeds: Annotated[tuple[float, ...], _of("m/s")]
    preloads: Annotated[tuple[float, ...], _of("N")]
    stiffness: Stiffness | None = None
    temperatures: Annotated[tuple[float | None, ...], _of("K")] = (None,)
    dwells: Annotated[tuple[float | None, ...], _of("s")] = (None,)


@dataclass(frozen=True)
class WindowFile:
    """One map of a file: the arguments of :func:`viscotack.window`.

    Attributes
    ----------
    stamp, donor, receiver : Problem or None
        The contacts.
    speeds, preloads : tuple of float
        Speeds [m/s] and preloads [N].
    stiffness : float or None
        Of the machine [N/m].
    scatter : WindowScatter or None
        Scatter of works and preload.
    temperature, dwell : float or None
        Temperature [K] and dwell [s] of the contacts, where the file states some.
    """

    stamp: Problem
    donor: Problem | None
    receiver: Problem | None
    speeds: tuple[float, ...]
    preloads: tuple[float, ...]
    stiffness: float | None
    scatter: WindowScatter | None = None
    temperature: float | None = None
    dwell: float | None = None


def read_window(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> tuple[WindowFile, ...]:
    """Read a window from a TOML file: a map for each temperature and dwell.

    Parameters
    ----------
    path : path
        The file; docs/pick_and_print.md describes its tables.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    known = (STAMP, DONOR, RECEIVER, "pull", "scatter")
    tables, reading = opened(path, known, also, beside, not_computed=("shear", "peel", "tilt"))
    pull = read_as(_Pull, tables.get("pull"), reading, "pull")
    scatter = None
    if "scatter" in tables:
        scatter = read_as(WindowScatter, tables["scatter"], reading, "scatter")
    names = [name for name in (STAMP, DONOR, RECEIVER) if name in tables]
    if STAMP not in names or len(names) == 1:
        raise InputError(f"{path}: a window needs [stamp], and [donor], [receiver] or both")
    if pull.temperatures != (None,):
        _check_shifted(reading.where, tables, names)
    maps = []
    for temperature, dwell in product(pull.temperatures, pull.dwells):
        contacts = {
            name: contact(
                tables,
                name,
                reading,
                also,
                # speed and preload of the map replace these
                preload=pull.preloads[0],
                speed=pull.speeds[0],
                temperature=temperature if _has_passport(tables[name]) else None,
            )
            for name in names
        }
        if dwell is not None:
            if not any(ages(each.traction) for each in contacts.values()):
                raise InputError(
                    f"{path}: dwells need an interface that ages, for example [stamp.interface] "
                    'law = "logarithmic-ageing"'
                )
            contacts = {name: aged(each, dwell) for name, each in contacts.items()}
        bases = contacts.get(DONOR), contacts.get(RECEIVER)
        drive = pull.speeds, pull.preloads, pull.stiffness
        maps.append(WindowFile(contacts[STAMP], *bases, *drive, scatter, temperature, dwell))
    return tuple(maps)


def _has_passport(tables: Any) -> bool:
    material = tables.get("material") if isinstance(tables, Mapping) else None
    return isinstance(material, Mapping) and "passport" in material


def _check_shifted(path: str, tables: Mapping[str, Any], names: list[str]) -> None:
    """Raise an InputError unless temperatures change all viscoelastic contacts."""
    for name in names:
        material = tables[name].get("material", {}) if isinstance(tables[name], Mapping) else {}
        is_plain = isinstance(material, Mapping) and material.get("model") == Elastic.word
        if not is_plain and not _has_passport(tables[name]):
            raise InputError(
                f"{path}: temperatures need the shift of the times of [{name}.material]; state it "
                'by a passport, passport = "pdms.toml"'
            )
