"""Tables of cases, CSV or workbooks: their headings, and their rows as words."""

from collections.abc import Iterator
from itertools import repeat
from pathlib import Path

from viscotack.errors import InputError
from viscotack.files.text import Line, read_rows

# Reason why an empty row has no answer.
EMPTY = "empty row"


def read_words(path: Path, *, empty: bool = False) -> tuple[list[str], Iterator[Line]]:
    """Return the names in the first row of a table, and the other rows with their lines.

    Parameters
    ----------
    path : Path
        A CSV file, or a workbook .xlsx, whose first sheet is read. Columns are separated by commas;
        by semicolons or tabs where the first row has these and no comma, with decimal commas.
    empty : bool
        Whether empty rows between others are kept; those at the end never are.

    Notes
    -----
    Rows are read when they are needed; one that is wrong is refused then.
    """
    rows = _of_sheet(path) if path.suffix.lower() == ".xlsx" else read_rows(path)
    names = [name.strip() for name in next(rows, (0, []))[1]]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise InputError(f"{path}: the first row has {', '.join(map(repr, twice))} more than once")
    lines = _filled(path, names, rows, empty)
    first = next(lines, None)
    if first is None:
        raise InputError(f"{path}: needs a first row of column names and a case a row below it")

    def all_lines() -> Iterator[Line]:
        yield first
        yield from lines

    return names, all_lines()


def _of_sheet(path: Path) -> Iterator[Line]:
    """Return the rows of the first sheet of a workbook."""
    from viscotack.lab.formats.file import load
    from viscotack.lab.formats.workbook import sheets

    try:
        first = next(iter(sheets(load(path)).values()), [])
    except ImportError as error:
        raise InputError(str(error)) from None
    # a sheet may have empty columns that were formatted
    width = max((i + 1 for row in first for i, word in enumerate(row) if word.strip()), default=0)
    return enumerate((row[:width] for row in first), 1)


def _filled(path: Path, names: list[str], rows: Iterator[Line], empty: bool) -> Iterator[Line]:
    """Yield the rows that are not empty and, if wanted, the empty ones between them."""
    before = 0
    for line, row in rows:
        if not any(word.strip() for word in row):
            before += 1
            continue
        if len(row) != len(names):
            cure = "; numbers need decimal points, not commas" if len(row) > len(names) else ""
            raise InputError(
                f"{path}, line {line}: {len(row)} values for {len(names)} columns{cure}"
            )
        yield from repeat((line, [""] * len(names)), before if empty else 0)
        before = 0
        yield line, row
