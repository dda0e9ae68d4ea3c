"""Layout of workbooks: Zwick testXpert, one sheet of values per specimen, and similar ones."""

from collections.abc import Sequence

from viscotack.lab.lab_file import LabFile
from viscotack.lab.tables import Table, stated_temperature, under
from viscotack.lab.workbook_layout import sheets

from .grid import grid, heads_columns

_LOOKED = 50  # rows searched for the headings


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if the file is not a workbook."""
    return "workbook" if file.is_workbook and b"segments/0" not in file.content else None


def grids(file: LabFile, names: Sequence[str] = ()) -> list[Table]:
    """Return the table of each sheet with columns of force and of position or time.

    `names` are headings given by the caller to find the row of headings.

    Raises
    ------
    ValueError
        If the workbook cannot be read, or no sheet has such headings.
    ImportError
        If the library for workbooks is not installed.
    """
    if not file.is_workbook:
        raise file.error("expected an Excel workbook")
    found = sheets(file)
    tables = []
    for title, rows in found.items():
        at = next((i for i, row in enumerate(rows[:_LOOKED]) if heads_columns(row, names)), None)
        if at is not None:
            below = under(list(enumerate(rows, start=1))[at + 1 :])
            stated = stated_temperature(rows[:at])
            tables.append(grid(file, rows[at], *below, f"sheet {title!r}", stated))
    if not tables:
        raise file.error(
            'no sheet has the columns of a tack test, such as "Travel, Force, Time", in its '
            f"first {_LOOKED} rows; the sheets are {', '.join(map(repr, found))}"
        )
    return tables
