"""Layout of workbooks: Zwick testXpert, one sheet of values for each specimen, or any like it."""

from collections.abc import Sequence

from viscotack.lab.columns import Table
from viscotack.lab.lab_file import LabFile
from viscotack.lab.workbook_layout import sheets, under

from .grid import grid, heads_columns

_LOOKED = 50  # rows in which the headings are looked for


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file is no workbook."""
    return "workbook" if file.is_workbook and b"segments/0" not in file.content else None


def grids(file: LabFile, names: Sequence[str] = ()) -> list[Table]:
    """Return the table of each sheet that names a force and a position or a time.

    `names` are headings that the caller names, by which their row is found.

    Raises
    ------
    ValueError
        If the file is no readable workbook, or no sheet has such headings.
    ImportError
        If the library that reads workbooks is not installed.
    """
    if not file.is_workbook:
        raise file.error("expected an Excel workbook")
    found = sheets(file)
    tables = []
    for title, rows in found.items():
        at = next((i for i, row in enumerate(rows[:_LOOKED]) if heads_columns(row, names)), None)
        if at is not None:
            tables.append(grid(file, rows[at], *under(rows, at), f"sheet {title!r}"))
    if not tables:
        raise file.error(
            'no sheet names the columns of a tack test, such as "Travel, Force, Time", in its '
            f"first {_LOOKED} rows; the sheets are {', '.join(map(repr, found))}"
        )
    return tables
