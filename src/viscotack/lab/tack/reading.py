"""Read files of tack tests: detect the layout, join intervals, return records in SI.

If a file lacks information, the error names the option of ``viscotack test read`` that supplies it;
the parameters here have the same names, for example ``--force-unit`` and `force_unit`.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from types import ModuleType

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab import tables
from viscotack.lab.joining import kelvin_in_name
from viscotack.lab.lab_file import LabFile, format_of, load, refuse_unknown

from . import (
    afm_layout,
    book_layout,
    ibw_layout,
    jpk_layout,
    jpk_text_layout,
    nid_layout,
    text_layout,
)
from .grid import Given, record
from .headings import factor
from .record import TackRecord

AnyPath = str | PathLike[str]

# format -> module that reads its layout, in order of detection
FORMATS: dict[str, ModuleType] = {
    "afmformats": afm_layout,
    "jpk-force": jpk_layout,
    "jpk-text": jpk_text_layout,
    "nid": nid_layout,
    "ibw": ibw_layout,
    "workbook": book_layout,
    "text": text_layout,
}
_INTERVAL = re.compile(r"(.*?)[ _-]*(?:Interval|Abschnitt|Intervalle)[ _-]*(\d{1,5})", re.I)
# first bytes of formats that are neither text nor workbooks
_RAW = (b"[DataSet]", ibw_layout.START, afm_layout.HDF)


def read(
    paths: AnyPath | Sequence[AnyPath],
    *,
    format: str | None = None,
    force_unit: str | None = None,
    length_unit: str | None = None,
    time_unit: str | None = None,
    force_column: str | None = None,
    position_column: str | None = None,
    time_column: str | None = None,
    decimal: str | None = None,
    nominal_speed: float | None = None,
    spring_constant: float | None = None,
    sensitivity: float | None = None,
    temperature_in_name: bool = False,
    where: str | None = None,
) -> list[TackRecord]:
    r"""Read the records of tack tests, one per continuous period of time.

    Parameters
    ----------
    paths : path-like, or sequence of them
        A text file (CSV, Anton Paar, Bluehill, testXpert, texture analyser, nanoindenter), a
        workbook (testXpert; extra ``lab``), a force curve of a microscope (Nanosurf .nid, JPK
        .jpk-force, Asylum .ibw), or one that afmformats reads (maps of JPK, AFM Workshop, .h5;
        extra ``afm``). Files named ``..._Interval_7.csv`` are intervals of one test and are joined
        in the order of their numbers.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    force_unit, length_unit, time_unit : str, optional
        Such as ``"mN"``, ``"um"`` and ``"s"``, if a heading has no unit. Grams are converted to
        newtons.
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

    Raises
    ------
    ValueError
        If a file cannot be interpreted; the message names the file, the line and what was expected.
    OSError
        If a file cannot be opened.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> lines = [f"{t},{abs(t - 20) / 10 + 1},{max(20 - t, 0)}" for t in range(41)]
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "probe.csv")
    ...     _ = file.write_text("\n".join(["Time [s],Gap [mm],Force [mN]", *lines, ""]))
    ...     (found,) = read(file)
    >>> len(found), found.force.max().item(), found.into
    (41, 0.02, -1)
    """
    given = Given(
        force_unit,
        length_unit,
        time_unit,
        force_column,
        position_column,
        time_column,
        decimal,
        nominal_speed,
        spring_constant,
        sensitivity,
        temperature_in_name,
        where,
    )
    _check(format, given)
    chosen = [paths] if isinstance(paths, str | PathLike) else list(paths)
    if not chosen:
        raise InputError("no file to read; give one or more paths")
    found: list[TackRecord] = []
    for group in _groups(chosen):
        if len(group) == 1:
            found += _records(group[0][1], format, given)
        else:
            found += _joined(group, format, given)
    return found


def _check(format: str | None, given: Given) -> None:
    """Check the caller's options before the file."""
    refuse_unknown(format, FORMATS)
    if given.decimal not in (None, ".", ","):
        raise InputError(f"--decimal must be . or , got {given.decimal!r}")
    for unit, quantity in (
        (given.force_unit, "force"),
        (given.length_unit, "travel"),
        (given.time_unit, "time"),
    ):
        if unit is not None:
            factor(unit, quantity)


