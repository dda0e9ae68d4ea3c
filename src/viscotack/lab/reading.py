"""Read laboratory files: detect the format, note it, and return numbers in SI.

If a file lacks information, the error names the field of :class:`Options` that supplies it. Every
reader takes :class:`Options`, and fields of it as keywords.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from os import PathLike
from typing import Any

from viscotack.errors import InputError
from viscotack.model.materials.shift import TabulatedShift

from . import assembly
from .assembly import Opened, sheets_with_test, test_of
from .formats import reptate, text, trios_json, workbook
from .formats.columns import MaterialColumns
from .formats.file import first_fitting, load
from .formats.headings import MATERIAL
from .formats.tables import Table, kelvin_in_name, pieces, where
from .options import Options
from .sweeps import CreepTest, FrequencySweeps, RelaxationTest, joined

Path = str | PathLike[str]
Test = FrequencySweeps | RelaxationTest | CreepTest
_NOTHING = Options()


# reader of the tables of each format, in order of detection
FORMATS: dict[str, Callable[..., list[Table] | None]] = {
    "workbook": workbook.tables,
    "reptate": reptate.tables,
    "trios-json": trios_json.tables,
    "trios": text.trios,
    "rheocompass": text.rheocompass,
    "csv": text.plain,
}


def read(
    path: Path | Sequence[Path],
    options: Options = _NOTHING,
    *,
    test: str | None = None,
    **more: Any,
) -> Test | tuple[RelaxationTest, ...] | tuple[CreepTest, ...]:
    r"""Read the test in a file: frequency sweeps, stress relaxation or creep.

    The columns identify the test; if both stress and strain are present, the one held constant
    does. Sweeps take precedence over step tests. Step tests at several temperatures are returned
    as a tuple, from cold to hot; points within 1 K have one temperature, and rows with monotonic
    time are one test. A time since the step takes precedence over a time of the whole test; rows at
    time zero are ignored, with a note.

    Parameters
    ----------
    path : path-like, or sequence of them
        Text files or workbooks of one material, see :func:`read_dma`.
    options : Options
        What the caller states about the file.
    test : {"dma", "relaxation", "creep"}, optional
        Test to read where the file has several.
    **more
        Fields of :class:`Options` by name, which replace those of `options`.

    Returns
    -------
    FrequencySweeps, RelaxationTest, CreepTest, or tuple of tests
        In SI; ``source.notes`` lists all decisions.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if the file contains none of these tests, or both step tests.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "t,G(t)\ns,MPa\n1,4\n10,2\n100,1\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "film.csv")
    ...     _ = file.write_text(table)
    ...     found = read(file)
    >>> type(found).__name__, found.kind
    ('RelaxationTest', 'G')
    """
    opened = _opened(path, options, more)
    any_kind = [each._replace(given=replace(each.given, kind=None)) for each in opened]
    tests = {test} if test else {test_of(x) for each in any_kind for x in each.columns}
    if "dma" in tests or not tests & {"relaxation", "creep"}:
        return joined([assembly.sweeps(each) for each in opened])
    if {"relaxation", "creep"} <= tests:
        file = opened[0].file
        if len(opened) > 1:
            raise InputError("some files are relaxation, others creep tests; read them separately")
        raise file.error("the file has a relaxation and a creep test; set `test` to one of them")
    kind: Any = RelaxationTest if "relaxation" in tests else CreepTest
    steps = [step for one in opened for step in assembly.tests(kind, one)]
    found = tuple(sorted(steps, key=lambda step: step.temperature or 0.0))
    return found[0] if len(found) == 1 else found


def read_dma(
    path: Path | Sequence[Path], options: Options = _NOTHING, **more: Any
) -> FrequencySweeps:
    r"""Read the frequency sweeps of a dynamic mechanical analyser or a rheometer.

    Parameters
    ----------
    path : path-like, or sequence of them
        A text file (plain table, wide table, TA TRIOS, Anton Paar RheoCompass, RepTate, pyvisco)
        or a workbook (Netzsch Gabo Eplexor or similar; extra ``lab``). Several files are
        sweeps of one material.
    options : Options
        What the caller states about the file.
    **more
        Fields of :class:`Options` by name, which replace those of `options`.

    Returns
    -------
    FrequencySweeps
        In SI; ``source.notes`` lists all decisions.

    Raises
    ------
    ValueError
        If the file cannot be interpreted; the message names the file, the line and what was
        expected.
    OSError
        If the file cannot be opened.

    Notes
    -----
    Detected damage: a missing or extra cell, a malformed number, a wrong
    count of points, tan(delta) or \|E*\| that contradict the moduli by more than
    10 %, contradictory hertz and rad/s, impossible values. A last line without a line
    end is ignored, because a truncated number looks like another number. Undetectable damage:
    a changed digit in a number that occurs once, and whole rows missing from a file
    without a count of points.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "f, E', E'', T\nHz, MPa, MPa, C\n1, 3.2, 0.4, 20\n10, 4.5, 0.7, 20\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "pdms.csv")
    ...     _ = file.write_text(table)
    ...     sweeps = read_dma(file)
    >>> sweeps.storage.tolist(), sweeps.kind, sweeps.source.format
    ([3200000.0, 4500000.0], 'E', 'csv')
    """
    opened = _opened(path, options, more)
    return joined([assembly.sweeps(each) for each in opened])


def read_shifts(path: Path, options: Options = _NOTHING, **more: Any) -> TabulatedShift:
    r"""Read a table of shift factors: temperature and log_aT, or aT and optionally bT.

    log10 a_T is positive where the solid is slower than at the reference
    temperature, as in pyvisco and RepTate. A shift that rises with temperature is rejected, because
    it is 1/a_T.

    Parameters
    ----------
    path : path-like
        Text file or workbook, see :func:`read_dma`.
    options : Options
        What the caller states about the file.
    **more
        Fields of :class:`Options` by name, which replace those of `options`.

    Returns
    -------
    TabulatedShift
        log10 a_T, and log10 b_T if the file has it; its reference is the row nearest to zero shift.

    Raises
    ------
    ValueError
        As :func:`read_dma`.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "T,log_aT\nC,-\n20,0\n0,2.1\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "shifts.csv")
    ...     _ = file.write_text(table)
    ...     found = read_shifts(file)
    >>> found.values, found.reference_temperature
    ((2.1, 0.0), 293.15)
    """
    (opened,) = _opened([path], options, more)
    return assembly.shifts(opened)


def _opened(path: Path | Sequence[Path], options: Options, more: dict[str, Any]) -> list[Opened]:
    """Open one or more files."""
    given = replace(options, **more)
    given.check_format(FORMATS)
    paths = [path] if isinstance(path, str | PathLike) else list(path)
    if not paths:
        raise InputError("no file to read; give one or more paths")
    return [_open(one, given) for one in paths]


def _open(path: Path, given: Options) -> Opened:
    """Open the table chosen by the caller, or those of the sheet that has a test."""
    file, whole = first_fitting(load(path), FORMATS, given.format, MATERIAL, given.names)
    notes = [] if given.format is not None else [f"detected format: {file.format}"]
    notes += [*file.notes, *(() if file.format == "trios-json" else file.left_out)]
    # a file of no format has raised the error of plain tables
    parts = [part for table in whole or () for part in pieces(table, MATERIAL)]
    pairs = enumerate(zip(parts, [None, *parts], strict=False), start=1)
    tables = [replace(table, number=i, before=before) for i, (table, before) in pairs]
    tables = where(file, tables, given.where)
    if given.table is not None:
        places = "; ".join(f"{table.number}: {table.place}" for table in tables)
        tables = [each for each in tables if str(given.table) in (each.sheet, str(each.number))]
        if not tables:
            raise file.error(f"no `table` {given.table!r}; the file has {places}")
    columns = [MaterialColumns(file, table, given) for table in tables]
    if lost := set(given.names).intersection(*(each.lost for each in columns)):
        headings = Opened(file, tables, given).headings
        raise file.error(f"no column {min(lost)!r}; the headings are {headings}")
    if tables:
        first, read, alike = sheets_with_test(columns)
        sheets = list(dict.fromkeys(table.sheet for table in tables))
        others = ", ".join(repr(sheet) for sheet in sheets if sheet not in read)
        many = f"{len(read)} sheets of sweeps are read"
        which = many if len(read) > 1 else f"sheet {first!r} is read"
        if others:
            notes.append(f"{which}, {others} are not; `table` chooses")
        elif len(read) > 1:
            notes.append(f"{which}: {', '.join(map(repr, sheets))}")
        if alike:
            notes.append(
                f"{len(alike) + 1} sheets hold sweeps, and only {first!r} is read, because their "
                "temperatures are unknown or the same; save each as a file, or write a temperature"
            )
        tables = [table for table in tables if table.sheet in read]
    if given.temperature_in_name:
        given = replace(given, temperature=kelvin_in_name(file), temperature_in_name=False)
    return Opened(replace(file, notes=tuple(notes)), tables, given)
