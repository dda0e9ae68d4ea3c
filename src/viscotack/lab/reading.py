"""Read laboratory files: detect the format, note it, and return numbers in SI.

If a file lacks information, the error names the option of ``viscotack material fit`` that supplies
it; the parameters here have the same names, for example ``--modulus-unit`` and `modulus_unit`.
"""

from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from types import ModuleType
from typing import NamedTuple

from viscotack.errors import InputError

from . import (
    assembly,
    plain_layout,
    reptate_layout,
    rheocompass_layout,
    step_tests,
    trios_json_layout,
    trios_layout,
    wide_layout,
    workbook_layout,
)
from .arrays import KINDS
from .columns import Columns, Table, Units
from .diagnosis import test_of
from .joining import joined, kelvin_in_name
from .lab_file import LabFile, format_of, load, refuse_unknown
from .quantities import POSSIBLE, kelvin, radians_per_second, scale
from .sweeps import CreepTest, FrequencySweeps, RelaxationTest, ShiftTable

Path = str | PathLike[str]
Test = FrequencySweeps | RelaxationTest | CreepTest

# format -> module that reads its layout, in order of detection
FORMATS: dict[str, ModuleType] = {
    "eplexor": workbook_layout,
    "workbook": workbook_layout,
    "reptate": reptate_layout,
    "trios-json": trios_json_layout,
    "trios": trios_layout,
    "rheocompass": rheocompass_layout,
    "wide": wide_layout,
    "pyvisco": plain_layout,
    "csv": plain_layout,
}


def read(
    path: Path | Sequence[Path],
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    temperature_in_name: bool = False,
    decimal: str | None = None,
) -> Test | tuple[RelaxationTest, ...] | tuple[CreepTest, ...]:
    r"""Read the test in a file: frequency sweeps, stress relaxation or creep.

    The columns identify the test; if both stress and strain are present, the one held constant
    does. Sweeps take precedence over step tests. Step tests at several temperatures are returned
    as a tuple, from cold to hot.

    Parameters
    ----------
    path : path-like, or sequence of them
        Text files or workbooks of one material, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if the file does not state it or has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    frequency_unit, modulus_unit, time_unit, temperature_unit : str, optional
        Units that the file does not state.
    temperature_in_name : bool
        Whether to read the temperature from the file name, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

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
    units = Units(frequency_unit, modulus_unit, time_unit, temperature_unit, decimal)
    opened = _opened(path, format, kind, temperature, units, temperature_in_name)
    tests = {
        test_of(Columns(file, table, units))
        for file, _, tables, _ in opened
        for table in tables
        if table.rows
    }
    if "dma" in tests or not tests & {"relaxation", "creep"}:
        return joined([assembly.sweeps(*each) for each in opened])
    if {"relaxation", "creep"} <= tests:
        file = opened[0].file
        if len(opened) > 1:
            raise InputError("some files are relaxation, others creep tests; read them separately")
        raise file.error(
            "the file contains a relaxation and a creep test; set --test relaxation or --test creep"
        )
    if "relaxation" in tests:
        found = _each(RelaxationTest, opened)
    else:
        found = _each(CreepTest, opened)
    return found[0] if len(found) == 1 else found


def read_dma(
    path: Path | Sequence[Path],
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    temperature_in_name: bool = False,
    decimal: str | None = None,
) -> FrequencySweeps:
    r"""Read the frequency sweeps of a dynamic mechanical analyser or a rheometer.

    Parameters
    ----------
    path : path-like, or sequence of them
        A text file (plain table, wide table, TA TRIOS, Anton Paar RheoCompass, RepTate, pyvisco)
        or a workbook (Netzsch Gabo Eplexor or similar; extra ``lab``). Several files are
        sweeps of one material.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content and noted.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if neither the headings nor the text around them state it, or
        to select one if the file has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    frequency_unit : str, optional
        ``"Hz"`` or ``"rad/s"``, if the file states no unit or 1/s. An angular frequency
        without a unit is assumed to be in rad/s, with a note.
    modulus_unit : str, optional
        Such as ``"MPa"``, if the file states no unit.
    time_unit : str, optional
        Such as ``"s"``, if the file states no unit.
    temperature_unit : str, optional
        ``"degC"``, ``"K"`` or ``"degF"``, if a column or a number above columns has no unit.
    temperature_in_name : bool
        Whether to read the temperature from the file name, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

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
    2 %, contradictory hertz and rad/s, impossible values. A last line without a line
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
    units = Units(frequency_unit, modulus_unit, time_unit, temperature_unit, decimal)
    opened = _opened(path, format, kind, temperature, units, temperature_in_name)
    return joined([assembly.sweeps(*each) for each in opened])