def groups(paths: Sequence[AnyPath]) -> list[list[AnyPath]]:
    """Group files by test, with intervals in the order of their numbers."""
    return [[path for _, path in group] for group in _groups(paths)]


def _groups(paths: Sequence[AnyPath]) -> list[list[tuple[int, AnyPath]]]:
    groups: dict[tuple[str, str], list[tuple[int, AnyPath]]] = {}
    for count, path in enumerate(paths):
        match = _INTERVAL.fullmatch(Path(path).stem)
        if match:
            key, place = (str(Path(path).parent), match[1]), int(match[2])
        else:
            key, place = (str(path), f"\0{count}"), 0
        groups.setdefault(key, []).append((place, path))
    return [sorted(group, key=lambda item: item[0]) for group in groups.values()]


def _joined(group: list[tuple[int, AnyPath]], format: str | None, given: Given) -> list[TackRecord]:
    """Read the intervals of one test and join those with consecutive numbers."""
    stretches: list[list[TackRecord]] = []
    before = None
    skipped: list[str] = []
    for number, path in group:
        if not Path(path).stat().st_size:
            # an interval without data
            skipped.append(f"interval {number} is empty")
            continue
        (one,) = _single(_records(path, format, given, few=True), path)
        if before is None or number != before + 1:
            stretches.append([])
        stretches[-1].append(one)
        before = number
    return [_join(parts, tuple(skipped)) for parts in stretches]


def _single(records: list[TackRecord], path: AnyPath) -> list[TackRecord]:
    if len(records) != 1:
        raise InputError(f"{path}: the interval has {len(records)} tables; expected one")
    return records


def _join(parts: list[TackRecord], notes: tuple[str, ...]) -> TackRecord:
    first = parts[0]
    for one, other in zip(parts, parts[1:], strict=False):
        if one.into != other.into:
            raise InputError(
                f"{other.source.path}: its position is another quantity than in the interval before"
            )
        if other.time[0] < one.time[-1]:
            raise InputError(
                f"{other.source.path}: it begins at {other.time[0]:g} s, before the end of the "
                f"previous interval at {one.time[-1]:g} s; give the times of all "
                "intervals from the start of the test"
            )
    said = (f"{len(parts)} intervals joined",) if len(parts) > 1 else ()
    return replace(
        first,
        time=np.concatenate([part.time for part in parts]),
        force=np.concatenate([part.force for part in parts]),
        position=np.concatenate([part.position for part in parts]),
        contact_radius=_column(parts, "contact_radius"),
        temperature=_column(parts, "temperature"),
        source=first.source.noted(*said, *notes),
    )


def _column(parts: list[TackRecord], name: str) -> Array | None:
    """Join a column that some intervals may lack; None if all do."""
    rows = [getattr(part, name) for part in parts]
    if all(row is None for row in rows):
        return None
    pairs = zip(parts, rows, strict=True)
    return np.concatenate([np.full(len(part), np.nan) if x is None else x for part, x in pairs])


def _records(
    path: AnyPath, format: str | None, given: Given, few: bool = False
) -> list[TackRecord]:
    file = load(path, raw=_RAW)
    records = _records_of(file, format, given, few)
    if not given.temperature_in_name:
        return records
    kelvin = kelvin_in_name(file)
    return [replace(one, temperature=np.full(len(one), kelvin)) for one in records]


def _records_of(file: LabFile, format: str | None, given: Given, few: bool) -> list[TackRecord]:
    found = format_of(file, FORMATS, format, "text")
    layout = FORMATS[found]
    # a damaged number may overflow; the record rejects it with its name
    with np.errstate(all="ignore"):
        if layout is afm_layout:
            return layout.records(file, given)
        if layout not in (text_layout, book_layout):
            return layout.records(file)
        if not file.lines and not file.is_workbook:
            raise file.error("the file is neither text nor an Excel workbook; export it as text")
        file = replace(file, notes=(*file.notes, *file.left_out))
        read = tables.where(file, layout.grids(file, given.names), given.where)
        return [record(file, table, given, found, few) for table in read]
