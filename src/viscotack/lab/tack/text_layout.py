"""Layout of text exports: any lines, a line of headings, units beside or below them, rows.

Used by Anton Paar rheometers (one file per interval), Instron Bluehill (a block of parameters
above quoted columns), Zwick testXpert, Stable Micro Systems texture analysers (forces in grams)
and nanoindenters (tabs, micronewtons in Latin-1).
"""

import shlex
from collections.abc import Sequence

from viscotack.errors import InputError
from viscotack.lab.lab_file import LabFile
from viscotack.lab.plain_layout import below, by_number, first_line, repeats
from viscotack.lab.tables import Table, numeric, stated_temperature

from .grid import grid, heads_columns
from .headings import recognise

_LOOKED = 300  # lines searched for the headings


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None if no line looks like headings."""
    return None if _headings(file) is None else "text"


def grids(file: LabFile, names: Sequence[str] = ()) -> list[Table]:
    """Return the table of a file, or one table for each line that repeats the headings.

    `names` are headings given by the caller to find the line of headings.

    Raises
    ------
    ValueError
        If no line looks like headings, or a row has not one cell per heading.
    """
    found = _headings(file, names) or by_number(file, names)
    if found is None:
        raise _no_headings(file)
    line, separator, headings = found
    above = (text.lstrip("#% ") for text in file.lines[: max(line - 1, 0)])
    stated = stated_temperature([text] for text in above)
    return [
        grid(file, headings, *below(file, lines, separator), f"table {count}", stated)
        for count, lines in enumerate(repeats(file, line), start=1)
    ]


def _no_headings(file: LabFile) -> InputError:
    first = next((line.strip() for line in file.lines if line.strip()), "")
    numbers = first_line(file, _LOOKED, numeric, recognise, sure=True)
    choose = ""
    if numbers is not None and len(numbers[2]) > 1:
        choose = (
            f"; {len(numbers[2])} columns of numbers begin at line {numbers[0]}, for example: "
            f"viscotack test read {shlex.quote(file.path)} --time-column 1 --time-unit UNIT "
            "--position-column 2 --length-unit UNIT --force-column 3 --force-unit UNIT"
        )
    return file.error(
        f"none of the first {_LOOKED} lines has the columns of a tack test, such as "
        f'"Time [s], Gap [mm], Normal Force [N]"; the file begins {first[:60]!r}{choose}'
    )


def _headings(file: LabFile, names: Sequence[str] = ()) -> tuple[int, str | None, list[str]] | None:
    """Return the line number, the separator and the cells of the first line of headings."""
    named = bool(names)
    return first_line(file, _LOOKED, lambda row: heads_columns(row, names), recognise, named)
