"""Read an array from a TOML file: one pad, the places of all, the backing, pull and load.

The table [pad] has the tables of a case file without its protocol: [pad.material],
[pad.interface], [pad.sphere] or another shape of revolution. [array] has rows, columns and spacing,
or positions; [pull] speed and preload; [backing] and [hold] are optional.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from viscotack.cards import Exact, Pairs, Quantity, cards
from viscotack.errors import InputError
from viscotack.model.problem.tables import Read, Reading, read_as, refuse_named
from viscotack.model.protocol.moves import Speed

from ..files import at, contact, opened
from .load import Hold
from .pulling import MOST_PADS, Backing, PadArray, grid
from .scatter import Scatter, check_draws

_TABLES = ("pad", "array", "backing", "pull", "hold")
# Names of a viscoelastic base, which is not computed.
_VISCOELASTIC = ("base_material", "base_glassy", "base_tau", "base_exponent", "base_rubbery")


@dataclass(frozen=True)
class _Pull:
    """The table [pull]."""

    speed: Speed
    preload: Annotated[float, Quantity("N", "P", "preload of all pads", example="20 mN")]
    hold_time: Annotated[float, Quantity("s", "t", "time held", example="10 s")] | None = None


def _numbers(value: Any, reading: Reading, unit: str) -> tuple[float, ...]:
    if not isinstance(value, list):
        raise InputError(f"must be a list, one entry for each pad, got {value!r:.60}")
    return tuple(reading.parsed(each, unit) for each in value)


@dataclass(frozen=True)
class _Layout:
    """The table [array]: rows, columns and spacing, or positions; heights, works and scatter."""

    positions: (
        Annotated[
            tuple[tuple[float, float], ...],
            Pairs(("m", "m"), "x, y", "x and y", example='[["0 mm", "0 mm"], ["4 mm", "0 mm"]]'),
        ]
        | None
    ) = None
    rows: Annotated[int, Exact] | None = None
    columns: Annotated[int, Exact] | None = None
    spacing: (
        Annotated[float, Quantity("m", "d", "distance of the pads", above=0, example="4 mm")] | None
    ) = None
    heights: Annotated[tuple[float, ...], Read(partial(_numbers, unit="m"))] = ()
    works: Annotated[tuple[float, ...], Read(partial(_numbers, unit="1"))] = ()
    height_scatter: Annotated[float, cards(Scatter)["height"].card] | None = None
    work_scatter: Annotated[float, cards(Scatter)["work"].card] | None = None
    seed: Annotated[int, Exact] = 0
    draws: Annotated[int, Exact] = 300

    def __post_init__(self) -> None:
        if self.seed < 0 or self.draws < 0:
            raise InputError("seed and draws must be whole numbers that are not negative")
        if self.positions is None and None in (self.rows, self.columns, self.spacing):
            raise InputError(
                "an array needs rows, columns and spacing, or positions; write for example "
                'rows = 3, columns = 3, spacing = "4 mm"'
            )
        for name in ("rows", "columns"):
            if not 0 < (getattr(self, name) or 1) <= MOST_PADS:
                raise InputError(f"{name} must be a number from 1 to {MOST_PADS:,}")
        if (self.rows or 1) * (self.columns or 1) > MOST_PADS:
            raise InputError(f"an array has 1 to {MOST_PADS:,} pads")

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Places of the pads [m]."""
        if self.positions is not None:
            return self.positions
        return grid(self.rows or 1, self.columns or 1, self.spacing or 0.0)

    @property
    def scatter(self) -> Scatter | None:
        """Scatter of heights and works; None if neither is stated."""
        if self.height_scatter is self.work_scatter is None:
            return None
        return Scatter(self.height_scatter or 0.0, self.work_scatter or 0.0, self.seed)


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
    tables, reading = opened(path, _TABLES, also, beside, not_computed=("shear", "peel"))
    backing = tables.get("backing", {})
    if isinstance(backing, Mapping):
        refuse_named(
            reading.where,
            backing,
            _VISCOELASTIC,
            "the common base is elastic, because point loads have no memory here; base_modulus may "
            "be the relaxed modulus for a slow pull, or the glassy one for a fast pull",
        )
    pull = read_as(_Pull, tables.get("pull"), reading, "pull")
    pad = contact(tables, "pad", reading, also, preload=pull.preload, speed=pull.speed)
    layout = read_as(_Layout, tables.get("array"), reading, "array")
    carried = read_as(Backing, backing, reading, "backing")
    with at(f"{path}, [array]"):
        places, scatter = layout.places, layout.scatter
        check_draws(layout.draws, len(places))
        array = PadArray(pad, places, heights=layout.heights, works=layout.works, backing=carried)
    hold = read_as(Hold, tables["hold"], reading, "hold") if "hold" in tables else None
    return ArrayFile(array, pull.speed, pull.preload, scatter, layout.draws, hold, pull.hold_time)
