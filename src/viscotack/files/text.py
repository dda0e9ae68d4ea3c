"""Text files as written by editors and spreadsheets: encodings, line ends, CSV rows."""

import codecs
import csv
import os
import re

from viscotack.errors import InputError

from .bounded import LARGEST_TEXT, check_lines, read_bytes

# Control characters except line ends and tabs, and those that change the writing direction.
_UNSEEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
# Longest table that is kept as rows: its bytes and its lines.
_LARGEST_TABLE, _MOST_ROWS = 20_000_000, 200_000
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
# Byte-order mark -> encoding.
_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}


def read_text(path: str | os.PathLike[str], most: int = LARGEST_TEXT) -> str:
    r"""Read a text file in UTF-8, or in UTF-16 with byte-order mark; lines end in ``\n``.

    Parameters
    ----------
    path : path
        A regular file.
    most : int
        Largest size that is read [bytes].

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it or a line is too large, it has another encoding or is not text. The message contains
        the line.
    """
    content = read_bytes(path, most)
    if content.startswith((b"PK\x03\x04", b"\xd0\xcf\x11\xe0")):
        raise InputError(
            f"{os.fspath(path)} is a workbook or an archive, and text is read here; save the sheet "
            "as CSV UTF-8 (comma delimited)"
        )
    check_lines(path, content)
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
    return f"'{text}" if text.startswith(_FORMULA) and not _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def read_rows(path: str | os.PathLike[str]) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Read the names in the first row of a CSV file, and the rows below with line numbers.

    Each row is one line. Empty lines and lines that begin with ``#`` are skipped.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is not a text file, or has more than 200,000 lines or 20 MB.
    """
    whole = read_text(path, _LARGEST_TABLE)
    if (count := whole.count("\n")) > _MOST_ROWS:
        raise InputError(
            f"{os.fspath(path)} has {count:,} lines, more than the limit of {_MOST_ROWS:,}; keep "
            "fewer rows"
        )
    rows = [
        (line, _split(path, line, text))
        for line, text in enumerate(whole.split("\n"), 1)
        if text.strip() and not text.startswith("#")
    ]
    header = [name.strip() for name in rows[0][1]] if rows else []
    return header, rows[1:]


def _split(path: str | os.PathLike[str], line: int, text: str) -> list[str]:
    try:
        return next(csv.reader([text]))
    except csv.Error as error:  # a cell of more than 131,072 characters
        raise InputError(f"{os.fspath(path)}, line {line}: {error}") from None
