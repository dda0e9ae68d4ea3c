"""What a caller states about a file that does not state it: units, columns, table."""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .formats.file import LabFile
from .formats.headings import (
    COLUMNS,
    POSSIBLE,
    bare,
    kelvin,
    plain,
    radians_per_second,
    scale,
)
from .sweeps import KINDS

_COLUMN = re.compile(r"([^=]+)=\s*(.*\S)\s*")
_BRACKET = re.compile(r"(.*\S)\s*\[([^\[\]]+)\]")
# the option that states a unit, and examples of it
UNIT_OPTIONS = {
    "Pa": ("modulus_unit", "Pa, kPa or MPa"),
    "1/Pa": ("modulus_unit", "Pa, kPa or MPa, of the stress"),
    "s": ("time_unit", "s or min"),
    "K": ("temperature_unit", "degC or K"),
    "Hz": ("frequency_unit", "Hz or rad/s"),
    "N": ("force_unit", "N or mN"),
    "m": ("length_unit", "mm or um"),
}


class Column(NamedTuple):
    """A column chosen by the caller: its heading or number, and its unit ("" if in the file)."""

    name: str
    unit: str


@dataclass(frozen=True, kw_only=True)
class FileOptions:
    """What the caller states about any file; see :class:`Options` and :class:`TackOptions`."""

    format: str | None = None
    time_unit: str | None = None
    temperature_unit: str | None = None
    temperature_in_name: bool = False
    decimal: str | None = None
    where: str | None = None

    def __post_init__(self):
        if self.decimal not in (None, ".", ","):
            raise InputError(f"`decimal` must be . or , got {self.decimal!r}")
        if self.temperature_unit is not None:
            kelvin(self.temperature_unit)
        for target in ("Pa", "s", "N", "m"):
            if unit := self.unit(target):
                try:
                    scale(unit, target)
                except InputError as error:
                    name = UNIT_OPTIONS[target][0]
                    raise InputError(f"`{name}`: {error}", field=name) from None

    def check_format(self, formats: Iterable[str]) -> None:
        """Raise an error unless the format is one of these or to be detected."""
        if self.format not in (None, *formats):
            raise InputError(f"`format` must be one of {', '.join(formats)}, got {self.format!r}")

    @property
    def chosen(self) -> Mapping[str, Column]:
        """Columns chosen by the caller, by quantity."""
        return {}

    @property
    def names(self) -> tuple[str, ...]:
        """Headings and numbers of the columns chosen by the caller."""
        return tuple(column.name for column in self.chosen.values())

    def unit(self, target: str) -> str:
        """Return the unit given by the caller for columns without one, empty if none."""
        own = getattr(self, UNIT_OPTIONS.get(target, ("",))[0], None) or ""
        return f"1/({bare(own)})" if own and target == "1/Pa" else own