def read_relaxation(
    path: Path,
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    decimal: str | None = None,
) -> RelaxationTest:
    r"""Read a stress relaxation test: time and modulus, or stress over strain.

    A time since the step takes precedence over a time
    of the whole test; rows at time zero are ignored, with a note.

    Parameters
    ----------
    path : path-like
        Text file or workbook, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if the file does not state it or has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    modulus_unit, time_unit, temperature_unit : str, optional
        Units that the file does not state; `modulus_unit` is that of a stress as well.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

    Returns
    -------
    RelaxationTest
        In SI.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also unless the file has exactly one table of this kind.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "t,G(t)\ns,MPa\n1,4\n10,2\n100,1\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "film.csv")
    ...     _ = file.write_text(table)
    ...     found = read_relaxation(file)
    >>> found.kind, found.modulus.tolist()
    ('G', [4000000.0, 2000000.0, 1000000.0])
    """
    units = Units(None, modulus_unit, time_unit, temperature_unit, decimal)
    (opened,) = _opened([path], format, kind, temperature, units, False)
    return step_tests.one(RelaxationTest, *opened)


def read_creep(
    path: Path,
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    decimal: str | None = None,
) -> CreepTest:
    r"""Read a creep test: time and compliance, or strain over stress.

    Parameters
    ----------
    path : path-like
        Text file or workbook, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if the file does not state it or has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    modulus_unit, time_unit, temperature_unit : str, optional
        Units that the file does not state; `modulus_unit` is that of a stress as well.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

    Returns
    -------
    CreepTest
        In SI.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also unless the file has exactly one table of this kind.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "t,J\ns,1/Pa\n1,1e-6\n10,2e-6\n100,4e-6\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "film.csv")
    ...     _ = file.write_text(table)
    ...     found = read_creep(file, kind="G")
    >>> found.kind, found.compliance.tolist()
    ('G', [1e-06, 2e-06, 4e-06])
    """
    units = Units(None, modulus_unit, time_unit, temperature_unit, decimal)
    (opened,) = _opened([path], format, kind, temperature, units, False)
    return step_tests.one(CreepTest, *opened)


def read_relaxations(
    path: Path | Sequence[Path],
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    temperature_in_name: bool = False,
    decimal: str | None = None,
) -> tuple[RelaxationTest, ...]:
    r"""Read the relaxation tests of one or more files, one per temperature, from cold to hot.

    Points within 1 K have one temperature. Rows with
    monotonic time are one test, as in :func:`read_relaxation`.

    Parameters
    ----------
    path : path-like, or sequence of them
        Text files or workbooks of one material, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if the file does not state it or has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    modulus_unit, time_unit, temperature_unit : str, optional
        Units that the file does not state; `modulus_unit` is that of a stress as well.
    temperature_in_name : bool
        Whether to read the temperature from the file name, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

    Returns
    -------
    tuple of RelaxationTest
        In SI, from cold to hot.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also unless each file has exactly one table of this kind.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "T,t,G(t)\nC,s,MPa\n20,1,4\n20,10,2\n0,1,8\n0,10,4\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "film.csv")
    ...     _ = file.write_text(table)
    ...     found = read_relaxations(file)
    >>> [round(test.temperature, 2) for test in found]
    [273.15, 293.15]
    """
    units = Units(None, modulus_unit, time_unit, temperature_unit, decimal)
    opened = _opened(path, format, kind, temperature, units, temperature_in_name)
    return _each(RelaxationTest, opened)


def read_creeps(
    path: Path | Sequence[Path],
    *,
    format: str | None = None,
    kind: str | None = None,
    temperature: float | None = None,
    modulus_unit: str | None = None,
    time_unit: str | None = None,
    temperature_unit: str | None = None,
    temperature_in_name: bool = False,
    decimal: str | None = None,
) -> tuple[CreepTest, ...]:
    r"""Read the creep tests of one or more files, one per temperature, from cold to hot.

    Points within 1 K have one temperature. Rows with
    monotonic time are one test, as in :func:`read_creep`.

    Parameters
    ----------
    path : path-like, or sequence of them
        Text files or workbooks of one material, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, if the file does not state it or has both.
    temperature : float, optional
        Temperature of all points [K], if the file does not state it.
    modulus_unit, time_unit, temperature_unit : str, optional
        Units that the file does not state; `modulus_unit` is that of a stress as well.
    temperature_in_name : bool
        Whether to read the temperature from the file name, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

    Returns
    -------
    tuple of CreepTest
        In SI, from cold to hot.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also unless each file has exactly one table of this kind.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> table = "T,t,J\nC,s,1/Pa\n20,1,1e-6\n20,10,2e-6\n0,1,5e-7\n0,10,1e-6\n"
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "film.csv")
    ...     _ = file.write_text(table)
    ...     found = read_creeps(file, kind="G")
    >>> [round(test.temperature, 2) for test in found]
    [273.15, 293.15]
    """
    units = Units(None, modulus_unit, time_unit, temperature_unit, decimal)
    opened = _opened(path, format, kind, temperature, units, temperature_in_name)
    return _each(CreepTest, opened)


