"""Read files of tack tests: detect the layout, join intervals, return records in SI.

If a file lacks information, the error names the field of :class:`TackOptions` that supplies it.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.formats import microscopes, tables, text, workbook
from viscotack.lab.formats.columns import Columns, refuse_pooled
from viscotack.lab.formats.file import Curve, LabFile, first_fitting, load
from viscotack.lab.formats.headings import POSITIONS, TACK
from viscotack.lab.formats.tables import kelvin_in_name
from viscotack.lab.options import TackOptions
from viscotack.lab.sweeps import Source
from viscotack.units import readable

from .record import TackRecord

AnyPath = str | PathLike[str]

_TABLES = {"workbook": workbook.tables, "text": text.plain}
FORMATS = (*microscopes.READERS, *_TABLES)
_INTERVAL = re.compile(r"(.*?)[ _-]*(?:Interval|Abschnitt|Intervalle)[ _-]*(\d{1,5})", re.I)
_INTO = {"gap": -1, "depth": 1, "travel": 0}
_NEEDED = 20  # smallest number of rows needed to identify the parts of a test


def read(paths: AnyPath | Sequence[AnyPath], **options: Any) -> list[TackRecord]:
    r"""Read the records of tack tests, one per continuous period of time.

    Parameters
    ----------
    paths : path-like, or sequence of them
        A text file (CSV, Anton Paar, Bluehill, testXpert, texture analyser, nanoindenter), a
        workbook (testXpert; extra ``lab``), a force curve of a microscope (Nanosurf .nid, JPK
        .jpk-force, Asylum .ibw), or one that afmformats reads (maps of JPK, AFM Workshop, .h5;
        extra ``afm``). Files named ``..._Interval_7.csv`` are intervals of one test and are joined
        in the order of their numbers.
    **options
        Fields of :class:`viscotack.lab.TackOptions` by name.

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
    given = TackOptions(**options)
    chosen = [paths] if isinstance(paths, str | PathLike) else list(paths)
    if not chosen:
        raise InputError("no file to read; give one or more paths")
    found: list[TackRecord] = []
    for group in groups(chosen):
        found += _joined(group, given) if len(group) > 1 else _records(group[0], given)
    return found


def groups(paths: Sequence[AnyPath]) -> list[list[AnyPath]]:
    """Group files by test, with intervals in the order of their numbers."""
    groups: dict[tuple[str, str], list[AnyPath]] = {}
    for count, path in enumerate(paths):
        match = _INTERVAL.fullmatch(Path(path).stem)
        key = (str(Path(path).parent), match[1]) if match else (str(path), f"\0{count}")
        groups.setdefault(key, []).append(path)
    return [sorted(group, key=_interval) for group in groups.values()]


def _interval(path: AnyPath) -> int:
    """Return the number of an interval in the name of its file, 0 without one."""
    match = _INTERVAL.fullmatch(Path(path).stem)
    return int(match[2]) if match else 0


def _joined(group: list[AnyPath], given: TackOptions) -> list[TackRecord]:
    """Read the intervals of one test and join those with consecutive numbers."""
    stretches: list[list[TackRecord]] = []
    before = None
    skipped: list[str] = []
    for path in group:
        number = _interval(path)
        if not Path(path).stat().st_size:
            # an interval without data
            skipped.append(f"interval {number} is empty")
            continue
        found = _records(path, given, few=True)
        if len(found) != 1:
            raise InputError(f"{path}: the interval has {len(found)} tables; expected one")
        if before is None or number != before + 1:
            stretches.append([])
        stretches[-1] += found
        before = number
    return [_join(parts, tuple(skipped)) for parts in stretches]


def _join(parts: list[TackRecord], notes: tuple[str, ...]) -> TackRecord:
    first = parts[0]
    for one, other in zip(parts, parts[1:], strict=False):
        if one.into != other.into:
            raise InputError(f"{other.source.path}: its position is another quantity than before")
        if other.time[0] < one.time[-1]:
            raise InputError(
                f"{other.source.path}: it begins at {other.time[0]:g} s, before the end of the "
                f"previous interval at {one.time[-1]:g} s; count from the start of the test"
            )
    said = (f"{len(parts)} intervals joined",) if len(parts) > 1 else ()
    columns: dict[str, Any] = {}
    for name in ("time", "force", "position", "contact_radius", "temperature"):
        rows = [getattr(part, name) for part in parts]
        # some intervals may lack a column
        known = any(row is not None for row in rows)
        pairs = zip(parts, rows, strict=True)
        filled = [np.full(len(part), np.nan) if row is None else row for part, row in pairs]
        columns[name] = np.concatenate(filled) if known else None
    return replace(first, **columns, source=first.source.noted(*said, *notes))