@dataclass(frozen=True, kw_only=True)
class Options(FileOptions):
    """What the caller states about a file, for files that do not state it.

    Parameters
    ----------
    format : str, optional
        One of :data:`viscotack.lab.FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if neither the headings nor the text around them state it, or
        to select one if the file has both.
    temperature : float, optional
        Temperature of all points [K].
    frequency_unit : str, optional
        ``"Hz"`` or ``"rad/s"``, if the file states no unit or 1/s. An angular frequency
        without a unit is assumed to be in rad/s, with a note.
    modulus_unit : str, optional
        Such as ``"MPa"``; also of a stress.
    time_unit : str, optional
        Such as ``"s"``.
    temperature_unit : str, optional
        ``"degC"``, ``"K"`` or ``"degF"``, of a column or of a number above columns.
    temperature_in_name : bool
        Whether to read the temperature from the file name, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.
    step_start : float
        Time at which the step was applied [s], not negative, if the file counts time from the start
        of the whole test.
    columns : str, optional
        Quantities, each with the heading or the number (from 1) of its column and, if the file
        does not state it, a unit: ``"time=1 [s]; modulus=G(t) raw [kPa]"``.
    where : str, optional
        Rows to read, by the heading and the content of a column: ``"Sample=A; Position=2"``.
    table : str, optional
        Number (from 1) of one of several tables in a file, or the name of its sheet.

    Raises
    ------
    ValueError
        If a value is not one of those above, or a unit does not suit its quantity.

    Examples
    --------
    >>> Options(columns="time=1 [s]; modulus=G(t)").chosen["time"]
    Column(name='1', unit='s')
    """

    kind: str | None = None
    temperature: float | None = None
    frequency_unit: str | None = None
    modulus_unit: str | None = None
    step_start: float = 0.0
    columns: str | None = None
    table: str | None = None

    def __post_init__(self):
        super().__post_init__()
        if self.kind is not None and self.kind not in KINDS:
            raise InputError(f"`kind` must be E (tensile) or G (shear), got {self.kind!r}")
        if self.temperature is not None and not POSSIBLE[0] < self.temperature < POSSIBLE[1]:
            raise InputError(f"`temperature` must be above 0 K, got {self.temperature!r} K")
        if self.temperature is not None and self.temperature_in_name:
            raise InputError("give either `temperature` or `temperature_in_name`, not both")
        if not 0 <= self.step_start < math.inf:
            raise InputError(f"`step_start` must not be negative, got {self.step_start!r} s")
        if self.frequency_unit is not None:
            radians_per_second(self.frequency_unit, angular="rad" in self.frequency_unit)
        _ = self.chosen

    @cached_property
    def chosen(self) -> Mapping[str, Column]:
        """Columns chosen by the caller, by quantity."""
        found = {}
        for part in filter(str.strip, (self.columns or "").split(";")):
            match = _COLUMN.fullmatch(part)
            quantity = COLUMNS.get(plain(match[1])) if match else None
            if match is None or quantity is None:
                known = f"of {', '.join(sorted(set(COLUMNS.values())))}, got {part.strip()!r}"
                raise InputError(f'`columns` must be like "frequency=1 [Hz]; loss=3 [Pa]", {known}')
            unit = _BRACKET.fullmatch(match[2])
            found[quantity] = Column(unit[1], unit[2].strip()) if unit else Column(match[2], "")
        return found


@dataclass(frozen=True, kw_only=True)
class TackOptions(FileOptions):
    """What the caller states about files of tack tests, which may not state it.

    Parameters
    ----------
    format : str, optional
        One of :data:`viscotack.lab.tack.FORMATS`; by default it is detected from the content.
    force_unit, length_unit, time_unit : str, optional
        Such as ``"mN"``, ``"um"`` and ``"s"``, if a heading has no unit. Grams are converted to
        newtons.
    temperature_unit : str, optional
        ``"degC"``, ``"K"`` or ``"degF"``, of a column without a unit.
    force_column, position_column, time_column : str, optional
        Heading or number (from 1) of the column to use, if there are several or none is recognised.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.
    nominal_speed : float, optional
        Set speed [m/s], if a file has no column of time.
    spring_constant, sensitivity : float, optional
        Spring constant [N/m] and deflection by signal [m/A] of a cantilever, if the format
        ``afmformats`` needs them (text of NT-MDT).
    temperature_in_name : bool
        Read the temperature from the name of each file, as in ``probe_25C.csv``; by default from
        a column or a header line with a unit, if there is one.
    where : str, optional
        Rows to read, by the heading and the content of a column: ``"Sample=A"``.
    """

    force_unit: str | None = None
    length_unit: str | None = None
    force_column: str | None = None
    position_column: str | None = None
    time_column: str | None = None
    nominal_speed: float | None = None
    spring_constant: float | None = None
    sensitivity: float | None = None

    @cached_property
    def chosen(self) -> Mapping[str, Column]:
        """Columns chosen by the caller, by quantity."""
        said = {
            "force": self.force_column,
            "travel": self.position_column,  # or another position, by its heading
            "time": self.time_column,
        }
        return {name: Column(text.strip(), "") for name, text in said.items() if text}

    def time_of(self, file: LabFile, position: Array, notes: list[str]) -> Array:
        """Compute the time [s] from the nominal speed."""
        if self.nominal_speed is None:
            raise file.error("there is no column of time; `nominal_speed` replaces it")
        if not 0 < self.nominal_speed < np.inf:
            raise InputError(f"`nominal_speed` must be positive, got {self.nominal_speed!r} m/s")
        notes.append("no column of time: computed from the nominal speed, which is not verified")
        way = np.abs(np.diff(position, prepend=position[0]))
        return np.cumsum(np.where(np.isfinite(way), way, 0.0)) / self.nominal_speed
