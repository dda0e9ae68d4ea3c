"""Bounds on a workbook (.xlsx), checked before a library builds its cells.

A sheet of a few kilobytes can name a cell in row 1,048,576, of which libraries make a million rows;
a text of many megabytes packs into a few kilobytes. The parts are read as a stream: nothing of
them is kept.
"""

import re
import zipfile
from xml.parsers import expat

from viscotack.errors import InputError

# Of a sheet. Cells: of the smallest rectangle that holds those that are there.
MOST_ROWS, MOST_COLUMNS, MOST_CELLS = 200_000, 500, 5_000_000
# Of one text, where spreadsheets allow 32,767; and of a part, per element
# [characters].
_LONGEST_TEXT, _MOST_TEXT, _ELEMENT = 40_000, 30_000_000, 16
# Read at a time, and most between two elements [bytes].
_CHUNK, _LONGEST_ELEMENT = 1 << 16, 1 << 20
# A small workbook, packed and unpacked [bytes].
_SMALL, _SMALL_UNPACKED = 50_000, 1_000_000
_SCANNED = (".xml", ".rels")
_SHEET = "xl/worksheets/"
_PLACE = re.compile(r"([A-Z]{1,7})([0-9]{1,9})")


def has_formulas(archive: zipfile.ZipFile) -> bool:
    """Check every part of a workbook, and return whether a cell has a formula.

    Raises
    ------
    InputError
        If a sheet or a text is larger than is read, or a part declares a document type.
    """
    parts = [part for part in archive.namelist() if part.endswith(_SCANNED)]
    return any([_scan(archive, part).formulas for part in parts])


def is_small(archive: zipfile.ZipFile, size: int) -> bool:
    """Whether a workbook of this size [bytes] takes less than 100 MB, whatever is in it.

    Its texts and elements are few, its cells bounded by :func:`has_formulas` in all of its parts,
    and packed bytes grow by at most 1,032 times, also where their stated size is wrong.
    """
    parts = archive.infolist()
    return (
        size <= _SMALL
        and "xl/workbook.xml" in archive.namelist()
        and sum(part.file_size for part in parts) <= _SMALL_UNPACKED
        and all(part.filename.endswith(_SCANNED) for part in parts)
        and all(part.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) for part in parts)
    )


def check_size(rows: int, columns: int) -> None:
    """Refuse a sheet with more rows, columns or cells than are read."""
    if rows > MOST_ROWS or columns > MOST_COLUMNS or rows * columns > MOST_CELLS:
        raise InputError(f"a sheet has {rows} rows and {columns} columns")


class _Scan:
    """Counts the rows, columns and characters of a part."""

    def __init__(self, is_sheet: bool) -> None:
        self.is_sheet, self.formulas = is_sheet, False
        self._rows = self._columns = self._column = 0
        self._text = self._all_text = 0
        self.unknown = 0  # bytes since an element or a text

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        """Note an element."""
        tag, place = name.rpartition(":")[2], attributes.get("r", "")
        self._text = 0
        self._count(_ELEMENT + len(name) + sum(map(len, attributes.values())))
        # in every part, because a workbook can name any part as a sheet
        if tag == "row":
            self._rows, self._column = int(place) if place.isdigit() else self._rows + 1, 0
        elif tag == "c":
            found = _PLACE.fullmatch(place)
            self._column = _number(found[1]) if found else self._column + 1
            self._rows = max(self._rows, int(found[2])) if found else self._rows
            self._columns = max(self._columns, self._column)
        elif tag == "f":
            self.formulas |= self.is_sheet
        check_size(self._rows, self._columns)

    def text(self, words: str) -> None:
        """Note text of an element."""
        self._text += len(words)
        if self._text > _LONGEST_TEXT:
            raise InputError(f"a cell has more than {_LONGEST_TEXT:,} characters")
        self._count(len(words))

    def _count(self, characters: int) -> None:
        self.unknown = 0
        self._all_text += characters
        if self._all_text > _MOST_TEXT:
            raise InputError(
                f"it has more than {_MOST_TEXT / 1e6:g} million characters; export the relevant "
                "sheet as CSV"
            )


def _scan(archive: zipfile.ZipFile, part: str) -> _Scan:
    scan = _Scan(part.startswith(_SHEET))
    parser = expat.ParserCreate()
    parser.StartElementHandler = scan.begin
    parser.CharacterDataHandler = scan.text
    parser.StartDoctypeDeclHandler = _refuse_document_type
    with archive.open(part) as stream:
        while chunk := stream.read(_CHUNK):
            scan.unknown += len(chunk)
            if scan.unknown > _LONGEST_ELEMENT:
                raise InputError(f"{part} has an element of more than 1 MB")
            parser.Parse(chunk, False)
    parser.Parse(b"", True)
    return scan


def _refuse_document_type(*_: object) -> None:
    raise InputError("a part declares a document type, whose entities could grow without end")


def _number(letters: str) -> int:
    """Compute the number of a column: 1 for A, 27 for AA."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number