def _records(path: AnyPath, given: TackOptions, few: bool = False) -> list[TackRecord]:
    """Return the records of a file; one of several intervals may have `few` rows."""
    file = load(path, raw=microscopes.RAW)
    given.check_format(FORMATS)
    # a damaged number may overflow; the record rejects it with its name
    with np.errstate(all="ignore"):
        curves = None
        if given.format not in _TABLES:
            file, curves = first_fitting(file, microscopes.READERS, given.format, given)
        if curves is not None:
            records = [_record(file, curve, curve.notes) for curve in curves]
        else:
            if not file.lines and not file.is_workbook:
                raise file.error("the file is neither text nor a workbook; export it as text")
            file = replace(file, notes=(*file.notes, *file.left_out))
            file, read = first_fitting(file, _TABLES, given.format, TACK, given.names)
            # a file of no format has raised the error of plain tables
            read = tables.where(file, read or (), given.where)
            records = [_from_table(file, table, given, few) for table in read]
    if not given.temperature_in_name:
        return records
    kelvin = kelvin_in_name(file)
    return [replace(one, temperature=np.full(len(one), kelvin)) for one in records]


def _record(file: LabFile, curve: Curve, notes: Sequence[str], **more: Any) -> TackRecord:
    notes = [*file.notes, *notes]
    if curve.stiffness:
        rig = f"cantilever of {readable(curve.stiffness, 'N/m')}"
        notes.append(f"{rig}, whose deflection is subtracted from the height")
    more["compliance"] = 1 / curve.stiffness if curve.stiffness else 0.0
    more["source"] = Source(file.path, file.sha256, file.format, tuple(notes))
    try:
        return TackRecord(curve.time, curve.force, curve.position, into=curve.into, **more)
    except InputError as error:
        raise file.error(str(error)) from None


def _from_table(file: LabFile, table: tables.Table, given: TackOptions, few: bool) -> TackRecord:
    """Return the record in a table."""
    columns = Columns(file, table, given, TACK)
    known = ", ".join(repr(text) for text in table.headings if text)
    if columns.lost:
        raise file.error(f"no column {min(columns.lost)!r}; the headings are {known}")
    position = ["travel"] if given.position_column else [x for x in POSITIONS if x in columns]
    for word, found in (("force", "force" in columns), ("position", position)):
        if not found:
            raise file.error(f"no column of {word} (headings: {known}); set `{word}_column`")
    if len(position) > 1:
        both = " and ".join(f'"{columns.name(name)}"' for name in position)
        raise file.error(f"two columns of position: {both}; set `position_column`")
    force, way = columns.si("force"), columns.si(position[0])
    heading = TACK.recognise(columns.name(position[0]), "")
    kind = heading.quantity if heading and heading.quantity in POSITIONS else "travel"
    time = columns.si("time") if "time" in columns else None
    keep = columns.keep.copy()
    more: dict[str, Array | None] = dict.fromkeys(("contact_radius", "temperature"))
    if "contact_radius" in columns:
        more["contact_radius"] = columns.si("contact_radius")
    elif "contact_diameter" in columns:
        more["contact_radius"] = columns.si("contact_diameter") / 2
    elif "contact_area" in columns:
        area = columns.si("contact_area")
        if np.any(area < 0):
            raise file.error(f"a contact area must not be negative, got {np.nanmin(area):g}")
        more["contact_radius"] = np.sqrt(area / np.pi)
    try:
        kelvins = columns.temperature()
        more["temperature"] = None if np.all(np.isnan(kelvins)) else kelvins
    except InputError as error:
        columns.notes.append(f"temperature not read: {error}")
    columns.refuse_contradiction("force", position[0], "time")
    # what differs along a test, such as its parts, is no state that is pooled
    columns.states = range(len(table.rows))
    refuse_pooled([columns])
    if lost := int(np.sum(~keep)):
        columns.notes.append(f"{lost} rows without a number rejected")
    needed = 1 if few else _NEEDED
    if np.sum(keep) < needed:
        raise file.error(f"{np.sum(keep)} rows with force and position; {needed} are needed")
    if time is None:
        time = given.time_of(file, way, columns.notes)
    curve = Curve(time[keep], force[keep], way[keep], _INTO[kind])
    rows = {name: None if row is None else row[keep] for name, row in more.items()}
    return _record(file, curve, columns.notes, **rows)
