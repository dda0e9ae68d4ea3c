"""Read a laboratory's file: find out its format, say so, and return numbers in SI.

What a file does not say is asked for by the name of the flag of ``viscotack material fit``; the
parameters here have the same names, ``--modulus-unit`` is `modulus_unit`.
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

# format -> the module that knows its layout, in the order in which they are tried
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
    """Return the test that a file holds: sweeps, stress relaxation or creep.

    Parameters are those of :func:`read_dma`. Which test it is its columns say; where stress and
    strain are both there, the one that is held. Sweeps go before steps of other kinds. Steps at
    several temperatures are a tuple of tests, from cold to hot.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if it holds none of them, or steps of both kinds.
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
            raise InputError("some files are relaxation, others creep tests; read them apart")
        raise file.error(
            "it holds a relaxation and a creep test; say --test relaxation or --test creep"
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
    r"""Return the frequency sweeps of a dynamic mechanical analysis or of a rheometer.

    Parameters
    ----------
    path : path-like, or sequence of them
        A text file (plain table, wide table, TA TRIOS, Anton Paar RheoCompass, RepTate, pyvisco)
        or a workbook (Netzsch Gabo Eplexor, or one like it; extra ``lab``). Several files are
        sweeps of one material.
    format : str, optional
        One of :data:`FORMATS`; otherwise it is found out from the content and noted.
    kind : {"E", "G"}, optional
        Tensile or shear modulus, where neither the headings nor the words around them say it, or
        which one to take where the file has both.
    temperature : float, optional
        Temperature of all points [K], where the file does not say.
    frequency_unit : str, optional
        ``"Hz"`` or ``"rad/s"``, where the file does not say or says 1/s. An angular frequency
        without a unit is taken in rad/s, with a note.
    modulus_unit : str, optional
        Such as ``"MPa"``, where the file does not say.
    time_unit : str, optional
        Such as ``"s"``, where the file does not say.
    temperature_unit : str, optional
        ``"degC"``, ``"K"`` or ``"degF"``, where a column or a number above columns has none.
    temperature_in_name : bool
        Whether the temperature stands in the name of the file, as in ``foam_-25C.csv``.
    decimal : {".", ","}, optional
        Decimal mark, where numbers such as ``1,234`` leave it open.

    Returns
    -------
    FrequencySweeps
        In SI; ``source.notes`` says everything that was decided.

    Raises
    ------
    ValueError
        If the file cannot be understood: it names the file, the line and what was expected.
    OSError
        If the file cannot be opened.

    Notes
    -----
    What is found out about a damaged file: a missing or added cell, a number that is none, a
    count of points that is not met, tan(delta) or \|E*\| that contradict the moduli by more than
    2 %, hertz and rad/s that contradict each other, impossible values. A last line without a line
    end is left out, because a number cut short looks like another number. What cannot be found
    out: one digit changed in a number that the file holds once, and whole rows lost from a file
    that does not count them.

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
    """Return a stress relaxation test: time and modulus, or stress over strain.

    Parameters are those of :func:`read_dma`. A time of the step is taken before a time of the
    whole test; rows at time zero are left out, with a note.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if there is not exactly one table of this kind.
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
    """Return a creep test: time and compliance, or strain over stress.

    Parameters are those of :func:`read_dma`; `modulus_unit` is that of the stress.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if there is not exactly one table of this kind.
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
    """Return the relaxation tests of a file or several, one for each temperature, cold to hot.

    Parameters are those of :func:`read_dma`. Points within 1 K are one temperature. Rows whose
    time never begins again are one test, as :func:`read_relaxation` reads it.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if a file has not exactly one table of this kind.
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
    """Return the creep tests of a file or several, one for each temperature, cold to hot.

    Parameters are those of :func:`read_dma`. Points within 1 K are one temperature. Rows whose
    time never begins again are one test, as :func:`read_creep` reads it.

    Raises
    ------
    ValueError
        As :func:`read_dma`; also if a file has not exactly one table of this kind.
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
    """Return a table of shift factors: temperature and log_aT, or aT and perhaps bT.

    A shift is positive in the logarithm where the solid is slower than at the reference
    temperature, as pyvisco and RepTate write it. One that rises with temperature is refused: it
    is 1/a_T.

    Raises
    ------
    ValueError
        As :func:`read_dma`.
    """
    file, _, tables = _tables(path, format)
    units = Units(temperature=temperature_unit, decimal=decimal)
    return step_tests.shifts(file, tables, _given(None, None, units))


class _Opened(NamedTuple):
    """A file in tables, and what is said about it: what every reader of a test takes."""

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
    """Return one file or several, each with the temperature that is said of it."""
    _given(kind, temperature, units)
    paths = [path] if isinstance(path, str | PathLike) else list(path)
    if not paths:
        raise InputError("there is no file to read")
    if temperature is not None and temperature_in_name:
        raise InputError("--temperature and --temperature-in-name: say one of them")
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
    said = () if format is not None else (f"format found out: {found}",)
    cut = () if found == "trios-json" else file.left_out
    return replace(file, notes=(*said, *file.notes, *cut)), found, tables


def _given(kind: str | None, temperature: float | None, units: Units) -> assembly.Given:
    """Refuse what a caller says wrongly before the file is blamed for it."""
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