def read_shifts(
    path: Path,
    *,
    format: str | None = None,
    temperature_unit: str | None = None,
    decimal: str | None = None,
) -> ShiftTable:
    r"""Read a table of shift factors: temperature and log_aT, or aT and optionally bT.

    log10 a_T is positive where the solid is slower than at the reference
    temperature, as in pyvisco and RepTate. A shift that rises with temperature is rejected, because
    it is 1/a_T.

    Parameters
    ----------
    path : path-like
        Text file or workbook, see :func:`read_dma`.
    format : str, optional
        One of :data:`FORMATS`; by default it is detected from the content.
    temperature_unit : str, optional
        ``"degC"``, ``"K"`` or ``"degF"``, if the file does not state it.
    decimal : {".", ","}, optional
        Decimal mark, if numbers such as ``1,234`` are ambiguous.

    Returns
    -------
    ShiftTable
        log10 a_T, and log10 b_T if the file has it.

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
    >>> found.log10_shift.tolist()
    [2.1, 0.0]
    """
    file, _, tables = _tables(path, format)
    units = Units(temperature=temperature_unit, decimal=decimal)
    return step_tests.shifts(file, tables, _given(None, None, units))


class _Opened(NamedTuple):
    """Tables of a file and the caller's options, the input of every reader of tests."""

    file: LabFile
    format: str
    tables: list[Table]
    given: assembly.Given


def _opened(
    path: Path | Sequence[Path],
    format: str | None,
    kind: str | None,
    temperature: float | None,
    units: Units,
    temperature_in_name: bool,
) -> list[_Opened]:
    """Open one or more files, each with the temperature given by the caller."""
    _given(kind, temperature, units)
    paths = [path] if isinstance(path, str | PathLike) else list(path)
    if not paths:
        raise InputError("no file to read; give one or more paths")
    if temperature is not None and temperature_in_name:
        raise InputError("give either --temperature or --temperature-in-name, not both")
    opened = []
    for one in paths:
        file, found, tables = _tables(one, format)
        own = kelvin_in_name(file) if temperature_in_name else temperature
        opened.append(_Opened(file, found, tables, assembly.Given(kind, own, units)))
    return opened


def _each(kind: type[step_tests.Test], opened: Sequence[_Opened]) -> tuple[step_tests.Test, ...]:
    tests = [test for one in opened for test in step_tests.each(kind, *one)]
    return tuple(sorted(tests, key=lambda test: test.temperature or 0.0))


def _tables(path: Path, format: str | None) -> tuple[LabFile, str, list[Table]]:
    refuse_unknown(format, FORMATS)
    file = load(path)
    found = format_of(file, FORMATS, format, "csv")
    tables = FORMATS[found].tables(file)
    said = () if format is not None else (f"detected format: {found}",)
    cut = () if found == "trios-json" else file.left_out
    return replace(file, notes=(*said, *file.notes, *cut)), found, tables


def _given(kind: str | None, temperature: float | None, units: Units) -> assembly.Given:
    """Check the caller's options before the file."""
    if kind is not None and kind not in KINDS:
        raise InputError(f"--kind must be E (tensile) or G (shear), got {kind!r}")
    if units.decimal not in (None, ".", ","):
        raise InputError(f"--decimal must be . or , got {units.decimal!r}")
    if temperature is not None and not POSSIBLE[0] < temperature < POSSIBLE[1]:
        raise InputError(
            f"--temperature must be above 0 K, got {temperature!r} K; give Celsius + 273.15"
        )
    if units.frequency is not None:
        radians_per_second(units.frequency, angular="rad" in units.frequency)
    if units.modulus is not None:
        scale(units.modulus, "Pa")
    if units.time is not None:
        scale(units.time, "s")
    if units.temperature is not None:
        kelvin(units.temperature)
    return assembly.Given(kind, temperature, units)
