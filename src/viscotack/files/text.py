"""Text files as written by editors and spreadsheets: encodings, line ends, CSV rows."""

import codecs
import csv
import io
import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

from viscotack.errors import InputError
from viscotack.units import is_number

from .whole import Target, write_whole

# Largest text that a user gives, such as a table of a million cases [bytes].
LARGEST_TEXT = 100_000_000
# Control characters except line ends and tabs, and those that change the writing direction.
_UNSEEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
# Of a text as read_text returns it; as a file in memory it would be four times as large.
_LINE = re.compile(r"[^\n]*\n|[^\n]+")
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+([eE][+-]?\d+)?\s*")
_THOUSANDS = re.compile(r"\s*[+-]?\d{1,3}(\.\d{3})+\s*")
# Number of a line, and the cells of its row.
Line = tuple[int, list[str]]
# Byte-order mark -> encoding.
_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}


def read_bytes(path: str | os.PathLike[str], most: int = LARGEST_TEXT) -> bytes:
    """Read a file of at most `most` bytes; FileNotFoundError without it, InputError of more."""
    with open(path, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise InputError(
            f"{os.fspath(path)} is larger than {most / 1e6:g} MB, the most that is read of such a "
            "file"
        )
    return content


def read_text(path: str | os.PathLike[str], most: int = LARGEST_TEXT) -> str:
    r"""Read a text file in UTF-8, or in UTF-16 with byte-order mark; lines end in ``\n``.

    Parameters
    ----------
    path : path
        The file.
    most : int
        Largest size that is read [bytes].

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is too large, has another encoding or is not text. The message contains the line.
    """
    content = read_bytes(path, most)
    if content.startswith((b"PK\x03\x04", b"\xd0\xcf\x11\xe0")):
        raise InputError(
            f"{os.fspath(path)} is a workbook or an archive, and text is read here; save the sheet "
            "as CSV UTF-8 (comma delimited)"
        )
    encoding = next((e for mark, e in _MARKS.items() if content.startswith(mark)), "utf-8")
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{os.fspath(path)} is not a text file in UTF-8 (line {line}); save it as UTF-8, in "
            "Notepad by Save as, Encoding; in Excel as CSV UTF-8 (comma delimited)"
        ) from None
    if "\0" in text:
        raise InputError(
            f"{os.fspath(path)} is not a text file in UTF-8: it contains zero bytes; if it is "
            "UTF-16, save it as UTF-8, in Notepad by Save as, Encoding"
        )
    return text.replace("\r\n", "\n").replace("\r", "\n")


def harmless(text: str) -> str:
    r"""Replace control characters in a text by their escape codes.

    Printed to a terminal they could move the cursor, change colours or hide text.

    Examples
    --------
    >>> print(harmless("no contact\x1b[2J"))
    no contact\x1b[2J
    """
    return _UNSEEN.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


def cell(text: str) -> str:
    """Return a text for a cell of a table such that spreadsheets do not read it as a formula.

    Examples
    --------
    >>> cell("=1+1")
    "'=1+1"
    """
    text = harmless(text)
    return f"'{text}" if text.startswith(_FORMULA) and not is_number(text) else text


def read_rows(path: str | os.PathLike[str], *, comments: bool = False) -> Iterator[Line]:
    """Yield the rows of a CSV file with the numbers of their lines, the first one too.

    Columns are separated by commas; by semicolons or tabs where the first row has these and no
    comma, with decimal commas. Lines that begin with ``#`` are left out if they are comments.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is not a text file.
    """
    lines = [found[0] for found in _LINE.finditer(read_text(path))]
    if comments:
        lines = ["\n" if line.startswith("#") else line for line in lines]
    head = next((line for line in lines if line.strip()), "")
    mark = next((mark for mark in ";\t" if mark in head and "," not in head), ",")
    reader = csv.reader(lines, delimiter=mark)
    try:
        for row in reader:
            yield reader.line_num, row if mark == "," else _with_points(path, reader.line_num, row)
    except csv.Error as error:  # a cell of more than 131,072 characters
        raise InputError(f"{os.fspath(path)}, line {reader.line_num}: {error}") from None


def _with_points(path: str | os.PathLike[str], line: int, row: list[str]) -> list[str]:
    """Return a row with decimal points in place of decimal commas."""
    commas = [_DECIMAL_COMMA.fullmatch(word) is not None for word in row]
    if any(commas) and (doubtful := [word for word in row if _THOUSANDS.fullmatch(word)]):
        raise InputError(
            f"{os.fspath(path)}, line {line}: {doubtful[0].strip()!r} beside decimal commas may "
            "have a point or thousands; write it without a point, or save the table as .xlsx"
        )
    return [w.replace(",", ".") if comma else w for w, comma in zip(row, commas, strict=True)]


def write_table(table: Mapping[str, Any], path: Target) -> None:
    """Write columns as CSV, whole or not at all; an unknown number is an empty cell."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(map(cell, table))
    rows.writerows(zip(*map(_cells, table.values()), strict=True))
    write_whole(path, text.getvalue().encode())


def _cells(values: Any) -> list[Any]:
    if hasattr(values, "tolist"):
        values = values.tolist()
        if values and isinstance(values[0], bool):
            return ["true" if value else "false" for value in values]
    return [
        cell(value) if isinstance(value, str) else "" if value != value else value
        for value in values
    ]
