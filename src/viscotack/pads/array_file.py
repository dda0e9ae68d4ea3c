"""Read an array from a TOML file: one pad, the places of all, the backing, pull and load.

The table [pad] has the tables of a case file without its protocol: [pad.material],
[pad.interface], [pad.sphere] or another shape of revolution. [array] has rows, columns and spacing,
or positions; [pull] speed and preload; [backing] and [hold] are optional.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.problem.case_file import case_of_tables
from viscotack.problem.case_table import Table, refuse_named, refuse_unknown

from .payload import Hold
from .pulling import MOST_PADS, Backing, PadArray, grid
from .scatter import Scatter, check_draws

_TABLES = ("pad", "array", "backing", "pull", "hold")
_OF_BACKING = {
    "stiffness": ("N/m", '"2 kN/m"'),
    "pad_stiffness": ("N/m", '"300 N/m"'),
    "base_modulus": ("Pa", '"2 MPa"'),
    "tilt": ("rad", '"0.2 degree"'),
    "tilt_direction": ("rad", '"90 degree"'),
    "curvature": ("1/m", '"0.1 1/m"'),
}
_OF_HOLD = {
    "mass": ("kg", '"2 g"'),
    "acceleration": ("m/s^2", '"10 m/s^2"'),
    "safety_factor": ("1", "2"),
}
_DRAWS = 300
# Names of what is not computed, and of a viscoelastic base.
_ALONG = ("shear", "peel")
_VISCOELASTIC = ("base_material", "base_glassy", "base_tau", "base_exponent", "base_rubbery")


@dataclass(frozen=True)
class ArrayFile:
    """Contents of a file.

    Attributes
    ----------
    array : PadArray
        Pads and backing, without scatter.
    speed, preload : float
        Of the pull [m/s, N].
    scatter : Scatter or None
        Scatter of heights and works.
    draws : int
        Number of arrays drawn for the yield.
    hold : Hold or None
        The load.
    hold_time : float or None
        Time for which the pressed plate is held in place [s].
    """

    array: PadArray
    speed: float
    preload: float
    scatter: Scatter | None
    draws: int
    hold: Hold | None
    hold_time: float | None = None


def read_array(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> ArrayFile:
    """Read an array from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/arrays.md describes its tables.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    path = Path(path)
    tables = read_toml(path)
    refuse_named(
        path, tables, _ALONG, "the plate is pulled along its normal, without shear and peeling"
    )
    refuse_named(
        path,
        tables.get("backing", {}) if isinstance(tables.get("backing"), Mapping) else {},
        _VISCOELASTIC,
        "the common base is elastic, because point loads have no memory here; base_modulus may be "
        "the relaxed modulus for a slow pull, or the glassy one for a fast pull",
    )
    refuse_unknown(f"{path}", tables, _TABLES, "table")
    pull, where = Table(path, "pull", tables), f"{path}, [pad]"
    speed = pull.quantity("speed", "m/s", '"1 mm/s"')
    preload = pull.quantity("preload", "N", '"20 mN"')
    pull.known.add("hold_time")
    waits = "hold_time" in pull.values
    hold_time = pull.quantity("hold_time", "s", '"10 s"') if waits else None
    pull.finish()
    pad = tables.get("pad")
    if not isinstance(pad, Mapping):
        raise InputError(f"{path}: the table [pad] is missing; write [pad.material] and others")
    if "protocol" in pad:
        raise InputError(f"{path}: [pad.protocol] is stated by [pull]; remove it")
    # speed and preload of the pull replace these
    protocol = {"preload_force": f"{preload!r} N", "speed": f"{speed!r} m/s"}
    problem = case_of_tables(
        {**pad, "protocol": protocol}, where=where, also=also, beside=beside or path.parent.joinpath
    )
    layout = Table(path, "array", tables)
    places = _places(layout)
    scatter, draws = _scatter(layout)
    check_draws(draws, len(places))
    array = layout.make(
        PadArray,
        problem,
        places,
        heights=_numbers(layout, "heights", "m"),
        works=_numbers(layout, "works", "1"),
        backing=_optional(path, tables, "backing", Backing, _OF_BACKING) or Backing(),
    )
    layout.finish()
    hold = _optional(path, tables, "hold", Hold, _OF_HOLD)
    return ArrayFile(array, speed, preload, scatter, draws, hold, hold_time)


def _places(table: Table) -> tuple[tuple[float, float], ...]:
    """Return the places of the pads [m]."""
    if "positions" in table.values:
        given = table.get("positions", '[["0 mm", "0 mm"], ["4 mm", "0 mm"]]')
        if not isinstance(given, list) or not all(
            isinstance(p, list) and len(p) == 2 for p in given
        ):
            raise InputError(f"{table.name} positions must be a list of pairs of lengths")
        return tuple(
            (table.parsed("positions", x, "m"), table.parsed("positions", y, "m")) for x, y in given
        )
    rows, columns = (_count(table, key) for key in ("rows", "columns"))
    if rows * columns > MOST_PADS:
        raise InputError(f"{table.name}: an array has 1 to {MOST_PADS:,} pads")
    return grid(rows, columns, table.quantity("spacing", "m", '"4 mm"'))


def _count(table: Table, key: str) -> int:
    number = table.get(key, "3")
    if not isinstance(number, int) or isinstance(number, bool) or not 0 < number <= MOST_PADS:
        raise InputError(f"{table.name} {key} must be a number from 1 to {MOST_PADS:,}")
    return number


def _scatter(table: Table) -> tuple[Scatter | None, int]:
    """Return the scatter of heights and works, and the number of draws."""
    table.known |= {"height_scatter", "work_scatter", "seed", "draws"}
    given = table.values
    if not {"height_scatter", "work_scatter"} & given.keys():
        return None, _DRAWS
    height = table.parsed("height_scatter", given.get("height_scatter", 0.0), "m")
    work = table.quantity("work_scatter", "1") if "work_scatter" in given else 0.0
    seed, draws = given.get("seed", 0), given.get("draws", _DRAWS)
    if any(not isinstance(x, int) or isinstance(x, bool) or x < 0 for x in (seed, draws)):
        raise InputError(f"{table.name} seed and draws must be whole numbers")
    return table.make(Scatter, height=height, work=work, seed=seed), draws


def _numbers(table: Table, key: str, unit: str) -> tuple[float, ...]:
    """Return the numbers of an optional list."""
    table.known.add(key)
    given = table.values.get(key, [])
    if not isinstance(given, list):
        raise InputError(f"{table.name} {key} must be a list, one entry for each pad")
    return tuple(table.parsed(key, each, unit) for each in given)


def _optional(
    path: Path,
    tables: Mapping[str, Any],
    name: str,
    kind: Any,
    numbers: Mapping[str, tuple[str, str]],
) -> Any:
    """Return the object of a table of numbers; None without the table."""
    if name not in tables:
        return None
    table = Table(path, name, tables)
    table.known |= numbers.keys()
    if kind is Hold:
        table.get("mass", numbers["mass"][1])
    found = {
        key: table.quantity(key, unit, example)
        for key, (unit, example) in numbers.items()
        if key in table.values
    }
    table.finish()
    return table.make(kind, **found)
