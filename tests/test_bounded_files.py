"""Files that would take all memory or all time are refused before they are read."""

import io
import os
import tracemalloc
import zipfile

import pytest

from viscotack import load as load_result
from viscotack.errors import InputError
from viscotack.files.bounded import read_bytes
from viscotack.files.text import read_text
from viscotack.files.toml import parse_toml, read_toml
from viscotack.lab.lab_file import load
from viscotack.lab.workbook_layout import sheets

BOOK = {
    "[Content_Types].xml": (
        '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/'
        'content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-'
        'package.relationships+xml"/><Default Extension="xml" ContentType="application/xml"/>'
        '<Override PartName="/xl/workbook.xml" ContentType="application/vnd.openxmlformats-'
        'officedocument.spreadsheetml.sheet.main+xml"/><Override PartName="/xl/worksheets/'
        'sheet1.xml" ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.'
        'worksheet+xml"/></Types>'
    ),
    "_rels/.rels": (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
        'relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>'
    ),
    "xl/workbook.xml": (
        '<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r='
        '"http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets>'
        '<sheet name="a" sheetId="1" r:id="rId1"/></sheets></workbook>'
    ),
    "xl/_rels/workbook.xml.rels": (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
        'relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>'
    ),
}
HEAD = '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
TAIL = "</sheetData></worksheet>"


def cell(place, inside="<v>1</v>", kind=""):
    """Return a row with a cell."""
    row = "".join(letter for letter in place if letter.isdigit())
    return f'<row r="{row}"><c r="{place}"{kind}>{inside}</c></row>'


def text_of(length):
    """Return the inside of a cell with a text."""
    return f"<is><t>{'x' * length}</t></is>"


def workbook(path, rows, parts=()):
    """Write a workbook with one sheet that states no dimension."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (BOOK | dict(parts)).items():
            archive.writestr(name, content)
        archive.writestr("xl/worksheets/sheet1.xml", HEAD + rows + TAIL)
    path.write_bytes(packed.getvalue())
    return load(path)


STRING = ' t="inlineStr"'
BOMBS = {
    "a cell at the last place": (cell("A1") + cell("XFD1048576"), "1048576 rows"),
    "a wide row": (cell("XFD1"), "16384 columns"),
    "a far row": (cell("A1048576"), "1048576 rows"),
    "many rows times many columns": (cell("SF1") + cell("A150000"), "150000 rows and 500 columns"),
    "rows without numbers": ("<row><c><v>1</v></c></row>" * 200_001, "200001 rows"),
    "cells without places": ("<row>" + "<c><v>1</v></c>" * 501 + "</row>", "501 columns"),
    "a long text": (cell("A1", text_of(150_000), STRING), "more than 40,000 characters"),
    "a text of many megabytes": (cell("A1", text_of(20_000_000), STRING), "40,000 characters"),
    "an attribute of many megabytes": (f'<row r="1" x="{"y" * 5_000_000}"/>', "of more than 1 MB"),
    "a comment of many megabytes": (f"<!--{'y' * 5_000_000}-->", "of more than 1 MB"),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_workbook_that_would_fill_the_memory_is_refused_at_once(name, tmp_path):
    rows, words = BOMBS[name]
    file = workbook(tmp_path / "bomb.xlsx", rows)
    del rows
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match=words):
            sheets(file)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert most < 20e6


def test_entities_that_grow_are_refused(tmp_path):
    book = tmp_path / "bomb.xlsx"
    kinds = "".join(f'<!ENTITY a{i + 1} "{f"&a{i};" * 10}">' for i in range(9))
    parts = {"xl/sharedStrings.xml": f'<!DOCTYPE x [<!ENTITY a0 "ha">{kinds}]><x>&a9;</x>'}
    with pytest.raises(InputError, match="document type"):
        sheets(workbook(book, cell("A1"), parts))


def test_a_sheet_without_a_dimension_is_read(tmp_path):
    rows = cell("A1", text_of(3), STRING) + cell("C3", "<f>1+1</f><v>2</v>")
    assert sheets(workbook(tmp_path / "a.xlsx", rows)) == {
        "a": [["xxx", "", ""], ["", "", ""], ["", "", "2.0"]]
    }


def test_a_name_that_stands_twice_behind_a_long_array_is_refused_in_time(monkeypatch):
    # reading the array anew for each of its lines took minutes
    from viscotack.files import toml

    read, whole = [], toml._is_toml
    monkeypatch.setattr(toml, "_is_toml", lambda lines: read.append(lines) or whole(lines))
    lines = [f"  {'1, ' * 100}" for _ in range(1900)]
    text = "\n".join(["x = [", *lines, "]", "y = 1", "y = 2"])
    with pytest.raises(InputError, match="line 1904, `y = 2`: cannot overwrite a value"):
        parse_toml(text, "bomb.toml")
    assert sum(sum(map(len, some)) for some in read) < 5e6


READERS = [read_text, read_toml, load, load_result, lambda path: read_bytes(path, 10)]


@pytest.mark.parametrize("read", READERS)
def test_devices_and_pipes_are_not_read(read, tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in ("/dev/zero", pipe):
        with pytest.raises(InputError, match="is no regular file: it is a device, a pipe"):
            read(path)


def test_more_than_is_taken_is_not_read(tmp_path):
    long = tmp_path / "long.toml"
    with long.open("wb") as file:
        file.truncate(3_000_000_000)  # a hole: nothing on the disk
    for read, most in ((read_text, "300 MB"), (read_toml, "40 MB"), (load, "50 MB")):
        with pytest.raises(InputError, match=f"larger than {most}"):
            read(long)
